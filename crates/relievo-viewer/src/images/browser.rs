//! Images that the browser decodes: JPEG and WebP. Their decoders are not in the page, as they would be a thirtieth of it.
//!
//! Models and scenes are read without waiting, but the browser's decoder has to be waited for. So a decoder that is registered with the
//! crate `image` takes what the browser has decoded already. For another image it fails, and notes the image: after [`decode`], the
//! reader reads again.

use std::cell::RefCell;
use std::collections::HashMap;
use std::io::Read as _;
use std::rc::Rc;

use image::error::{DecodingError, ImageFormatHint};
use image::hooks::{GenericReader, register_decoding_hook, register_format_detection_hook};
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageResult, RgbaImage};
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
type Decoded = Result<Rc<DynamicImage>, String>;

thread_local! {
    /// What the browser has decoded, by the bytes of its file.
    static DECODED: RefCell<HashMap<Vec<u8>, Decoded>> = RefCell::default();

    /// What it has to decode.
    static LACKING: RefCell<Vec<Vec<u8>>> = RefCell::default();
}

/// Lets the crate `image` take images that the browser decodes.
pub fn register() {
    register_format_detection_hook("jpg".into(), JPEG, None);
    register_format_detection_hook("webp".into(), WEBP.0, Some(WEBP.1));
    for ending in ["jpg", "webp"] {
        register_decoding_hook(ending.into(), Box::new(decoder));
    }
}

/// The decoder of a file that the browser has decoded.
fn decoder<'a>(mut file: GenericReader<'a>) -> ImageResult<Box<dyn ImageDecoder + 'a>> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    let failed = |why: String| ImageError::Decoding(DecodingError::new(ImageFormatHint::Unknown, why));
    match DECODED.with_borrow(|all| all.get(&bytes).cloned()) {
        Some(decoded) => Ok(Box::new(Whole(decoded.map_err(failed)?))),
        None => {
            LACKING.with_borrow_mut(|lacking| lacking.push(bytes));
            Err(failed("the browser has not decoded it yet".to_owned()))
        }
    }
}

/// The decoder of an image that is decoded.
struct Whole(Rc<DynamicImage>);

impl ImageDecoder for Whole {
    fn dimensions(&self) -> (u32, u32) {
        (self.0.width(), self.0.height())
    }

    fn color_type(&self) -> ColorType {
        self.0.color()
    }

    fn read_image(self, texels: &mut [u8]) -> ImageResult<()> {
        texels.copy_from_slice(self.0.as_bytes());
        Ok(())
    }

    fn read_image_boxed(self: Box<Self>, texels: &mut [u8]) -> ImageResult<()> {
        (*self).read_image(texels)
    }
}

/// Notes the images in a file: the file itself, or those within a binary glTF. The browser decodes all of them at the next [`decode`],
/// while a reader stops at the first one that is lacking.
pub fn note(file: &[u8]) {
    for image in within(file).into_iter().filter(|image| is_for_browser(image)) {
        if DECODED.with_borrow(|all| !all.contains_key(image)) {
            LACKING.with_borrow_mut(|lacking| lacking.push(image.to_vec()));
        }
    }
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

/// Decodes the images that are noted. Returns whether there were some.
pub async fn decode(gpu: &Gpu) -> bool {
    let lacking = LACKING.take();
    for file in &lacking {
        if DECODED.with_borrow(|all| !all.contains_key(file)) {
            let decoded = decoded(gpu, file).await;
            DECODED.with_borrow_mut(|all| all.insert(file.clone(), decoded));
        }
    }
    !lacking.is_empty()
}

/// Forgets what is decoded.
pub fn forget() {
    DECODED.take();
    LACKING.take();
}

/// Lets the browser decode a file.
async fn decoded(gpu: &Gpu, file: &[u8]) -> Decoded {
    let is_jpeg = file.starts_with(JPEG);
    let bitmap = if is_jpeg { bitmap(&without_exif(file)).await } else { bitmap(file).await };
    let bitmap = bitmap.map_err(|error| crate::web::other(&error).to_string())?;
    let texels = texels(gpu, bitmap).await.map_err(|error| error.to_string())?;
    let is_opaque = is_jpeg || texels.pixels().all(|texel| texel.0[3] == u8::MAX);
    let image = DynamicImage::from(texels);
    Ok(Rc::new(if is_opaque { image.into_rgb8().into() } else { image }))
}

/// A JPEG without Exif, by which browsers turn images; texels of models are not turned.
fn without_exif(file: &[u8]) -> Vec<u8> {
    let (mut rest, mut kept) = (&file[2..], file[..2].to_vec());
    // Segments before the scan: a marker, and the length of what follows it.
    while let [0xff, marker @ (0xc0..=0xcf | 0xdb..=0xef | 0xfe), high, low, ..] = *rest
        && marker != 0xda
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
async fn texels(gpu: &Gpu, bitmap: ImageBitmap) -> Result<RgbaImage, relievo::Error> {
    let (width, height) = (bitmap.width(), bitmap.height());
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let target = Offscreen::with_format(gpu, [width, height], TargetFormat::new(format))?;
    if let Some(texture) = target.color(0) {
        let source = wgpu::CopyExternalImageSourceInfo {
            source: wgpu::ExternalImageSource::ImageBitmap(bitmap),
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
