//! Compressed meshes: Draco and meshoptimizer. `tests/truth` compares where their vertices are with three.js.

use std::path::Path;

use relievo::InputError;
use relievo::asset::Model;
use serde_json::{Value, json};

/// A file of `tests/truth`: its JSON and its buffer.
fn file(name: &str) -> (Value, Vec<u8>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files").join(name);
    let bytes = std::fs::read(path).expect("there");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    (serde_json::from_slice(&bytes[20..20 + length]).expect("JSON"), bytes[28 + length..].to_vec())
}

fn read((json, buffer): &(Value, Vec<u8>)) -> Result<Model, InputError> {
    let mut json = json.clone();
    json["buffers"][0]["uri"] = json!("a.bin");
    let bytes = serde_json::to_vec(&json).expect("JSON");
    Model::from_gltf_beside(&bytes, &|_| Ok(buffer.clone()))
}

fn triangles(model: &Model) -> Vec<usize> {
    model.meshes.iter().map(|mesh| mesh.indices.len() / 3).collect()
}

const DRACO: &str = "KHR_draco_mesh_compression";
const MESHOPT: &str = "EXT_meshopt_compression";

/// No mesh is left out, and each has the triangles of the file that was compressed.
#[test]
fn all_meshes_are_decompressed() {
    for (name, original, extension) in [
        ("draco.glb", "rig.glb", DRACO),
        ("sequential.glb", "bound.glb", DRACO),
        ("meshopt.glb", "keys.glb", MESHOPT),
    ] {
        let compressed = file(name);
        assert!(compressed.0["extensionsRequired"].as_array().expect("a list").contains(&json!(extension)));
        let model = read(&compressed).expect("valid");
        let plain = read(&file(original)).expect("valid");
        assert_eq!(triangles(&model), triangles(&plain), "{name}");
        assert_eq!(model.skins.len(), plain.skins.len());
        assert!(model.meshes.iter().all(|mesh| mesh.positions.iter().any(|position| *position != [0.0; 3])));
    }
}

