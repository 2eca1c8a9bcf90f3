//! Encodes images of models as files.

use std::io::Cursor;

use super::Model;
use crate::InputError;

/// Encodes the image with index `image` of a model as PNG.
pub(crate) fn png(model: &Model, image: usize) -> Result<Vec<u8>, InputError> {
    let mut bytes = Cursor::new(Vec::new());
    let found = model.images.get(image);
    let refused = |bound: String| InputError::new(format!("images[{image}]"), image, bound);
    let found = found.ok_or_else(|| refused(format!("must be below {}", model.images.len())))?.texels()?;
    found.write_to(&mut bytes, image::ImageFormat::Png).map_err(|error| refused(error.to_string()))?;
    Ok(bytes.into_inner())
}
