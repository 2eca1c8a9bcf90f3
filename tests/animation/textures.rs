//! Materials of glTF documents: colours, textures from wherever they may lie, samplers, and what is refused.

use std::io::Cursor;

use base64::Engine as _;
use image::{ImageFormat, Rgba, RgbaImage};
use relievo::asset::Material;
use relievo::asset::Model;
use relievo::asset::material::{Alpha, Filter, Sampling, Texture, Wrapping};
use serde_json::json;

use crate::meshes::Skinned;

fn encoded(image: &RgbaImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = image::DynamicImage::ImageRgba8(image.clone());
    match format {
        ImageFormat::Jpeg => image.into_rgb8().write_to(&mut bytes, format),
        _ => image.write_to(&mut bytes, format),
    }
    .expect("encoded");
    bytes.into_inner()
}

/// Two rows of three texels, one of which is transparent.
fn picture() -> RgbaImage {
    RgbaImage::from_fn(3, 2, |x, y| Rgba([80 * x as u8, 200 * y as u8, 7, if x + y == 3 { 9 } else { 255 }]))
}

/// The picture as PNG in a buffer view, a sampler, a material that has both, and texture coordinates.
pub fn add_texture(skinned: &mut Skinned) {
    let view = skinned.0.view(&encoded(&picture(), ImageFormat::Png));
    let uv = skinned.0.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.5]);
    skinned.attribute("TEXCOORD_0", uv);
    skinned.0.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
    skinned.0.json["samplers"] =
        json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9985}]);
    skinned.0.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    skinned.0.json["materials"] = json!([{"name": "fur", "alphaMode": "MASK", "alphaCutoff": 0.25,
        "pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.5, 0.25, 1.0], "baseColorTexture": {"index": 0}}}]);
    skinned.primitive()["material"] = json!(0);
}

fn textured() -> Skinned {
    let mut skinned = Skinned::new();
    add_texture(&mut skinned);
    skinned
}

fn model(skinned: &Skinned) -> Model {
    let mesh = skinned.read().expect("valid");
    let model = Model::from_gltf(&skinned.0.gltf(), None).expect("valid");
    assert!(model.material(&mesh).expect("fits").is_some());
    model
}

#[test]
fn a_material_is_read() {
    let model = model(&textured());
    let sampling = Sampling {
        wrap: [Wrapping::Clamp, Wrapping::Mirror],
        magnified: Filter::Nearest,
        minified: Filter::Linear,
        mips: Some(Filter::Nearest),
    };
    let expected = Material {
        name: "fur".to_owned(),
        color: [1.0, 0.5, 0.25, 1.0],
        texture: Some(Texture { image: 0, sampling }),
        alpha: Alpha::Mask(0.25),
    };
    assert_eq!((model.meshes[0].material, &model.materials[..]), (Some(0), &[expected][..]));
    assert_eq!(model.images, [picture()]);
    assert_eq!(model.meshes[0].uv[3], [1.0, 0.5]);
}

#[test]
fn what_a_material_leaves_open_is_what_gltf_says() {
    let mut skinned = textured();
    skinned.0.json["textures"] = json!([{"source": 0}]);
    skinned.0.json["materials"] =
        json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, {}, {}]);
    let of = |skinned: &Skinned| model(skinned).materials.remove(0);
    let material = of(&skinned);
    assert_eq!((material.color, material.alpha), ([1.0; 4], Alpha::Opaque));
    assert_eq!(material.texture, Some(Texture { image: 0, sampling: Sampling::default() }));
    for (mode, alpha) in [("MASK", Alpha::Mask(0.5)), ("BLEND", Alpha::Dithered), ("OPAQUE", Alpha::Opaque)] {
        skinned.0.json["materials"][0]["alphaMode"] = json!(mode);
        assert_eq!(of(&skinned).alpha, alpha);
    }
    // Materials that no mesh uses are not read, even if they are invalid.
    skinned.primitive()["material"] = json!(2);
    skinned.0.json["images"][0] = json!({"uri": "nowhere.png"});
    let model = model(&skinned);
    assert_eq!((model.materials.len(), model.images.len(), model.materials[0].texture), (1, 0, None));
    assert_eq!(model.materials[0].name, "material_2");
}

