//! A figure of two bones, made as a GLB: a body with a texture, a cape with holes, a translucent shield, and
//! a hat that has no skin and is attached to a joint.

use std::io::Cursor;

use image::{ImageFormat, Rgba, RgbaImage};
use relievo::asset::Model;
use serde_json::{Value, json};

use crate::gltf::Scene;

/// The body's texture has stripes and squares; the cape's has cloth, and holes with soft edges.
fn texture(name: &str) -> RgbaImage {
    RgbaImage::from_fn(16, 16, |x, y| match name {
        "body" if y < 3 => Rgba([240, 220, 90, 255]),
        "body" if (x / 4 + y / 4) % 2 == 0 => Rgba([40, 130, 90, 255]),
        "body" => Rgba([200, 230, 210, 255]),
        _ => {
            let [dx, dy] = [x % 8, y % 8].map(|at| at as f32 - 3.5);
            let alpha = (160.0 * (dx.hypot(dy) - 1.0)).clamp(0.0, 255.0) as u8;
            Rgba([150, 30, (y * 9) as u8, alpha])
        }
    })
}

fn add_texture(scene: &mut Scene, name: &str) {
    let mut png = Cursor::new(Vec::new());
    texture(name).write_to(&mut png, ImageFormat::Png).expect("encoded");
    let view = scene.view(png.get_ref());
    scene.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
}

/// A sheet of columns and rows of quads; each corner has a position, texture coordinates, and its weight for
/// the upper bone.
fn sheet(
    scene: &mut Scene,
    [columns, rows]: [u32; 2],
    material: usize,
    corner: impl Fn(f32, f32) -> ([f32; 3], [f32; 2], f32),
) -> Value {
    let (mut positions, mut uv, mut weights, mut indices) = (vec![], vec![], vec![], vec![]);
    for (row, column) in (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column))) {
        let (place, at, fraction) = corner(column as f32 / columns as f32, row as f32 / rows as f32);
        positions.push(place);
        uv.extend(at);
        weights.extend([1.0 - fraction, fraction, 0.0, 0.0]);
        if row < rows && column < columns {
            let first = row * (columns + 1) + column;
            let [a, b, c, d] = [first, first + 1, first + columns + 2, first + columns + 1];
            indices.extend([a, b, c, a, c, d]);
        }
    }
    let mut primitive = mesh(scene, &positions, &indices, material);
    let joints = scene.integers("VEC4", 1, &[0, 1, 0, 0].repeat(positions.len()));
    let of = &mut primitive["attributes"];
    of["TEXCOORD_0"] = json!(scene.floats("VEC2", &uv));
    of["WEIGHTS_0"] = json!(scene.floats("VEC4", &weights));
    of["JOINTS_0"] = json!(joints);
    primitive
}

fn mesh(scene: &mut Scene, positions: &[[f32; 3]], indices: &[u32], material: usize) -> Value {
    let end = |end: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|axis| positions.iter().map(|place| place[axis]).reduce(end).expect("some"))
    };
    let at = scene.floats("VEC3", positions.as_flattened());
    scene.json["accessors"][at]["min"] = json!(end(f32::min));
    scene.json["accessors"][at]["max"] = json!(end(f32::max));
    let indices = scene.integers("SCALAR", 2, indices);
    json!({"attributes": {"POSITION": at}, "indices": indices, "material": material})
}

/// The figure is two metres tall; its clip bends the upper half to its right and turns it.
pub fn figure() -> Model {
    let mut scene = Scene::of_two_bones();
    let mut binds = glam::Mat4::IDENTITY.to_cols_array().repeat(2);
    binds[16 + 13] = -1.0;
    scene.json["skins"][0]["inverseBindMatrices"] = json!(scene.floats("MAT4", &binds));
    for list in ["images", "samplers", "textures", "materials", "meshes"] {
        scene.json[list] = json!([]);
    }
    for (name, sampler) in [
        ("body", json!({"magFilter": 9728, "minFilter": 9987, "wrapS": 33648, "wrapT": 33071})),
        ("cape", json!({"wrapS": 10497, "wrapT": 33071})),
    ] {
        add_texture(&mut scene, name);
        let sampler = scene.push("samplers", sampler);
        scene.push("textures", json!({"source": sampler, "sampler": sampler}));
    }
    let colored = |color: [f32; 4]| json!({"pbrMetallicRoughness": {"baseColorFactor": color}});
    let textured = |index: usize| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}});
    scene.push("materials", textured(0));
    let cape = scene.push("materials", textured(1));
    scene.json["materials"][cape]["alphaMode"] = json!("MASK");
    scene.json["materials"][cape]["doubleSided"] = json!(true);
    let shield = scene.push("materials", colored([0.15, 0.4, 0.9, 0.6]));
    scene.json["materials"][shield]["alphaMode"] = json!("BLEND");
    scene.push("materials", colored([0.7, 0.05, 0.03, 1.0]));
    let fraction = |y: f32| {
        let fade_fraction = (y - 0.5).clamp(0.0, 1.0);
        fade_fraction * fade_fraction * (3.0 - 2.0 * fade_fraction)
    };
    let body = sheet(&mut scene, [16, 12], 0, |u, v| {
        let angle = std::f32::consts::TAU * u;
        let y = 2.0 * v;
        ([0.35 * libm::sinf(angle), y, 0.35 * libm::cosf(angle)], [3.0 * u, 1.0 - v], fraction(y))
    });
    let cape = sheet(&mut scene, [4, 8], 1, |u, v| {
        let y = 0.2 + 1.7 * v;
        ([1.6 * u - 0.8, y, -0.6 + 0.15 * v], [2.0 * u, 1.0 - v], fraction(y))
    });
    let shield = sheet(&mut scene, [1, 1], 2, |u, v| ([0.9 * u - 0.75, 0.25 + 0.8 * v, 0.6], [u, v], 0.0));
    let dressed = scene.push("meshes", json!({"primitives": [body, cape, shield]}));
    let corners = [[1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [0.0, 2.0, 0.0]];
    let sides = [0, 1, 2, 3].map(|side| [side, (side + 1) % 4, 4]);
    let hat = mesh(&mut scene, &corners, sides.as_flattened(), 3);
    let hat = scene.push("meshes", json!({"primitives": [hat]}));
    scene.push("nodes", json!({"name": "dressed", "mesh": dressed, "skin": 0}));
    let turned = [0.0, 0.382_683_43, 0.0, 0.923_879_5];
    let hat = json!({"name": "hat", "mesh": hat, "translation": [0.0, 0.9, 0.0], "rotation": turned, "scale": [0.35, 0.3, 0.35]});
    let hat = scene.push("nodes", hat);
    scene.json["nodes"][1]["children"] = json!([hat]);
    let times = scene.floats("SCALAR", &[0.0, 1.0]);
    let bent = glam::Quat::from_rotation_z(-0.9) * glam::Quat::from_rotation_y(0.6);
    let turns = scene.floats("VEC4", &[glam::Quat::IDENTITY.to_array(), bent.to_array()].concat());
    scene.animate(1, "rotation", "LINEAR", times, turns);
    Model::from_gltf(&scene.glb(), None).expect("valid")
}
