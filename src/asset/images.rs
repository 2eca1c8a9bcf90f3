//! Images of models. Those of packages are decoded when their texels are asked for.

use std::io::Cursor;
use std::ops::Deref;
use std::sync::{Arc, LazyLock, OnceLock};

use image::RgbaImage;

use super::Model;
use super::gltf::materials::texels;
use crate::InputError;

/// An image of a model, the top row first. Copies share their texels.
///
/// An image of a package is decoded at the first use of its texels, which [`Image::texels`] returns. As an [`RgbaImage`], an image
/// that cannot be decoded has no texels.
#[derive(Debug, Clone)]
pub struct Image(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    size: [u32; 2],
    /// The image as a file, if it is not decoded yet.
    file: Vec<u8>,
    texels: OnceLock<Result<RgbaImage, InputError>>,
}

impl Image {
    /// An image that is decoded later. `size` is the width and height that its file states.
    pub(super) fn of_file(file: Vec<u8>, size: [u32; 2]) -> Self {
        Self(Arc::new(Inner { size, file, texels: OnceLock::new() }))
    }

    /// Width and height in texels.
    pub fn size(&self) -> [u32; 2] {
        self.0.size
    }

    /// The texels.
    ///
    /// # Errors
    /// [`InputError`] for an image of a package that cannot be decoded.
    pub fn texels(&self) -> Result<&RgbaImage, InputError> {
        let decoded = self.0.texels.get_or_init(|| texels("image", &self.0.file, self.0.size));
        decoded.as_ref().map_err(InputError::clone)
    }
}

impl From<RgbaImage> for Image {
    fn from(image: RgbaImage) -> Self {
        let size = image.dimensions().into();
        Self(Arc::new(Inner { size, file: Vec::new(), texels: Ok(image).into() }))
    }
}

impl Deref for Image {
    type Target = RgbaImage;

    fn deref(&self) -> &RgbaImage {
        static NONE: LazyLock<RgbaImage> = LazyLock::new(RgbaImage::default);
        self.texels().unwrap_or(&NONE)
    }
}

impl PartialEq for Image {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.size() == other.size() && self.texels() == other.texels()
    }
}

impl PartialEq<RgbaImage> for Image {
    fn eq(&self, other: &RgbaImage) -> bool {
        self.texels() == Ok(other)
    }
}

/// Encodes the image with index `image` of a model as PNG.
pub(crate) fn png(model: &Model, image: usize) -> Result<Vec<u8>, InputError> {
    let mut bytes = Cursor::new(Vec::new());
    let found = model.images.get(image);
    let refused = |bound: String| InputError::new(format!("images[{image}]"), image, bound);
    let found = found.ok_or_else(|| refused(format!("must be below {}", model.images.len())))?.texels()?;
    found.write_to(&mut bytes, image::ImageFormat::Png).map_err(|error| refused(error.to_string()))?;
    Ok(bytes.into_inner())
}
