//! Images that the browser decodes: JPEG and WebP. Their decoders are not in the page, as they would be a thirtieth of it.
//!
//! Models and scenes are read without waiting, but the browser's decoder has to be waited for. So a decoder that is registered with the
//! crate `image` states the size of a file, notes the file, and gives the texels that the browser has decoded already. Without them, it
//! fails: after [`decode`], the reader reads again.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::io::Read as _;
use std::rc::Rc;

use image::error::{DecodingError, ImageFormatHint};
use image::hooks::{GenericReader, register_decoding_hook, register_format_detection_hook};
use image::{ColorType, ImageDecoder, ImageError, ImageFormat, ImageResult, RgbaImage};
use js_sys::{Array, Uint8Array};
use relievo::gpu::Gpu;
use relievo::render::{Offscreen, TargetFormat};
use relievo::wgpu;
use wasm_bindgen::JsCast as _;
use wasm_bindgen_futures::JsFuture;
use web_sys::{Blob, ColorSpaceConversion, ImageBitmap, ImageBitmapOptions, PremultiplyAlpha};

/// The first bytes of a JPEG, and those of a WebP, of which the middle ones are its length.
const JPEG: &[u8] = b"\xff\xd8\xff";
const WEBP: (&[u8], &[u8]) = (b"RIFF\0\0\0\0WEBP", b"\xff\xff\xff\xff\0\0\0\0\xff\xff\xff\xff");

/// An image, or why the browser does not decode it.
type Decoded = Result<Rc<RgbaImage>, String>;

thread_local! {
    /// What the browser has decoded, by the bytes of its file.
    static DECODED: RefCell<HashMap<Vec<u8>, Decoded>> = RefCell::default();

    /// Files that it has to decode.
    static LACKING: RefCell<HashSet<Vec<u8>>> = RefCell::default();
}

/// Lets the crate `image` take images that the browser decodes. Further calls have no effect.
pub fn register() {
    if !register_decoding_hook("jpg".into(), Box::new(decoder)) {
        return;
    }
    register_decoding_hook("webp".into(), Box::new(decoder));
    register_format_detection_hook("jpg".into(), JPEG, None);
    register_format_detection_hook("webp".into(), WEBP.0, Some(WEBP.1));
}

fn failed(why: impl ToString) -> ImageError {
    ImageError::Decoding(DecodingError::new(ImageFormatHint::Unknown, why.to_string()))
}

/// The decoder of a file.
fn decoder<'a>(mut reader: GenericReader<'a>) -> ImageResult<Box<dyn ImageDecoder + 'a>> {
    let mut file = Vec::new();
    reader.read_to_end(&mut file)?;
    let size = imagesize::blob_size(&file).map_err(failed)?;
    let edge = |edge: usize| u32::try_from(edge).map_err(failed);
    let size = [edge(size.width)?, edge(size.height)?];
    lacks(&file);
    Ok(Box::new(Decoder { size, file }))
}

/// Notes a file that the browser has not decoded.
fn lacks(file: &[u8]) {
    if DECODED.with_borrow(|all| !all.contains_key(file)) {
        LACKING.with_borrow_mut(|lacking| lacking.insert(file.to_vec()));
    }
}

/// The decoder of a file whose size is known.
struct Decoder {
    size: [u32; 2],
    file: Vec<u8>,
}

impl ImageDecoder for Decoder {
    fn dimensions(&self) -> (u32, u32) {
        self.size.into()
    }

    fn color_type(&self) -> ColorType {
        if has_alpha(&self.file) { ColorType::Rgba8 } else { ColorType::Rgb8 }
    }

    fn read_image(self, texels: &mut [u8]) -> ImageResult<()> {
        let found = DECODED.with_borrow(|all| all.get(&self.file).cloned());
        let image = found.ok_or_else(|| failed("the browser has not decoded it yet"))?.map_err(failed)?;
        if image.dimensions() != self.dimensions() {
            return Err(failed("its texels are not as many as its first bytes state"));
        }
        let channels = usize::from(self.color_type().channel_count());
        for (to, from) in texels.chunks_exact_mut(channels).zip(image.pixels()) {
            to.copy_from_slice(&from.0[..channels]);
        }
        Ok(())
    }

    fn read_image_boxed(self: Box<Self>, texels: &mut [u8]) -> ImageResult<()> {
        (*self).read_image(texels)
    }
}

/// Whether a WebP states that it has alpha; a JPEG has none.
fn has_alpha(file: &[u8]) -> bool {
    match file.get(12..16) {
        Some(b"VP8X") => file.get(20).is_some_and(|flags| flags & 0x10 != 0),
        Some(b"VP8L") => file.get(24).is_some_and(|bits| bits & 0x10 != 0),
        _ => false,
    }
}

