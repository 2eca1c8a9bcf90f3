//! Encodes images of models as files.

use image::ExtendedColorType;

use super::{Model, encode_png};
use crate::InputError;

/// Encodes the image with index `image` of a model as PNG.
pub(crate) fn png(model: &Model, image: usize) -> Result<Vec<u8>, InputError> {
    let found = model.images.get(image);
    let refused = |bound: String| InputError::new(format!("images[{image}]"), image, bound);
    let found = found.ok_or_else(|| refused(format!("must be below {}", model.images.len())))?.texels()?;
    let size = [found.width(), found.height()];
    encode_png(size, found, ExtendedColorType::Rgba8).map_err(|error| refused(error.to_string()))
}
