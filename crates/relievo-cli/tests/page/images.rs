//! Images that the browser decodes, in each place where a scene may have them.

use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use image::{ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};
use relievo::asset::ModelFile;
use relievo::ops::skinning::cook;
use serde_json::json;

/// The scene: two textured rectangles, and a wall with a relief. The quality is full detail.
const SCENE: &str = r#"{
  "meshes": [
    { "file": "photos.glb", "instances": [{ "at": [-1.2, 0, 0] }] },
    { "file": "builtin:wall", "material": { "relief": "bumps.jpg" }, "instances": [{ "at": [1.2, -0.5, 0], "scale": 0.5 }] }
  ],
  "light": { "direction": [0.3, 0.5, 1], "ambient": 0.5 },
  "camera": { "at": [0, 0, 4.5], "look": [0, 0, 0] },
  "quality": { "pixels": 0 }
}"#;

/// The scene's files: a glTF with a JPEG in it and a WebP beside it, and a JPEG of heights.
pub fn files() -> Vec<(&'static str, Vec<u8>)> {
    let photo = RgbImage::from_fn(96, 64, |x, y| match y < 8 {
        // Browsers would turn this edge aside, as the file's Exif says.
        true => Rgb([250, 250, 250]),
        false => Rgb([(2 * x) as u8, (3 * y) as u8, 40 + 80 * ((x / 16 + y / 16) % 2) as u8]),
    });
    let leaf = RgbaImage::from_fn(64, 64, |x, y| {
        let off = (x as f32 - 31.5).hypot(y as f32 - 31.5) / 32.0;
        // Colours that are lost where they are multiplied by alpha.
        Rgba([30 + 3 * x as u8, 200 - 2 * y as u8, 60, (255.0 * (1.3 - off).clamp(0.02, 1.0)) as u8])
    });
    let bumps = RgbImage::from_fn(64, 64, |x, y| {
        let wave = |at: u32| (at as f32 * std::f32::consts::TAU / 16.0).cos();
        Rgb([(127.5 + 60.0 * (wave(x) + wave(y))) as u8; 3])
    });
    let mut webp = std::io::Cursor::new(Vec::new());
    leaf.write_to(&mut webp, ImageFormat::WebP).expect("encoded");
    vec![
        ("photos.json", SCENE.into()),
        ("photos.glb", glb(&turned(jpeg(&photo)))),
        ("leaf.webp", webp.into_inner()),
        ("bumps.jpg", jpeg(&bumps)),
    ]
}

/// The scene of a server, whose package has the images of `photos.glb`.
pub const STREAMED: &str = r#"{
  "meshes": [{ "file": "photos.rlv", "instances": [{ "at": [0, 0, 0] }] }],
  "light": { "direction": [0.3, 0.5, 1], "ambient": 0.5 },
  "camera": { "at": [0, 0, 3.5], "look": [0, 0, 0] },
  "quality": { "pixels": 0 }
}"#;

/// `photos.glb` as a package, which keeps the images as they are.
pub fn package() -> Vec<u8> {
    let files = files();
    let named = |name: &str| files.iter().find(|(own, _)| *own == name).map(|(_, bytes)| bytes.clone());
    let read = |path: &Path| path.to_str().and_then(named).ok_or_else(|| std::io::ErrorKind::NotFound.into());
    let (name, bytes) = ("photos.glb", named("photos.glb").expect("made"));
    let model = ModelFile::from_bytes_beside(Path::new(name), &bytes, &read).expect("a model");
    let package = cook(&model, &mut |_| std::ops::ControlFlow::Continue(()));
    let package = package.expect("cooked").expect("not broken off");
    let has = |start: &[u8]| package.windows(start.len()).any(|part| part == start);
    assert!(has(b"\xff\xd8\xff") && has(b"WEBP"));
    package
}

fn jpeg(image: &RgbImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, 95).encode_image(image).expect("encoded");
    bytes
}

/// A JPEG whose Exif says that it is to be turned by a quarter.
fn turned(jpeg: Vec<u8>) -> Vec<u8> {
    let mut exif = b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0".to_vec();
    let length = (exif.len() as u16 + 2).to_be_bytes();
    exif.splice(..0, [0xff, 0xe1, length[0], length[1]]);
    [&jpeg[..2], &exif, &jpeg[2..]].concat()
}

/// Two rectangles, one above the other: the upper one with the image, the lower one with that in `leaf.webp`.
fn glb(image: &[u8]) -> Vec<u8> {
    let corners = |y: f32| [[-1.0, y], [1.0, y], [1.0, y + 1.0], [-1.0, y + 1.0_f32]];
    let places = [corners(0.05), corners(-1.05)].concat();
    let mut buffer: Vec<u8> =
        places.iter().flat_map(|[x, y]| [*x, *y, 0.0]).flat_map(f32::to_le_bytes).collect();
    let coordinates = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0_f32]];
    buffer.extend(coordinates.iter().flatten().flat_map(|number| number.to_le_bytes()));
    buffer.extend([0_u16, 1, 2, 0, 2, 3].into_iter().flat_map(u16::to_le_bytes));
    buffer.extend(image);
    let [first, second] = [0, 48];
    let positions = |offset: usize, low: f32| {
        json!({ "bufferView": 0, "byteOffset": offset, "componentType": 5126, "count": 4, "type": "VEC3",
                "min": [-1.0, low, 0.0], "max": [1.0, low + 1.0, 0.0] })
    };
    let primitive = |at: usize| json!({ "attributes": { "POSITION": at, "TEXCOORD_0": 2 }, "indices": 3, "material": at });
    let textured = |at: usize, mode: &str| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": at }, "metallicFactor": 0 }, "alphaMode": mode });
    let text = json!({
        "asset": { "version": "2.0" },
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [primitive(0), primitive(1)] }],
        "materials": [textured(0, "OPAQUE"), textured(1, "MASK")],
        "textures": [{ "source": 0 }, { "source": 1 }],
        "images": [{ "bufferView": 3, "mimeType": "image/jpeg" }, { "uri": "leaf.webp" }],
        "accessors": [
            positions(first, 0.05),
            positions(second, -1.05),
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 96 },
            { "buffer": 0, "byteOffset": 96, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 128, "byteLength": 12 },
            { "buffer": 0, "byteOffset": 140, "byteLength": image.len() },
        ],
        "buffers": [{ "byteLength": buffer.len() }],
    });
    let mut text = text.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let length = 28 + text.len() + buffer.len();
    let chunk = |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind, bytes].concat();
    let header = [&b"glTF\x02\0\0\0"[..], &(length as u32).to_le_bytes()].concat();
    [header, chunk(b"JSON", &text), chunk(b"BIN\0", &buffer)].concat()
}
