//! Images of models, and the files from which they are decoded. Those of packages are decoded when their texels are asked for.

use std::io::Cursor;
use std::ops::Deref;
use std::path::Path;
use std::sync::{Arc, LazyLock, OnceLock};

use image::codecs::png::PngEncoder;
use image::{
    DynamicImage, ExtendedColorType, ImageEncoder as _, ImageError, ImageFormat, ImageReader, ImageResult,
    Limits, RgbaImage,
};

use crate::{Error, InputError};

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

/// Decodes an image of any format that the crate `image` was compiled with.
///
/// # Errors
/// Errors of `image`: invalid data, or an image beyond the limits.
pub fn decode_image(bytes: &[u8], limits: Limits) -> ImageResult<DynamicImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    reader.limits(limits);
    reader.decode()
}

/// Reads an image file with [`decode_image`]. The format is that of the content, whatever the name ends in.
///
/// # Errors
/// [`Error::File`] if the file cannot be read or decoded.
pub fn open_image(path: &Path, limits: Limits) -> Result<DynamicImage, Error> {
    let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
    decode_image(&bytes, limits).map_err(|error| Error::file(path, error))
}

/// Encodes an image as PNG. `texels` has the bytes of its channels, row by row, wider channels in the host's order of bytes.
///
/// # Errors
/// Errors of `image`: a format of texels that PNG has not.
///
/// # Panics
/// If the number of bytes is not that of the size.
pub fn encode_png(size: [u32; 2], texels: &[u8], color: ExtendedColorType) -> ImageResult<Vec<u8>> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(texels, size[0], size[1], color)?;
    Ok(bytes)
}

/// Formats of the images of models.
const FORMATS: [ImageFormat; 3] = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP];

/// Width and height that a file states, and its format. `path` names the image in errors.
///
/// # Errors
/// [`InputError`] for a file that is not PNG, JPEG or WebP.
pub(crate) fn stated_size(path: &str, bytes: &[u8]) -> Result<([u32; 2], ImageFormat), InputError> {
    let (reader, format) = reader(path, bytes)?;
    let size = reader.into_dimensions().map_err(|error| unreadable(path, bytes, format, &error))?;
    Ok((size.into(), format))
}

/// Decodes an image of this width and height. `path` names the image in errors.
///
/// # Errors
/// [`InputError`] for a file that is damaged or has another size.
pub(crate) fn texels(path: &str, bytes: &[u8], [width, height]: [u32; 2]) -> Result<RgbaImage, InputError> {
    let (reader, format) = reader(path, bytes)?;
    let image = reader.decode().map_err(|error| unreadable(path, bytes, format, &error))?.into_rgba8();
    let bound = || format!("must be {width} × {height}, as its first bytes state");
    let size = format!("{} × {}", image.width(), image.height());
    InputError::check(image.dimensions() == (width, height), path, size, bound)?;
    Ok(image)
}

fn refused(path: &str, bytes: &[u8], bound: String) -> InputError {
    InputError::new(path, format!("[{} bytes]", bytes.len()), bound)
}

fn unreadable(path: &str, bytes: &[u8], format: ImageFormat, error: &ImageError) -> InputError {
    refused(path, bytes, format!("must be a whole {format:?}: {error}"))
}

/// A reader of an image, and the image's format.
type FormatReader<'a> = (ImageReader<Cursor<&'a [u8]>>, ImageFormat);

fn reader<'a>(path: &str, bytes: &'a [u8]) -> Result<FormatReader<'a>, InputError> {
    let format = image::guess_format(bytes).ok();
    let Some(format) = format.filter(|format| FORMATS.contains(format)) else {
        return Err(refused(path, bytes, "must be PNG, JPEG or WebP".to_owned()));
    };
    // Finds decoders of `image::hooks` too.
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    Ok((reader.map_err(|error| unreadable(path, bytes, format, &error.into()))?, format))
}
