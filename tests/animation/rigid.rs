//! Meshes without a skin: which bones they follow, and what becomes of their nodes. `crates/relievo-cli/tests/cli/skin.rs` checks
//! the positions of their vertices.

use relievo::asset::Model;
use serde_json::{Value, json};

use crate::scene::Scene;

/// Two joints, and a mesh that a node may have.
fn scene() -> Scene {
    let mut scene = Scene::of_two_bones();
    let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
    scene.json["accessors"][positions]["max"] = json!([1, 1, 0]);
    let target = scene.floats("VEC3", &[0.0; 9]);
    scene.json["meshes"] =
        json!([{"primitives": [{"attributes": {"POSITION": positions}, "targets": [{"POSITION": target}]}]}]);
    scene
}

/// A node below another.
fn below(scene: &mut Scene, parent: usize, node: Value) -> usize {
    let node = scene.push("nodes", node);
    let mut children = scene.json["nodes"][parent]["children"].as_array().cloned().unwrap_or_default();
    children.push(json!(node));
    scene.json["nodes"][parent]["children"] = json!(children);
    node
}

fn read(scene: &Scene) -> Model {
    let model = Model::from_gltf(&scene.glb(), None).expect("valid");
    assert!(model.meshes.iter().all(|mesh| mesh.validate(&model.skins) == Ok(())));
    assert!(model.skins.iter().all(|skin| skin.validate(&model.skeleton) == Ok(())));
    assert_eq!(model.skeleton.joints().len(), 2);
    model
}

/// The names of the bones, and for each mesh its name and the bone that it follows.
fn followed(model: &Model) -> (Vec<&str>, Vec<(&str, &str)>) {
    let bones: Vec<&str> = model.skeleton.bones().iter().map(|bone| &*bone.name).collect();
    let of = |mesh: &relievo::asset::Mesh| {
        let skin = &model.skins[mesh.skin];
        assert!((0..mesh.vertices()).all(|vertex| mesh.influences.of(vertex).len() == 1));
        (skin.name.clone(), skin.bones[0] as usize)
    };
    let names = model.meshes.iter().zip(model.meshes.iter().map(of));
    let names = names.map(|(mesh, (skin, bone))| {
        assert_eq!(mesh.name, format!("{skin}_0"));
        (&*mesh.name, bones[bone])
    });
    (bones.clone(), names.collect())
}

fn move_node(scene: &mut Scene, node: usize) {
    let (times, values) = (scene.floats("SCALAR", &[0.0]), scene.floats("VEC3", &[1.0, 2.0, 3.0]));
    scene.animate(node, "translation", "LINEAR", times, values);
}

#[test]
fn the_lowest_node_that_may_move_is_followed() {
    let mut scene = scene();
    let grip = below(&mut scene, 1, json!({"name": "grip", "scale": [2, 2, 2]}));
    below(&mut scene, grip, json!({"name": "sword", "mesh": 0, "translation": [0, 1, 0]}));
    let model = read(&scene);
    assert_eq!(followed(&model), (vec!["root", "tip"], vec![("sword_0", "tip")]));
    let bind = &model.skins[1].inverse_binds[0];
    assert_eq!((bind[0], bind[5], bind[13]), (2.0, 2.0, 2.0));
    // A joint may have a mesh of its own.
    scene.json["nodes"][0]["mesh"] = json!(0);
    assert_eq!(followed(&read(&scene)).1, [("root_0", "root"), ("sword_0", "tip")]);
    // A node that a clip moves becomes a bone.
    move_node(&mut scene, grip);
    let model = read(&scene);
    assert_eq!(followed(&model).0, ["root", "tip", "grip"]);
    assert_eq!(followed(&model).1[1], ("sword_0", "grip"));
    assert!(!model.clips[0].tracks().is_empty() && model.skins[2].inverse_binds[0][0] == 1.0);
}

#[test]
fn what_hangs_on_no_joint_stays_where_it_is() {
    let mut scene = scene();
    let field = scene.push("nodes", json!({"name": "field", "translation": [5, 0, 0]}));
    let wall = below(&mut scene, field, json!({"name": "wall", "rotation": [0, 1, 0, 0]}));
    let stone = below(&mut scene, wall, json!({"name": "stone", "mesh": 0}));
    let model = read(&scene);
    assert_eq!(followed(&model), (vec!["root", "tip", "field"], vec![("stone_0", "field")]));
    assert_eq!(model.skins[1].inverse_binds[0][0], -1.0);
    // Keys of morph weights move no node.
    let (times, values) = (scene.floats("SCALAR", &[0.0]), scene.floats("SCALAR", &[0.5]));
    scene.animate(stone, "weights", "LINEAR", times, values);
    let model = read(&scene);
    assert_eq!(model.skeleton.len(), 3);
    assert_eq!(model.meshes[0].weights_at(0, 0.0), [0.5]);
    move_node(&mut scene, wall);
    assert_eq!(followed(&read(&scene)).0, ["root", "tip", "field", "wall"]);
}

#[test]
fn skinned_meshes_come_first() {
    let mut scene = scene();
    scene.push("nodes", json!({"name": "stone", "mesh": 0}));
    let weights = scene.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let joints = scene.integers("VEC4", 1, &[0; 12]);
    let mut primitive = scene.json["meshes"][0]["primitives"][0].clone();
    primitive["attributes"]["WEIGHTS_0"] = json!(weights);
    primitive["attributes"]["JOINTS_0"] = json!(joints);
    let body = scene.json["meshes"].as_array_mut().expect("a list");
    body.push(json!({"primitives": [primitive]}));
    scene.push("nodes", json!({"name": "body", "mesh": 1, "skin": 0}));
    let model = read(&scene);
    assert_eq!(model.meshes.iter().map(|mesh| &*mesh.name).collect::<Vec<_>>(), ["body_0", "stone_0"]);
    assert_eq!(model.meshes.iter().map(|mesh| mesh.skin).collect::<Vec<_>>(), [0, 1]);
    // The node has a mesh with joint indices, but no skin whose joints they could name.
    scene.json["nodes"][2]["mesh"] = json!(1);
    let model = read(&scene);
    assert_eq!(model.meshes[1].influences.of(0).len(), 1);
    assert_eq!(model.skeleton.bones()[model.skins[1].bones[0] as usize].name, "stone");
}

#[test]
fn what_cannot_be_placed_is_refused() {
    let refused = |scene: &Scene, field: &str, words: &str| {
        let error = Model::from_gltf(&scene.gltf(), None).expect_err(field);
        assert!(error.path == field && error.to_string().contains(words), "{error}");
    };
    let mut round = scene();
    let first = round.push("nodes", json!({"mesh": 0, "children": [3]}));
    round.push("nodes", json!({"children": [first]}));
    refused(&round, "nodes[2]", "must not lie below itself");
    let mut far = scene();
    let huge = below(&mut far, 1, json!({"scale": [1e30, 1, 1]}));
    below(&mut far, huge, json!({"mesh": 0, "scale": [1e30, 1, 1]}));
    refused(&far, "nodes[3].matrix[0]", "must be finite");
    let mut flat = scene();
    below(&mut flat, 1, json!({"mesh": 0, "matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}));
    refused(&flat, "nodes[2].matrix", "0 0 0 1");
    let mut turned = scene();
    below(&mut turned, 1, json!({"mesh": 0, "rotation": [0, 0, 0, 0]}));
    refused(&turned, "nodes[2].rotation", "unit quaternion");
}