/// A mesh that is not compressed does not hide those that are.
#[test]
fn compressed_and_other_meshes_stand_side_by_side() {
    let (mut json, buffer) = file("draco.glb");
    let before = read(&(json.clone(), buffer.clone())).expect("valid");
    let positions =
        json!({"componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [0, 0, 0]});
    let accessors = json["accessors"].as_array_mut().expect("a list");
    accessors.push(positions);
    let accessor = accessors.len() - 1;
    let meshes = json["meshes"].as_array_mut().expect("a list");
    meshes.push(json!({"primitives": [{"attributes": {"POSITION": accessor}}]}));
    let mesh = meshes.len() - 1;
    let nodes = json["nodes"].as_array_mut().expect("a list");
    nodes.push(json!({"name": "plain", "mesh": mesh}));
    let node = nodes.len() - 1;
    json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(node));
    let model = read(&(json, buffer)).expect("valid");
    assert_eq!(model.meshes.len(), before.meshes.len() + 1);
}

#[test]
fn damaged_draco_is_refused_by_name() {
    let whole = file("draco.glb");
    let path = format!("meshes[0].primitives[0].extensions.{DRACO}");
    let pointer = format!("/meshes/0/primitives/0/extensions/{DRACO}");
    let refused = |change: &dyn Fn(&mut Value), path: &str, words: &str| {
        let mut changed = whole.clone();
        change(&mut changed.0);
        let error = read(&changed).expect_err(path);
        assert!(error.path == path && error.to_string().contains(words), "{error}");
    };
    refused(
        &|json| json.pointer_mut(&pointer).expect("there")["attributes"]["POSITION"] = json!(77),
        &format!("{path}.attributes.POSITION"),
        "77",
    );
    refused(
        &|json| json.pointer_mut(&pointer).expect("there")["attributes"]["POSITION"] = json!("a"),
        &format!("{path}.attributes.POSITION"),
        "= a: must be a whole number",
    );
    refused(
        &|json| json.pointer_mut(&pointer).expect("there")["bufferView"] = json!(9999),
        "bufferViews[9999]",
        "must exist",
    );
    let view = whole.0.pointer(&pointer).expect("there")["bufferView"].as_u64().expect("an index") as usize;
    refused(&|json| json["bufferViews"][view]["byteLength"] = json!(20), &path, "[20 bytes]");
    // The accessor and the compressed attribute differ in their components.
    let normals = whole.0["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"].clone();
    refused(
        &|json| json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = normals.clone(),
        &format!("accessors[{normals}].type"),
        "Vec2",
    );
    refused(
        &|json| {
            let position = json.pointer(&pointer).expect("there")["attributes"]["POSITION"].clone();
            json.pointer_mut(&pointer).expect("there")["attributes"]["WEIGHTS_0"] = position;
        },
        &format!("{path}.attributes.WEIGHTS_0"),
        "3 components",
    );
}

#[test]
fn damaged_meshopt_is_refused_by_name() {
    let whole = file("meshopt.glb");
    let view = whole.0["bufferViews"].as_array().expect("a list").iter();
    let view = view
        .clone()
        .position(|view| view["extensions"][MESHOPT]["mode"] == "ATTRIBUTES")
        .expect("compressed");
    let path = format!("bufferViews[{view}].extensions.{MESHOPT}");
    let refused = |field: &str, value: Value, path: &str, words: &str| {
        let mut changed = whole.clone();
        changed.0["bufferViews"][view]["extensions"][MESHOPT][field] = value;
        let error = read(&changed).expect_err(path);
        assert!(error.path == path && error.to_string().contains(words), "{error}");
    };
    refused("mode", json!("TRIANGLES"), &path, "must decompress to");
    refused("mode", json!("FOO"), &format!("{path}.mode"), "= FOO: must be one of `ATTRIBUTES`");
    refused("filter", json!("FOO"), &format!("{path}.filter"), "= FOO: must be one of `NONE`");
    refused("byteStride", json!(3), &path, "of 3 bytes");
    refused("byteLength", json!(7), &path, "[7 bytes]");
    refused("byteLength", json!(1 << 30), &format!("{path}.byteLength"), "must lie in buffers[0]");
    refused("count", json!(1_u64 << 40), &format!("{path}.count"), "must be at most");
    // Elements without bytes take nothing from the budget, however many they are.
    for mode in ["ATTRIBUTES", "TRIANGLES", "INDICES"] {
        let mut changed = whole.clone();
        let extension = &mut changed.0["bufferViews"][view]["extensions"][MESHOPT];
        (extension["mode"], extension["byteStride"], extension["count"]) =
            (json!(mode), json!(0), json!(3_u64 << 40));
        let error = read(&changed).expect_err(mode);
        assert!(error.path == path && error.to_string().contains("of 0 bytes"), "{error}");
    }
}

/// Damage anywhere gives a model or an error.
#[test]
fn nothing_panics() {
    for name in ["draco.glb", "sequential.glb", "meshopt.glb"] {
        let (json, buffer) = file(name);
        let (mut read_so_far, mut refused) = (0, 0);
        for case in 0..1500 {
            let words = crate::sampling::noise(case ^ 0x5eed, 9);
            let mut changed = buffer.clone();
            for pair in words[..2 * (1 + case as usize % 4)].chunks_exact(2) {
                let at = ((pair[0] + 1.0) / 2.0 * (changed.len() - 1) as f32) as usize;
                changed[at] = ((pair[1] + 1.0) * 128.0) as u8;
            }
            match read(&(json.clone(), changed)) {
                Ok(model) => {
                    read_so_far += 1;
                    assert!(model.meshes.iter().all(|mesh| mesh.validate(&model.skins).is_ok()));
                }
                Err(_) => refused += 1,
            }
        }
        assert!(read_so_far > 50 && refused > 50, "{name}: {read_so_far} read, {refused} refused");
        let mut pointers = Vec::new();
        crate::malformed::collect(&json, String::new(), &mut pointers);
        for pointer in pointers.iter().filter(|pointer| pointer.contains("compression")) {
            for value in [json!(null), json!(-1), json!(1), json!(1e300), json!("x"), json!([]), json!({})] {
                let mut changed = json.clone();
                *changed.pointer_mut(pointer).expect("collected") = value;
                drop(read(&(changed, buffer.clone())));
            }
        }
    }
}