#[test]
fn meshes_share_what_they_have_in_common() {
    let mut skinned = textured();
    let mut primitives = vec![skinned.primitive().clone(); 3];
    primitives[1]["material"] = json!(1);
    let materials = skinned.0.json["materials"].as_array_mut().expect("a list");
    materials.push(materials[0].clone());
    materials[1]["alphaMode"] = json!("OPAQUE");
    skinned.0.json["meshes"][0]["primitives"] = json!(primitives);
    let model = model(&skinned);
    let of_meshes: Vec<_> = model.meshes.iter().map(|mesh| mesh.material).collect();
    assert_eq!(of_meshes, [Some(0), Some(1), Some(0)]);
    assert_eq!((model.materials.len(), model.images.len()), (2, 1));
}

#[test]
fn samplers_of_every_kind() {
    let mut skinned = textured();
    let (nearest, linear) = (Filter::Nearest, Filter::Linear);
    for (number, minified, mips) in [
        (9728, nearest, None),
        (9729, linear, None),
        (9984, nearest, Some(nearest)),
        (9985, linear, Some(nearest)),
        (9986, nearest, Some(linear)),
        (9987, linear, Some(linear)),
    ] {
        skinned.0.json["samplers"][0] = json!({"minFilter": number, "magFilter": 9729, "wrapS": 10497});
        let sampling = model(&skinned).materials[0].texture.expect("there").sampling;
        assert_eq!(sampling, Sampling { minified, mips, ..Sampling::default() });
    }
    for (field, number) in [("minFilter", 7), ("magFilter", 9984), ("wrapS", 1), ("wrapT", 0)] {
        skinned.0.json["samplers"][0] = json!({field: number});
        skinned.refused(&format!("samplers[0].{field}"), "must be one of");
    }
}

#[test]
fn images_lie_where_gltf_lets_them() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut skinned = textured();
    for (format, name, kind) in
        [(ImageFormat::Png, "a b.png", "png"), (ImageFormat::Jpeg, "below/c.jpg", "jpeg")]
    {
        let bytes = encoded(&picture(), format);
        let decoded = image::load_from_memory(&bytes).expect("decoded").into_rgba8();
        let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
        skinned.0.json["images"][0] = json!({"uri": format!("data:image/{kind};base64,{data}")});
        assert_eq!(model(&skinned).images, std::slice::from_ref(&decoded));
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, bytes).expect("written");
        skinned.0.json["images"][0] = json!({"uri": name.replace(' ', "%20")});
        let found = Model::from_gltf(&skinned.0.gltf(), Some(folder.path())).expect("valid");
        assert_eq!(found.images, [decoded]);
        skinned.refused("images[0].uri", "has no folder");
    }
    // A greyscale image of 16 bits.
    let grey = image::DynamicImage::ImageLuma16(image::ImageBuffer::from_pixel(1, 1, image::Luma([0x8000])));
    let mut bytes = Cursor::new(Vec::new());
    grey.write_to(&mut bytes, ImageFormat::Png).expect("encoded");
    let view = skinned.0.view(bytes.get_ref());
    skinned.0.json["images"][0] = json!({"bufferView": view, "mimeType": "image/png"});
    assert_eq!(model(&skinned).images[0].get_pixel(0, 0).0, [128, 128, 128, 255]);
}