/// Notes the images in a file: the file itself, or those within a binary glTF. The browser decodes all of them at the next [`decode`],
/// while a reader stops at the first one that is lacking.
pub fn note(file: &[u8]) {
    within(file).into_iter().filter(|image| is_for_browser(image)).for_each(lacks);
}

fn is_for_browser(file: &[u8]) -> bool {
    matches!(image::guess_format(file), Ok(ImageFormat::Jpeg | ImageFormat::WebP))
}

/// The images that lie within a file as a whole.
fn within(file: &[u8]) -> Vec<&[u8]> {
    if !file.starts_with(b"glTF") {
        return vec![file];
    }
    // A header of 12 bytes; the length and the type of the chunk of JSON; and after it, those of the buffer.
    let word = |at: usize| {
        let bytes = file.get(at..at + 4)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?) as usize)
    };
    let read = || {
        let end = 20_usize.checked_add(word(12)?)?;
        let text: serde_json::Value = serde_json::from_slice(file.get(20..end)?).ok()?;
        let buffer = file.get(end + 8..)?;
        let images = text["images"].as_array()?.iter().filter_map(|image| {
            let view = &text["bufferViews"][image["bufferView"].as_u64()? as usize];
            let start = view["byteOffset"].as_u64().unwrap_or(0) as usize;
            buffer.get(start..start.checked_add(view["byteLength"].as_u64()? as usize)?)
        });
        Some(images.collect())
    };
    // The import tells what is wrong with the file.
    read().unwrap_or_default()
}

/// Decodes the files that are noted, and returns them, for [`forget`].
pub async fn decode(gpu: &Gpu) -> Vec<Vec<u8>> {
    let files: Vec<_> = LACKING.take().into_iter().collect();
    for file in &files {
        let decoded = decoded(gpu, file).await;
        DECODED.with_borrow_mut(|all| all.insert(file.clone(), decoded));
    }
    files
}

/// Forgets what is decoded of files.
pub fn forget(files: &[Vec<u8>]) {
    DECODED.with_borrow_mut(|all| files.iter().for_each(|file| _ = all.remove(file)));
}

/// Lets the browser decode a file.
async fn decoded(gpu: &Gpu, file: &[u8]) -> Decoded {
    let bitmap = match file.starts_with(JPEG) {
        true => bitmap(&without_exif(file)).await,
        false => bitmap(file).await,
    };
    let bitmap = bitmap.map_err(|error| crate::web::other(&error).to_string())?;
    let texels = texels(gpu, &bitmap).await;
    bitmap.close();
    texels.map(Rc::new).map_err(|error| error.to_string())
}

/// A JPEG without Exif, by which browsers turn images; texels of models are not turned.
fn without_exif(file: &[u8]) -> Vec<u8> {
    let (mut rest, mut kept) = (&file[2..], file[..2].to_vec());
    // Segments before the scan: a marker, and the length of what follows it.
    while let [0xff, marker @ (0xc0..=0xcf | 0xdb..=0xef | 0xfe), high, low, ..] = *rest
        && let Some((segment, after)) =
            rest.split_at_checked(2 + usize::from(u16::from_be_bytes([high, low])))
    {
        if marker != 0xe1 {
            kept.extend_from_slice(segment);
        }
        rest = after;
    }
    kept.extend_from_slice(rest);
    kept
}

/// Decodes a file, with its values as they are.
async fn bitmap(file: &[u8]) -> Result<ImageBitmap, wasm_bindgen::JsValue> {
    let window = web_sys::window().ok_or("there is no window")?;
    let blob = Blob::new_with_u8_array_sequence(&Array::of1(&Uint8Array::from(file)))?;
    let options = ImageBitmapOptions::new();
    options.set_color_space_conversion(ColorSpaceConversion::None);
    options.set_premultiply_alpha(PremultiplyAlpha::None);
    let bitmap = window.create_image_bitmap_with_blob_and_image_bitmap_options(&blob, &options)?;
    JsFuture::from(bitmap).await?.dyn_into()
}

/// Reads the texels of a bitmap by way of a texture: a canvas would multiply them by alpha.
async fn texels(gpu: &Gpu, bitmap: &ImageBitmap) -> Result<RgbaImage, relievo::Error> {
    let (width, height) = (bitmap.width(), bitmap.height());
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let target = Offscreen::with_format(gpu, [width, height], TargetFormat::new(format))?;
    if let Some(texture) = target.color(0) {
        let source = wgpu::CopyExternalImageSourceInfo {
            source: wgpu::ExternalImageSource::ImageBitmap(bitmap.clone()),
            origin: wgpu::Origin2d::ZERO,
            flip_y: false,
        };
        let destination = texture.as_image_copy().to_tagged(wgpu::PredefinedColorSpace::Srgb, false);
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        gpu.queue().copy_external_image_to_texture(&source, destination, size);
    }
    let texels = target.read_color(gpu, 0, format).await?;
    Ok(RgbaImage::from_raw(width, height, texels).unwrap_or_default())
}
