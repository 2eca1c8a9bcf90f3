//! Wavefront OBJ as three.js reads it.

use std::collections::BTreeMap;
use std::path::Path;

use relievo::asset::{Mesh, Model};
use serde_json::Value;

/// The corners of triangles, three a triangle: position, texture coordinates with v up, normal.
type Corners = Vec<[f32; 8]>;

fn corners(mesh: &Mesh) -> Corners {
    let corner = |index: &u32| {
        let at = *index as usize;
        let ([x, y, z], [u, v], [a, b, c]) = (mesh.positions[at], mesh.uv[at], mesh.normals[at]);
        [x, y, z, u, 1.0 - v, a, b, c]
    };
    mesh.indices.iter().map(corner).collect()
}

/// What differs between a model and three.js' parts, each with the name of its object or group and of its material.
fn difference(model: &Model, parts: &[Value]) -> Option<String> {
    let mut found: BTreeMap<(&str, &str), Corners> = BTreeMap::new();
    for mesh in &model.meshes {
        let material = mesh.material.map_or("", |material| &model.materials[material].name);
        let node = mesh.name.rsplit_once('_').map_or("", |(node, _)| node);
        found.entry((node, material)).or_default().extend(corners(mesh));
    }
    if found.len() != parts.len() {
        return Some(format!("{} parts, not {}", found.len(), parts.len()));
    }
    for part in parts {
        let names = [&part["name"], &part["material"]].map(|name| name.as_str().unwrap_or_default());
        let Some(own) = found.get(&(names[0], names[1])) else { return Some(format!("no {names:?}")) };
        let wanted: Corners =
            serde_json::from_value(part["corners"].clone()).expect("eight numbers a corner");
        if own.len() != wanted.len() {
            return Some(format!("{names:?}: {} corners, not {}", own.len(), wanted.len()));
        }
        // three.js keeps v as it is; here it was turned over twice, which may round.
        let off = |a: &[f32; 8], b: &[f32; 8]| {
            (0..8).any(|at| (a[at] - b[at]).abs() > if at == 4 { 1e-7 } else { 0.0 })
        };
        if let Some(at) = own.iter().zip(&wanted).position(|(a, b)| off(a, b)) {
            return Some(format!("{names:?}, corner {at}: {:?}, not {:?}", own[at], wanted[at]));
        }
    }
    None
}

fn files() -> (Model, Vec<Value>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files");
    let text = std::fs::read_to_string(folder.join("shapes.json")).expect("readable");
    let truth: Value = serde_json::from_str(&text).expect("JSON");
    let model = Model::from_file(&folder.join("shapes.obj")).expect("valid");
    (model, truth["parts"].as_array().expect("a list").clone())
}

#[test]
fn objects_are_those_of_three_js() {
    let (model, parts) = files();
    assert_eq!(parts.len(), 4);
    assert_eq!(difference(&model, &parts), None);
}

#[test]
fn planted_differences_are_found() {
    let (mut model, parts) = files();
    model.meshes[1].normals[2][0] += 1e-6;
    assert!(difference(&model, &parts).is_some_and(|text| text.contains("corner")));
    let (mut model, parts) = files();
    model.meshes[0].indices.truncate(9);
    assert!(difference(&model, &parts).is_some_and(|text| text.contains("9 corners, not 24")));
    let (mut model, parts) = files();
    model.meshes[2].material = None;
    assert!(difference(&model, &parts).is_some_and(|text| text.starts_with("no ")));
}