#[test]
fn texture_coordinates_are_those_of_the_texture() {
    let mut skinned = textured();
    let second = skinned.0.floats("VEC2", &[0.5, 0.25, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let texture = |skinned: &mut Skinned, texture| {
        skinned.0.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = texture;
    };
    texture(&mut skinned, json!({"index": 0, "texCoord": 1}));
    skinned.refused("meshes[0].primitives[0].attributes.TEXCOORD_1", "must be given");
    skinned.attribute("TEXCOORD_1", second);
    assert_eq!(skinned.read().expect("valid").uv[0], [0.5, 0.25]);
    // After a quarter turn, what pointed right points up.
    let quarter = std::f32::consts::FRAC_PI_2;
    texture(
        &mut skinned,
        json!({"index": 0, "extensions": {"KHR_texture_transform": {
        "offset": [0.25, 0.5], "rotation": quarter, "scale": [2.0, 4.0], "texCoord": 1}}}),
    );
    let uv = skinned.read().expect("valid").uv;
    let expected = [[1.25, -0.5], [0.25, -1.5], [4.25, 0.5], [0.25, 0.5]];
    let errors = uv.iter().zip(expected).flat_map(|(uv, wanted)| [uv[0] - wanted[0], uv[1] - wanted[1]]);
    assert!(errors.map(f32::abs).fold(0.0, f32::max) < 1e-6, "{uv:?}");
    texture(
        &mut skinned,
        json!({"index": 0, "extensions": {"KHR_texture_transform": {"scale": [1e30, 1.0]}}}),
    );
    skinned.refused("meshes[0].primitives[0].attributes.TEXCOORD_0[1][0]", "within");
}

#[test]
fn what_is_no_material_is_refused() {
    let wrong = |field: &str, words: &str, change: &dyn Fn(&mut Skinned)| {
        let mut skinned = textured();
        change(&mut skinned);
        skinned.refused(field, words);
    };
    let bytes = |field: &str, words: &str, bytes: &[u8]| {
        let (field, words) = (field.to_owned(), words.to_owned());
        let bytes = bytes.to_vec();
        wrong(&field, &words, &move |skinned| {
            let view = skinned.0.view(&bytes);
            skinned.0.json["images"][0]["bufferView"] = json!(view);
        });
    };
    let png = encoded(&picture(), ImageFormat::Png);
    bytes("images[0]", "[4 bytes]: must be PNG or JPEG", b"GIF8");
    bytes("images[0]", "must be a whole Png", &png[..png.len() / 2]);
    let mut damaged = png.clone();
    damaged[png.len() / 2] ^= 0x55;
    bytes("images[0]", "must be a whole Png", &damaged);
    let jpeg = encoded(&picture(), ImageFormat::Jpeg);
    bytes("images[0]", "must be a whole Jpeg", &jpeg[..20]);
    let wide = RgbaImage::new(8193, 1);
    bytes("images[0]", "8193 × 1: must be at most 8192 texels", &encoded(&wide, ImageFormat::Png));
    wrong("images[0]", "bufferView or a uri", &|skinned| skinned.0.json["images"][0] = json!({}));
    wrong("images[0].bufferView", "must lie in", &|skinned| {
        skinned.0.json["images"][0]["bufferView"] = json!(99);
    });
    wrong("images[0].uri", "document's folder or below", &|skinned| {
        skinned.0.json["images"][0] = json!({"uri": "../secret.png"});
    });
    wrong("images[0].uri", "must be base64", &|skinned| {
        skinned.0.json["images"][0] = json!({"uri": "data:image/png;base64,%%%"});
    });
    wrong("textures[0].source", "must be given", &|skinned| skinned.0.json["textures"][0] = json!({}));
    let base = "materials[0].pbrMetallicRoughness";
    wrong(&format!("{base}.baseColorTexture.index"), "must lie in", &|skinned| {
        skinned.0.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(1);
    });
    wrong(&format!("{base}.baseColorFactor[2]"), "must be in 0..=1", &|skinned| {
        skinned.0.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] =
            json!([0.0, 1.0, 1.5, 1.0]);
    });
    wrong("materials[0].alphaCutoff", "not negative", &|skinned| {
        skinned.0.json["materials"][0]["alphaCutoff"] = json!(-0.5);
    });
    wrong("materials[0].alphaMode", "one of the values", &|skinned| {
        skinned.0.json["materials"][0]["alphaMode"] = json!("GLASS");
    });
}
