//! Invalid documents give an error with the path in the file, and never a panic.

use relievo::asset::Model;
use serde_json::{Value, json};

use crate::sampling::noise;
use crate::scene::Scene;

/// A document that has every kind of element.
fn full() -> Scene {
    let mut scene = Scene::of_two_bones();
    scene.push("nodes", json!({"name": "mesh", "skin": 0}));
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let binds = scene.floats("MAT4", &[identity, identity].concat());
    scene.json["skins"][0]["inverseBindMatrices"] = json!(binds);
    let times = scene.floats("SCALAR", &[0.0, 1.0]);
    let rotations = scene.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let vectors = scene.floats("VEC3", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let spline = scene.floats("VEC3", &[0.5; 18]);
    let indices = scene.view(&[0, 1]);
    let new = scene.view(&[0; 24]);
    scene.json["accessors"][vectors]["sparse"] = json!({
        "count": 2, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": new}
    });
    scene.push("animations", json!({
        "name": "all",
        "samplers": [
            {"input": times, "output": rotations}, {"input": times, "output": vectors, "interpolation": "STEP"},
            {"input": times, "output": spline, "interpolation": "CUBICSPLINE"},
        ],
        "channels": [
            {"sampler": 0, "target": {"node": 0, "path": "rotation"}},
            {"sampler": 1, "target": {"node": 1, "path": "translation"}},
            {"sampler": 2, "target": {"node": 1, "path": "scale"}},
        ],
    }));
    scene
}

/// The document with the value at a JSON pointer replaced is refused, with `field` and all `words`.
fn refused(pointer: &str, value: Value, field: &str, words: &[&str]) {
    let mut scene = full();
    let (parent, last) = pointer.rsplit_once('/').expect("a pointer");
    match scene.json.pointer_mut(parent).expect("in the document") {
        Value::Object(object) => drop(object.insert(last.to_owned(), value)),
        Value::Array(array) => array[last.parse::<usize>().expect("an index")] = value,
        other => panic!("{other} has no members"),
    }
    let error = Model::from_gltf(&scene.gltf(), None).expect_err(pointer);
    assert_eq!(error.path, field, "{pointer}: {error}");
    assert!(
        words.iter().all(|word| error.to_string().contains(word)),
        "{pointer}: {words:?} not in: {error}"
    );
    assert_eq!(error.to_string().lines().count(), 1);
}

#[test]
fn the_full_document_is_right() {
    let model = Model::from_gltf(&full().gltf(), None).expect("valid");
    assert_eq!((model.skeleton.len(), model.skins.len(), model.clips.len()), (2, 1, 1));
}

#[test]
fn nodes_and_skins() {
    refused("/nodes/1/children", json!([0]), "nodes[0]", &["trees"]);
    refused("/nodes/2/children", json!([1]), "nodes[2].children[0]", &["one parent", "nodes[0]"]);
    refused("/nodes/0/children", json!([7]), "nodes[0].children[0]", &["list"]);
    refused("/nodes/0/rotation", json!([0, 0, 0, 0]), "nodes[0].rotation", &["unit"]);
    let odd = json!({ "name": "\"ü\n[{", "mesh": [7] });
    refused("/nodes/0", odd, "nodes[0].mesh", &["= [7]", "index"]);
    refused("/nodes/0/translation", json!([0, 1e300, 0]), "nodes[0].translation[1]", &["1e+300", "finite"]);
    refused("/nodes/0/translation", json!([0, 1]), "nodes[0].translation", &["[0,1]", "array of length 3"]);
    refused(
        "/nodes/0/translation",
        json!([0, 1, 2, 3]),
        "nodes[0].translation[3]",
        &["= 3", "enough elements"],
    );
    refused(
        "/nodes/0/matrix",
        json!([1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
        "nodes[0].matrix",
        &["shear"],
    );
    refused("/skins/0/joints", json!([]), "skins[0].joints", &["at least one"]);
    refused("/skins/0/joints", json!([0, 0]), "skins[0].joints[1]", &["twice"]);
    refused("/skins/0/joints", json!([0, 9]), "skins[0].joints[1]", &["= 9:", "list nodes, below 3"]);
    refused("/skins/0/joints", json!([0, 1, 2]), "skins[0].inverseBindMatrices", &["2 matrices", "3"]);
    refused("/skins/0/inverseBindMatrices", json!(1), "accessors[1].type", &["Scalar", "Mat4"]);
    refused("/skins", json!([]), "nodes[2].skin", &["= 0:", "list skins, below 0"]);
    let mut bare = Scene::new();
    bare.push("nodes", json!({"name": "lamp"}));
    assert_eq!(Model::from_gltf(&bare.gltf(), None).expect_err("refused").path, "nodes");
}

#[test]
fn accessors_and_views() {
    refused("/accessors/1/count", json!(3), "accessors[1].byteOffset", &["3 elements", "8 bytes"]);
    refused("/accessors/1/count", json!(-1), "accessors[1].count", &["-1"]);
    refused("/accessors/1/count", json!(1e18 as u64), "accessors[1].count", &["1000000000000000000"]);
    refused("/accessors/1/byteOffset", json!(u64::MAX), "accessors[1].byteOffset", &[]);
    refused(
        "/accessors/1/bufferView",
        json!(99),
        "accessors[1].bufferView",
        &["= 99", "list bufferViews, below"],
    );
    refused("/accessors/1/componentType", json!(5125), "accessors[1].componentType", &["5126"]);
    refused(
        "/accessors/1/componentType",
        json!(1),
        "accessors[1].componentType",
        &["= 1:", "one of 5120, 5121"],
    );
    refused(
        "/accessors/1/componentType",
        json!("f32"),
        "accessors[1].componentType",
        &["= f32", "one of 5120"],
    );
    refused("/accessors/1/count", json!("two"), "accessors[1].count", &["= two", "whole number"]);
    refused(
        "/accessors/1",
        json!({"componentType": 5126, "type": "SCALAR"}),
        "accessors[1].count",
        &["missing"],
    );
    refused("/accessors/2/type", json!("VEC5"), "accessors[2].type", &["= VEC5", "\"SCALAR\", \"VEC2\""]);
    refused("/accessors/3/sparse/count", json!(3), "accessors[3].sparse.count", &["3"]);
    refused(
        "/accessors/3/sparse/indices/componentType",
        json!(5122),
        "accessors[3].sparse.indices.componentType",
        &[],
    );
    refused(
        "/accessors/3/sparse/values/byteOffset",
        json!(4),
        "accessors[3].sparse.values.byteOffset",
        &["2 elements"],
    );
    refused("/bufferViews/1/byteLength", json!(1_u64 << 40), "bufferViews[1].byteLength", &["buffers[0]"]);
    refused("/bufferViews/1/byteOffset", json!(u64::MAX), "bufferViews[1].byteLength", &[]);
    refused("/bufferViews/2/byteStride", json!(8), "bufferViews[2].byteStride", &["16"]);
    let length = full().buffer.len();
    refused("/buffers", json!([{"byteLength": length}]), "buffers[0].uri", &["GLB"]);
    for uri in [
        "http://example.com/a.bin",
        "/etc/passwd",
        "../a.bin",
        "missing.bin",
        "data:text/plain,AAAA",
        "data:x",
        "data:;base64,@@",
    ] {
        refused("/buffers", json!([{"byteLength": length, "uri": uri}]), "buffers[0].uri", &[uri]);
    }
    refused(
        "/buffers",
        json!([{"byteLength": length, "uri": "data:;base64,AAAA"}]),
        "buffers[0].byteLength",
        &["3"],
    );
}

#[test]
fn sparse_indices_beyond_the_end() {
    let mut scene = full();
    let view =
        scene.json["accessors"][3]["sparse"]["indices"]["bufferView"].as_u64().expect("an index") as usize;
    let offset = scene.json["bufferViews"][view]["byteOffset"].as_u64().expect("an offset") as usize;
    scene.buffer[offset + 1] = 2;
    let error = Model::from_gltf(&scene.gltf(), None).expect_err("refused");
    assert_eq!((&*error.path, &*error.value), ("accessors[3].sparse.indices[1]", "2"));
}

#[test]
fn animations() {
    refused("/animations/0/samplers/0/input", json!(2), "accessors[2].type", &["Vec4", "Scalar"]);
    refused("/animations/0/samplers/0/output", json!(77), "animations[0].samplers[0].output", &[]);
    refused(
        "/animations/0/samplers/1/interpolation",
        json!("CUBICSPLINE"),
        "animations[0].samplers[1].output.len",
        &["2", "6"],
    );
    refused(
        "/animations/0/samplers/1/interpolation",
        json!("QUINTIC"),
        "animations[0].samplers[1].interpolation",
        &["= QUINTIC", "\"LINEAR\", \"STEP\", \"CUBICSPLINE\""],
    );
    refused("/animations/0/channels/0/sampler", json!(9), "animations[0].channels[0].sampler", &[]);
    refused(
        "/animations/0/channels/0/target/node",
        json!(9),
        "animations[0].channels[0].target.node",
        &["9"],
    );
    refused(
        "/animations/0/channels/0/target/path",
        json!("colour"),
        "animations[0].channels[0].target.path",
        &["= colour", "\"translation\", \"rotation\""],
    );
    let twice = json!({"node": 1, "path": "translation"});
    refused("/animations/0/channels/2/target", twice, "animations[0].channels[2].target", &["two"]);
}

/// Key times and values are changed directly in the buffer.
#[test]
fn keys() {
    for (accessor, index, value, field) in [
        (1, 1, -1.0_f32, "animations[0].samplers[0].input[1]"),
        (1, 0, 2.0, "animations[0].samplers[0].input[1]"),
        (1, 1, f32::NAN, "animations[0].samplers[0].input[1]"),
        (2, 2, f32::INFINITY, "animations[0].samplers[0].output[0][2]"),
        (2, 3, 0.0, "animations[0].samplers[0].output[0]"),
        (4, 17, f32::NAN, "animations[0].samplers[2].output[5][2]"),
        (0, 5, f32::NAN, "skins[0].inverseBindMatrices[0][5]"),
        (0, 19, 1.0, "skins[0].inverseBindMatrices[1]"),
    ] {
        let mut scene = full();
        let view = scene.json["accessors"][accessor]["bufferView"].as_u64().expect("an index") as usize;
        let offset = scene.json["bufferViews"][view]["byteOffset"].as_u64().expect("an offset") as usize;
        scene.buffer[offset + 4 * index..][..4].copy_from_slice(&value.to_le_bytes());
        let error = Model::from_gltf(&scene.gltf(), None).expect_err(field);
        assert_eq!(error.path, field, "{error}");
    }
}

#[test]
fn containers() {
    let glb = full().glb();
    let with = |at: usize, bytes: &[u8]| {
        let mut changed = glb.clone();
        changed[at..at + bytes.len()].copy_from_slice(bytes);
        Model::from_gltf(&changed, None).expect_err("refused").path
    };
    assert_eq!(with(4, &[1, 0, 0, 0]), "GLB.version");
    for length in [0, 11, 0xffff_ffff_u32] {
        assert_eq!(with(8, &length.to_le_bytes()), "GLB.length");
    }
    assert_eq!(with(12, &[0xff; 4]), "GLB.chunks[0].length");
    assert_eq!(with(16, b"BIN\0"), "GLB.chunks[0].type");
    for text in ["", "glTF", "{", "[]", "null", "{}", "\u{feff}{}", r#"{"asset": {"version": "2.0"}}"#] {
        assert!(Model::from_gltf(text.as_bytes(), None).is_err(), "{text}");
    }
}

/// What is no glTF 2.0 is refused in words of glTF, with what stands in the file.
#[test]
fn other_files_and_versions() {
    let told = |text: &str| Model::from_gltf(text.as_bytes(), None).expect_err(text).to_string();
    let begins = "must be glTF 2.0: JSON, which begins with {, or a GLB, which begins with glTF";
    assert_eq!(told("Kaydara FBX Binary  "), format!("JSON = \"Kaydara FBX Bina\": {begins}"));
    assert_eq!(told(""), format!("JSON = \"\": {begins}"));
    assert_eq!(told("[]"), format!("JSON = \"[]\": {begins}"));
    let broken = told("{\"asset\":\n {\"version\" \"2.0\"}}");
    assert_eq!(broken, "JSON = line 2 column 13: must be glTF 2.0, and valid JSON: expected `:`");
    let object = "must be an object: glTF 2.0 begins with {\"asset\": {\"version\": \"2.0\"}";
    assert_eq!(told("{}"), format!("asset = missing: {object}"));
    assert_eq!(told(r#"{"asset": 2}"#), format!("asset = 2: {object}"));
    let version = "must be \"2.0\", the version of glTF that is read: convert the file to it";
    assert_eq!(told(r#"{"asset": {}}"#), format!("asset.version = missing: {version}"));
    // In glTF 1.0 meshes are an object.
    let old =
        r#"{"asset": {"version": "1.0"}, "meshes": {"a": {}}, "extensionsRequired": ["KHR_binary_glTF"]}"#;
    assert_eq!(told(old), format!("asset.version = 1.0: {version}"));
    let newer = r#"{"asset": {"version": "2.0", "minVersion": "3.0"}}"#;
    assert_eq!(told(newer), format!("asset.minVersion = 3.0: {version}"));
    assert!(told(r#"{"asset": {"version": "2.1"}}"#).starts_with("nodes"), "minor versions are read");
    let meshes = told(r#"{"asset": {"version": "2.0"}, "meshes": {"a": {}}}"#);
    assert_eq!(meshes, r#"meshes = {"a":{}}: must be a list"#);
    let primitive = r#"{"attributes": {"POSITION": 0, "BONES": 0}}"#;
    let named = r#"{"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "count": 1, "type": "VEC3"}],"#;
    let attributes = told(&format!("{named} \"meshes\": [{{\"primitives\": [{primitive}]}}]}}"));
    let bound =
        "must be POSITION, NORMAL, TANGENT, TEXCOORD_n, COLOR_n, JOINTS_n or WEIGHTS_n, or begin with _";
    assert_eq!(attributes, format!("meshes[0].primitives[0].attributes = BONES: {bound}"));
}

/// Documents that are truncated anywhere or have random bytes changed give a model or an error, and a model can
/// be played.
#[test]
fn nothing_panics() {
    let glb = full().glb();
    for end in 0..glb.len() {
        assert!(Model::from_gltf(&glb[..end], None).is_err(), "{end} bytes");
    }
    let mut read = 0;
    for case in 0..20_000 {
        let words = noise(case, 9);
        let mut changed = glb.clone();
        for pair in words[..2 * (1 + case as usize % 4)].chunks_exact(2) {
            let at = ((pair[0] + 1.0) / 2.0 * (glb.len() - 1) as f32) as usize;
            changed[at] = ((pair[1] + 1.0) * 128.0) as u8;
        }
        if let Ok(model) = Model::from_gltf(&changed, None) {
            read += 1;
            play(&model);
        }
    }
    assert!(read > 1000, "only {read} of the documents were still right");
}

fn play(model: &Model) {
    use relievo::asset::keyframe::RotationPath;
    for clip in &model.clips {
        for time in [0.0, 0.3, clip.duration()] {
            let pose = relievo::ops::animation::sample::reference::sample(clip, time, RotationPath::Slerp);
            assert!(pose.iter().all(|bone| bone.rotation.iter().all(|x| x.is_finite())));
        }
    }
}

/// Every number, string, list and object of the JSON is replaced by something else.
#[test]
fn every_value_may_be_wrong() {
    let scene = full();
    let mut pointers = Vec::new();
    collect(&scene.json, String::new(), &mut pointers);
    assert!(pointers.len() > 100);
    let wrong = [
        json!(null),
        json!(-1),
        json!(1e300),
        json!(4_294_967_295_u64),
        json!("x"),
        json!([]),
        json!({}),
        json!(true),
    ];
    for pointer in pointers {
        for value in &wrong {
            let mut changed = full();
            *changed.json.pointer_mut(&pointer).expect("collected") = value.clone();
            if let Ok(model) = Model::from_gltf(&changed.gltf(), None) {
                play(&model);
            }
        }
    }
}

pub fn collect(value: &Value, pointer: String, pointers: &mut Vec<String>) {
    match value {
        Value::Object(object) => {
            object.iter().for_each(|(key, value)| collect(value, format!("{pointer}/{key}"), pointers));
        }
        Value::Array(array) => {
            array
                .iter()
                .enumerate()
                .for_each(|(at, value)| collect(value, format!("{pointer}/{at}"), pointers));
        }
        _ => {}
    }
    if !pointer.is_empty() {
        pointers.push(pointer);
    }
}
