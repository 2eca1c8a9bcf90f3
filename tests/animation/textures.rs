//! Materials of glTF documents: colours, textures from wherever they may lie, samplers, and what is refused.

use std::io::Cursor;

use base64::Engine as _;
use image::{ImageFormat, Rgba, RgbaImage};
use relievo::asset::Material;
use relievo::asset::Model;
use relievo::asset::material::{Alpha, Filter, Pbr, PbrTexture, Sampling, Texture, UvSet, Wrapping};
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
        normal: None,
        normal_scale: 1.0,
        alpha: Alpha::Mask(0.25),
        pbr: Pbr { metallic: 1.0, ..Pbr::default() },
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

/// A second texture, with an image and a sampler of its own, as the normal map of the material.
fn add_normals(skinned: &mut Skinned) -> RgbaImage {
    let normals = RgbaImage::from_fn(2, 2, |x, y| Rgba([128 + 90 * x as u8, 128 + 60 * y as u8, 220, 255]));
    let view = skinned.0.view(&encoded(&normals, ImageFormat::Png));
    let list = |skinned: &mut Skinned, name: &str, value: serde_json::Value| {
        skinned.0.json[name].as_array_mut().expect("a list").push(value);
    };
    list(skinned, "images", json!({"bufferView": view, "mimeType": "image/png"}));
    list(skinned, "samplers", json!({"magFilter": 9728}));
    list(skinned, "textures", json!({"source": 1, "sampler": 1}));
    skinned.0.json["materials"][0]["normalTexture"] = json!({"index": 1, "scale": 0.75});
    normals
}

#[test]
fn normal_maps_are_read_with_their_scale() {
    let mut skinned = textured();
    let normals = add_normals(&mut skinned);
    let found = model(&skinned);
    let material = &found.materials[0];
    let sampling = Sampling { magnified: Filter::Nearest, ..Sampling::default() };
    assert_eq!(material.texture.map(|texture| texture.image), Some(0));
    assert_eq!((material.normal, material.normal_scale), (Some(Texture { image: 1, sampling }), 0.75));
    assert_eq!(found.images, [picture(), normals.clone()]);
    // Without a scale it is 1, and one image serves both.
    skinned.0.json["materials"][0]["normalTexture"] = json!({"index": 0});
    let found = model(&skinned);
    let material = &found.materials[0];
    assert_eq!((material.normal, material.normal_scale, found.images.len()), (material.texture, 1.0, 1));
    // Without a texture of the base colour, the normal map decides about texture coordinates.
    let second = skinned.0.floats("VEC2", &[0.5, 0.25, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    skinned.attribute("TEXCOORD_1", second);
    let transform = json!({"KHR_texture_transform": {"scale": [2.0, 4.0], "texCoord": 1}});
    skinned.0.json["materials"] =
        json!([{"normalTexture": {"index": 1, "scale": -2, "extensions": transform}}]);
    let found = model(&skinned);
    assert_eq!(
        (found.materials[0].normal, found.materials[0].normal_scale),
        (Some(Texture { image: 0, sampling }), -2.0)
    );
    assert_eq!((found.meshes[0].uv[0], &found.images[..]), ([1.0, 1.0], &[normals.into()][..]));
    // Materials and images may be left out.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("bare.gltf");
    std::fs::write(&file, skinned.0.gltf()).expect("written");
    let bare = Model::from_file_bare(&file).expect("valid");
    assert_eq!((bare.materials.len(), bare.images.len(), bare.meshes[0].uv[0]), (0, 0, [0.0, 1.0]));
}

/// A mesh has one set of texture coordinates, so the normal map must be read there too.
#[test]
fn normal_maps_that_lie_elsewhere_are_left_out() {
    let mut skinned = textured();
    add_normals(&mut skinned);
    let second = skinned.0.floats("VEC2", &[0.5, 0.25, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    skinned.attribute("TEXCOORD_1", second);
    let moved = |value: serde_json::Value| json!({"KHR_texture_transform": value});
    let same = json!({"scale": [2.0, 1.0], "offset": [0.5, 0.0]});
    let mut found = |of_color: serde_json::Value, of_normals: serde_json::Value| {
        let material = &mut skinned.0.json["materials"][0];
        material["pbrMetallicRoughness"]["baseColorTexture"] = of_color;
        material["normalTexture"] = of_normals;
        let model = model(&skinned);
        (model.materials[0].normal.is_some(), model.images.len())
    };
    let with = |index: u32, set: u32, transform: &serde_json::Value| json!({"index": index, "texCoord": set, "extensions": moved(transform.clone())});
    assert_eq!(found(json!({"index": 0}), json!({"index": 1})), (true, 2));
    assert_eq!(found(json!({"index": 0}), json!({"index": 1, "texCoord": 1})), (false, 1));
    assert_eq!(found(json!({"index": 0, "texCoord": 1}), json!({"index": 1, "texCoord": 1})), (true, 2));
    assert_eq!(found(json!({"index": 0}), with(1, 0, &same)), (false, 1));
    assert_eq!(found(with(0, 0, &same), with(1, 0, &same)), (true, 2));
    assert_eq!(found(with(0, 0, &same), json!({"index": 1})), (false, 1));
    assert_eq!(found(json!({"index": 0}), with(1, 0, &json!({"rotation": 0.0}))), (true, 2));
    assert_eq!(found(json!({"index": 0, "texCoord": 1}), with(1, 0, &json!({"texCoord": 1}))), (true, 2));
}

#[test]
fn what_is_no_normal_map_is_refused() {
    let wrong = |field: &str, words: &str, change: &dyn Fn(&mut Skinned)| {
        let mut skinned = textured();
        add_normals(&mut skinned);
        change(&mut skinned);
        skinned.refused(field, words);
    };
    wrong("materials[0].normalTexture.index", "must lie in", &|skinned| {
        skinned.0.json["materials"][0]["normalTexture"]["index"] = json!(2);
    });
    wrong("materials[0].normalTexture.scale", "must be finite", &|skinned| {
        skinned.0.json["materials"][0]["normalTexture"]["scale"] = json!(1e300);
    });
    wrong("textures[1].source", "must be given", &|skinned| skinned.0.json["textures"][1] = json!({}));
    wrong("images[1]", "bufferView or a uri", &|skinned| skinned.0.json["images"][1] = json!({}));
    wrong("samplers[1].wrapS", "must be one of", &|skinned| {
        skinned.0.json["samplers"][1] = json!({"wrapS": 1});
    });
    let scale = "materials[0].normalTexture.extensions.KHR_texture_transform.scale";
    wrong(scale, "= 2: must be an array of length 2", &|skinned| {
        skinned.0.json["materials"][0]["normalTexture"]["extensions"] =
            json!({"KHR_texture_transform": {"scale": 2}});
    });
    let lacking = "meshes[0].primitives[0].attributes.TEXCOORD_3";
    wrong(lacking, "must be given", &|skinned| {
        skinned.0.json["materials"][0] = json!({"normalTexture": {"index": 1, "texCoord": 3}});
    });
    // In models that were not imported.
    let mut skinned = textured();
    add_normals(&mut skinned);
    let refused = |change: &dyn Fn(&mut Model)| {
        let mut model = model(&skinned);
        change(&mut model);
        model.material(&model.meshes[0]).expect_err("refused").path
    };
    let image = |model: &mut Model, image| model.materials[0].normal.as_mut().expect("there").image = image;
    assert_eq!(refused(&|model| image(model, 2)), "materials[0].normal.image");
    assert_eq!(refused(&|model| model.images[1] = RgbaImage::new(0, 0).into()), "materials[0].normal.image");
    assert_eq!(refused(&|model| model.materials[0].normal_scale = f32::NAN), "materials[0].normal_scale");
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
    bytes("images[0]", "[4 bytes]: must be PNG, JPEG or WebP", b"GIF8");
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
    wrong("materials[0].alphaMode", "= GLASS: must be one of \"OPAQUE\", \"MASK\"", &|skinned| {
        skinned.0.json["materials"][0]["alphaMode"] = json!("GLASS");
    });
}

/// The diffuse colour of `KHR_materials_pbrSpecularGlossiness` takes precedence.
#[test]
fn glossy_materials_have_their_diffuse_colour() {
    let mut skinned = textured();
    let name = "KHR_materials_pbrSpecularGlossiness";
    let moved = json!({"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}});
    let rough = skinned.0.json["materials"][0]["pbrMetallicRoughness"].take();
    skinned.0.json["materials"][0].as_object_mut().expect("an object").remove("pbrMetallicRoughness");
    skinned.0.json["materials"][0]["extensions"] = json!({name: {"diffuseFactor": rough["baseColorFactor"], "diffuseTexture": rough["baseColorTexture"]}});
    let (mut glossy, plain) = (model(&skinned), model(&textured()));
    let pbr = std::mem::replace(&mut glossy.materials[0].pbr, plain.materials[0].pbr.clone());
    assert_eq!((glossy, [pbr.metallic, pbr.roughness]), (plain, [0.0; 2]));
    skinned.0.json["extensionsRequired"] = json!([name]);
    skinned.0.json["materials"][0]["extensions"][name]["diffuseTexture"] = moved;
    let (found, plain) = (model(&skinned), model(&textured()));
    assert_eq!(found.meshes[0].uv[1][0], plain.meshes[0].uv[1][0] + 0.5);
    let path = format!("materials[0].extensions.{name}");
    skinned.0.json["materials"][0]["extensions"][name]["diffuseFactor"] = json!([0, 2, 0, 1]);
    skinned.refused(&format!("{path}.diffuseFactor[1]"), "in 0..=1");
}

/// A texture's WebP, and the PNG beside it, which is read in its place.
#[test]
fn textures_may_be_webp() {
    let mut skinned = textured();
    let plain = model(&skinned);
    let view = skinned.0.view(&encoded(&picture(), ImageFormat::WebP));
    skinned.0.json["images"]
        .as_array_mut()
        .expect("a list")
        .push(json!({"bufferView": view, "mimeType": "image/webp"}));
    skinned.0.json["extensionsRequired"] = json!(["EXT_texture_webp"]);
    let texture =
        |source: usize| json!({"sampler": 0, "extensions": {"EXT_texture_webp": {"source": source}}});
    skinned.0.json["textures"] = json!([texture(1)]);
    // It is lossless.
    assert_eq!(model(&skinned), plain);
    skinned.0.json["textures"] = json!([texture(2)]);
    skinned.refused("textures[0].extensions.EXT_texture_webp.source", "must be below 2");
    skinned.0.json["textures"][0]["source"] = json!(0);
    assert_eq!(model(&skinned), plain);
    // 2048² texels of one colour, as libwebp packs them in 220 bytes.
    let wide = [
        &b"RIFF\xd4\x00\x00\x00WEBPVP8L\xc8\x00\x00\x00/\xff\xc7\xff\x01\x07\xd0\x84&4\xa1\xff\x01!A\xe2\xff\xeff\x22\xfa\x9f\xf1\x9f\xff\xfc"[..],
        &b"\xe7?\xff\xf9\xcf\x7f\xfe\xf3\x9f\xff\xfc".repeat(15),
        b"\xe7?\xff\xf9\xcf\x7f\xfe\xef\x01",
    ];
    let view = skinned.0.view(&wide.concat());
    skinned.0.json["images"][0] = json!({"bufferView": view, "mimeType": "image/webp"});
    let image = &model(&skinned).images[0];
    assert!(image.dimensions() == (2048, 2048) && image.pixels().all(|texel| texel.0 == [9, 9, 9, 255]));
    // KTX2, whatever the document says.
    let view = skinned.0.view(b"\xabKTX 20\xbb\r\n\x1a\n");
    skinned.0.json["images"][0]["bufferView"] = json!(view);
    skinned.refused("images[0]", "gltf-transform ktxdecompress");
}

/// What scenes do not draw is read, written as glTF, and kept by packages.
#[test]
fn all_of_the_core_of_materials_is_kept() {
    let mut skinned = textured();
    add_normals(&mut skinned);
    let second = skinned.0.floats("VEC2", &[0.5, 0.25, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    skinned.attribute("TEXCOORD_1", second);
    let colors = skinned.0.floats("VEC3", &[0.5, 0.25, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    skinned.attribute("COLOR_0", colors);
    let material = &mut skinned.0.json["materials"][0];
    material["pbrMetallicRoughness"]["metallicFactor"] = json!(0.5);
    material["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.25);
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({"index": 1});
    let transform = json!({"KHR_texture_transform": {"scale": [2.0, 4.0]}});
    material["occlusionTexture"] =
        json!({"index": 1, "texCoord": 1, "strength": 0.75, "extensions": transform});
    // These coordinates are a third set.
    material["emissiveTexture"] = json!({"index": 0, "texCoord": 1});
    material["emissiveFactor"] = json!([0.1, 0.2, 0.3]);
    let found = model(&skinned);
    let texture = |uv| Some(PbrTexture { texture: found.materials[0].normal.expect("there"), uv });
    let wanted = Pbr {
        metallic: 0.5,
        roughness: 0.25,
        metallic_roughness: texture(UvSet::First),
        occlusion: texture(UvSet::Second),
        occlusion_strength: 0.75,
        emissive: [0.1, 0.2, 0.3],
        emission: None,
    };
    assert_eq!(found.materials[0].pbr, wanted);
    let mesh = &found.meshes[0];
    assert_eq!((mesh.second_uv[0], mesh.second_uv[1]), ([1.0, 1.0], [2.0, 0.0]));
    assert_eq!((mesh.colors[0], mesh.colors[3]), ([0.5, 0.25, 1.0, 1.0], [1.0; 4]));
    let again = Model::from_gltf(&found.to_glb().expect("written"), None).expect("valid");
    assert_eq!((&again.materials, &again.images), (&found.materials, &found.images));
    assert_eq!((&again.meshes[0].second_uv, &again.meshes[0].colors), (&mesh.second_uv, &mesh.colors));
    let cooked =
        relievo::ops::skinning::cook(&found.clone().into(), &mut |_| std::ops::ControlFlow::Continue(()));
    let package = Model::from_rlv(&cooked.expect("cooked").expect("not broken off")).expect("read");
    assert_eq!((&package.materials, &package.images), (&found.materials, &found.images));
    for (vertex, position) in package.meshes[0].positions.iter().enumerate() {
        let near = |other: &[f32; 3]| other.iter().zip(position).all(|(a, b)| (a - b).abs() < 1e-3);
        let from = mesh.positions.iter().position(near).expect("a vertex of the source");
        let (uv, color) = (package.meshes[0].second_uv[vertex], package.meshes[0].colors[vertex]);
        assert!((0..2).all(|at| (uv[at] - mesh.second_uv[from][at]).abs() <= 1.0 / 16_384.0));
        assert!((0..4).all(|at| (color[at] - mesh.colors[from][at]).abs() <= 1.0 / 1024.0));
    }
    // One set is enough if all textures lie there, and a second set is kept although no texture is read there.
    let material = &mut skinned.0.json["materials"][0];
    material["emissiveTexture"] = json!({"index": 0});
    material["occlusionTexture"] = json!({"index": 1});
    let found = model(&skinned);
    assert_eq!(
        (found.meshes[0].second_uv[0], found.materials[0].pbr.emission.map(|one| one.uv)),
        ([0.5, 0.25], Some(UvSet::First))
    );
    skinned.0.json["materials"][0]["emissiveFactor"] = json!([0.1, 2.0, 0.3]);
    skinned.refused("materials[0].emissiveFactor[1]", "must be in 0..=1");
}
