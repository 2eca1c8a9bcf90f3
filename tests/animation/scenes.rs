//! Which part of a document is imported: the default scene, with or without skins, and extensions that it requires.

use relievo::asset::Model;
use relievo::asset::transform::Affine;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo::ops::skinning::InstanceLod;
use relievo::ops::skinning::vertex::Blend;
use serde_json::{Value, json};

use crate::meshes::Skinned;
use crate::scene::Scene;

/// One triangle that nodes may have.
fn with_triangle() -> Scene {
    let mut scene = Scene::new();
    let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
    scene.json["accessors"][positions]["max"] = json!([1, 1, 0]);
    scene.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}}]}]);
    scene
}

fn read(scene: &Scene) -> Model {
    let model = Model::from_gltf(&scene.gltf(), None).expect("valid");
    assert!(model.skins.iter().all(|skin| skin.validate(&model.skeleton) == Ok(())));
    assert!(model.meshes.iter().all(|mesh| mesh.validate(&model.skins) == Ok(())));
    model
}

fn refused(scene: &Scene, field: &str, words: &str) {
    let error = Model::from_gltf(&scene.gltf(), None).expect_err(field);
    assert!(error.path == field && error.to_string().contains(words), "{error}");
}

fn bones(model: &Model) -> Vec<&str> {
    model.skeleton.bones().iter().map(|bone| &*bone.name).collect()
}

fn meshes(model: &Model) -> Vec<&str> {
    model.meshes.iter().map(|mesh| &*mesh.name).collect()
}

/// The positions of each mesh's vertices.
fn places(model: &Model, models: &[Affine]) -> Vec<Vec<[f32; 3]>> {
    use relievo::ops::skinning::morph::reference::morph;
    use relievo::ops::skinning::palette::reference::palette_for;
    use relievo::ops::skinning::skin::reference::skin;
    let place = |mesh: &relievo::asset::Mesh| {
        let palette = palette_for(&model.skins[mesh.skin], models, Blend::Linear);
        let vertices = skin(&morph(mesh, &mesh.weights), &mesh.influences, &palette, InstanceLod::FULL);
        vertices.iter().map(|vertex| vertex.position).collect()
    };
    model.meshes.iter().map(place).collect()
}

fn keyed(scene: &mut Scene, node: usize, last: [f32; 3]) {
    let times = scene.floats("SCALAR", &[0.0, 2.0]);
    let values = scene.floats("VEC3", &[[0.0; 3], last].concat());
    scene.animate(node, "translation", "LINEAR", times, values);
}

#[test]
fn the_default_scene_alone_is_imported() {
    let mut scene = with_triangle();
    scene.push("nodes", json!({"name": "ship", "children": [1], "translation": [1, 0, 0]}));
    scene.push("nodes", json!({"name": "mast", "mesh": 0}));
    scene.push("nodes", json!({"name": "quay", "mesh": 0}));
    scene.push("nodes", json!({"name": "gull", "mesh": 0}));
    assert_eq!(meshes(&read(&scene)), ["mast_0", "quay_0", "gull_0"]);
    scene.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [3, 2]}, {}]);
    let first = read(&scene);
    assert_eq!((meshes(&first), bones(&first)), (vec!["mast_0"], vec!["ship"]));
    scene.json["scene"] = json!(0);
    assert_eq!(read(&scene), first);
    scene.json["scene"] = json!(1);
    let second = read(&scene);
    assert_eq!((meshes(&second), bones(&second)), (vec!["quay_0", "gull_0"], vec!["quay", "gull"]));
    // A node that moves only in another scene is not a bone here, but its clip's duration counts.
    keyed(&mut scene, 1, [9.0; 3]);
    let moved = read(&scene);
    assert_eq!((bones(&moved), moved.clips[0].duration()), (vec!["quay", "gull"], 2.0));
    scene.json["scene"] = json!(2);
    refused(&scene, "nodes", "in the default scene");
    scene.json["scene"] = json!(3);
    refused(&scene, "scene", "must lie in the list");
    scene.json["scene"] = json!(0);
    scene.json["scenes"][0]["nodes"] = json!([0, 1]);
    refused(&scene, "scenes[0].nodes[1]", "must be a root");
}

/// A skin's joints count if a node of the scene uses it, or if no node at all does.
#[test]
fn skins_of_other_scenes_are_left_out() {
    let mut skinned = Skinned::new();
    let mut other = skinned.0.json["nodes"][2].clone();
    other["name"] = json!("other");
    other["skin"] = json!(1);
    skinned.0.json["scenes"] = json!([{"nodes": [0, 2]}, {"nodes": [3, 4]}]);
    skinned.0.push("nodes", json!({"name": "third", "children": [5]}));
    skinned.0.push("nodes", other);
    skinned.0.push("nodes", json!({"name": "fourth", "translation": [0, 0, 3]}));
    skinned.0.push("skins", json!({"joints": [3, 5], "name": "second"}));
    let model = read(&skinned.0);
    assert_eq!((bones(&model), meshes(&model)), (vec!["root", "tip"], vec!["body_0"]));
    assert_eq!((model.skins.len(), model.skinned), (1, 1));
    skinned.0.json["scene"] = json!(1);
    let model = read(&skinned.0);
    assert_eq!((bones(&model), meshes(&model)), (vec!["third", "fourth"], vec!["other_0"]));
    assert_eq!((&*model.skins[0].name, model.meshes[0].skin), ("second", 0));
    // Without a node that has it, a skin of this scene is read, and one of the other scene is not.
    skinned.0.json["nodes"][4].as_object_mut().expect("an object").remove("skin");
    let model = read(&skinned.0);
    assert_eq!((&*model.skins[0].name, model.skins.len(), model.skinned), ("second", 2, 0));
}

/// glTF forbids such joints, but vertices follow them nevertheless.
#[test]
fn joints_outside_the_scene_pose_the_vertices_that_follow_them() {
    let mut skinned = Skinned::new();
    skinned.0.json["nodes"][1]["translation"] = json!([0, 7, 0]);
    let inside = read(&skinned.0);
    skinned.0.json["scenes"] = json!([{"nodes": [2]}]);
    let model = read(&skinned.0);
    assert_eq!((bones(&model), meshes(&model)), (vec!["root", "tip"], vec!["body_0"]));
    let at_rest = |model: &Model| places(model, &local_to_model(&model.skeleton, &model.skeleton.rest()));
    assert_eq!(at_rest(&model)[0][1], [1.0, 0.75 * 7.0, 0.0]);
    assert_eq!(at_rest(&model), at_rest(&inside));
}

/// A wagon whose wheel turns only itself: moving nodes are bones, and meshes follow them.
#[test]
fn rigid_parts_need_no_skin() {
    let mut scene = with_triangle();
    scene.push("nodes", json!({"name": "road", "children": [1, 4], "translation": [0, 0, 5]}));
    scene.push("nodes", json!({"name": "wagon", "mesh": 0, "children": [2], "scale": [2, 2, 2]}));
    scene.push("nodes", json!({"name": "axle", "translation": [0, -1, 0], "children": [3]}));
    scene.push("nodes", json!({"name": "wheel", "mesh": 0, "translation": [1, 0, 0]}));
    scene.push("nodes", json!({"name": "camera"}));
    keyed(&mut scene, 1, [4.0, 0.0, 0.0]);
    scene.json["animations"][0]["channels"][0]["target"]["node"] = json!(1);
    let times = scene.floats("SCALAR", &[0.0, 2.0]);
    let turns = scene.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let animation = &mut scene.json["animations"][0];
    animation["samplers"].as_array_mut().expect("a list").push(json!({"input": times, "output": turns}));
    let target = json!({"sampler": 1, "target": {"node": 3, "path": "rotation"}});
    animation["channels"].as_array_mut().expect("a list").push(target);
    let model = read(&scene);
    assert_eq!(bones(&model), ["road", "wagon", "axle", "wheel"]);
    assert_eq!((model.skeleton.joints(), model.skinned), (&[0, 1, 2, 3][..], 0));
    assert_eq!(meshes(&model), ["wagon_0", "wheel_0"]);
    let clip = &model.clips[0];
    let locals = sample(clip, 1.0, relievo::asset::keyframe::RotationPath::Slerp);
    let found = places(&model, &local_to_model(&model.skeleton, &locals));
    // Half way, the wagon has moved by 2, and the wheel has turned by a quarter about its axle, at (1, −1) of
    // the wagon.
    let near = |found: [f32; 3], wanted: [f32; 3]| {
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} for {wanted:?}");
    };
    near(found[0][1], [4.0, 0.0, 5.0]);
    near(found[1][0], [4.0, -2.0, 5.0]);
    near(found[1][1], [4.0, 0.0, 5.0]);
    // A moving node without a mesh is a bone too; a node that neither moves nor carries a mesh is not.
    keyed(&mut scene, 4, [0.0; 3]);
    assert_eq!(bones(&read(&scene)), ["road", "wagon", "axle", "wheel", "camera"]);
}

#[test]
fn what_never_moves_is_imported_too() {
    let mut scene = with_triangle();
    scene.push("nodes", json!({"name": "hill", "children": [1], "translation": [0, 2, 0]}));
    scene.push("nodes", json!({"name": "house", "mesh": 0, "translation": [3, 0, 0]}));
    scene.push("nodes", json!({"name": "lamp"}));
    let model = read(&scene);
    assert_eq!((bones(&model), meshes(&model)), (vec!["hill"], vec!["house_0"]));
    assert!(model.clips.is_empty());
    let at_rest = relievo::asset::Clip::at_rest("rest", &model.skeleton).expect("valid");
    assert_eq!((at_rest.name(), at_rest.duration()), ("rest", 0.0));
    let locals = sample(&at_rest, 0.0, relievo::asset::keyframe::RotationPath::Slerp);
    assert_eq!(locals, model.skeleton.rest());
    assert_eq!(places(&model, &local_to_model(&model.skeleton, &locals))[0][1], [4.0, 2.0, 0.0]);
    // The scene has nothing that could be drawn.
    scene.json["nodes"] = json!([{"name": "lamp"}]);
    refused(&scene, "nodes", "must have a mesh, a skin or an animated node");
}

fn required(names: Value) -> Scene {
    let mut scene = Scene::of_two_bones();
    scene.json["extensionsUsed"] = names.clone();
    scene.json["extensionsRequired"] = names;
    scene
}

#[test]
fn what_is_required_and_not_read_is_refused_by_name() {
    for (names, at, name) in [
        (json!(["FOO_unknown_ext"]), 0, "FOO_unknown_ext"),
        (json!(["KHR_mesh_quantization", "EXT_mesh_gpu_instancing"]), 1, "EXT_mesh_gpu_instancing"),
        (json!(["EXT_meshopt_compression", "KHR_audio_emitter"]), 1, "KHR_audio_emitter"),
        (json!(["KHR_texture_transform", "KHR_texture_basisu"]), 1, "KHR_texture_basisu"),
        (json!(["KHR_animation_pointer"]), 0, "KHR_animation_pointer"),
    ] {
        let error = Model::from_gltf(&required(names).gltf(), None).expect_err(name);
        assert_eq!((&*error.path, &*error.value), (&*format!("extensionsRequired[{at}]"), name));
        assert!(error.bound.contains("KHR_texture_transform"), "{error}");
    }
    read(&required(json!([
        "KHR_texture_transform",
        "KHR_mesh_quantization",
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "KHR_meshopt_compression",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_unlit",
        "EXT_texture_webp",
        "KHR_lights_punctual",
    ])));
    let mut used = required(json!([]));
    used.json["extensionsUsed"] = json!(["FOO_unknown_ext"]);
    read(&used);
}

/// Some exporters list the child of a node that no scene has. It is a root then, as in three.js.
#[test]
fn a_scene_may_list_children_of_nodes_that_it_lacks() {
    let mut scene = with_triangle();
    scene.push("nodes", json!({"name": "tmpParent", "children": [1], "translation": [5, 0, 0]}));
    scene.push("nodes", json!({"name": "ship", "mesh": 0, "children": [2]}));
    scene.push("nodes", json!({"name": "mast", "mesh": 0, "translation": [0, 3, 0]}));
    scene.json["scenes"] = json!([{"nodes": [1]}]);
    let model = read(&scene);
    assert_eq!((meshes(&model), bones(&model)), (vec!["ship_0", "mast_0"], vec!["ship"]));
    // The node outside is a joint of a mesh in the scene, and its child is a root all the same.
    scene.push("skins", json!({"joints": [0, 2]}));
    let model = read(&scene);
    assert_eq!(bones(&model), ["ship"]);
    scene.push("nodes", json!({"name": "crew", "skin": 0}));
    scene.json["scenes"] = json!([{"nodes": [1, 3]}]);
    assert_eq!(bones(&read(&scene)), ["tmpParent", "ship", "mast"]);
}

/// A node with many copies of its mesh would become one mesh.
#[test]
fn copies_of_meshes_are_refused_by_name() {
    let mut scene = with_triangle();
    scene.push("nodes", json!({"name": "door", "mesh": 0}));
    let copies = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}});
    scene.push("nodes", json!({"name": "tree", "mesh": 0, "extensions": copies}));
    refused(&scene, "nodes[1].extensions.EXT_mesh_gpu_instancing", "a node for each copy");
    // A node that the scene lacks.
    scene.json["scenes"] = json!([{"nodes": [0]}]);
    assert_eq!(read(&scene).meshes.len(), 1);
}

/// An import that reads neither materials nor images ignores their extensions, and textures without an image.
/// image.
#[test]
fn who_reads_no_images_needs_none() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("model.gltf");
    let bare = |scene: &Scene| {
        std::fs::write(&path, scene.gltf()).expect("writable");
        Model::from_file_bare(&path)
    };
    bare(&required(json!(["KHR_texture_basisu", "KHR_materials_unlit", "EXT_texture_avif"]))).expect("valid");
    let error = bare(&required(json!(["FOO_unknown_ext"]))).expect_err("refused").to_string();
    assert!(error.contains("extensionsRequired[0] = FOO_unknown_ext"), "{error}");
    let mut skinned = Skinned::new();
    crate::textures::add_texture(&mut skinned);
    skinned.0.json["textures"] = json!([{"extensions": {"EXT_texture_avif": {"source": 0}}}]);
    assert_eq!(bare(&skinned.0).expect("valid").meshes.len(), 1);
    refused(&skinned.0, "textures[0].extensions.EXT_texture_avif", "gltf-transform png");
    skinned.0.json["textures"] = json!([{"extensions": {"KHR_texture_basisu": {"source": 0}}}]);
    refused(&skinned.0, "textures[0].extensions.KHR_texture_basisu", "gltf-transform ktxdecompress");
    skinned.0.json["textures"] = json!([{}]);
    refused(&skinned.0, "textures[0].source", "must be given");
    // The material is one that no mesh has.
    skinned.0.json["materials"].as_array_mut().expect("a list").push(json!({}));
    skinned.primitive()["material"] = json!(1);
    assert_eq!(read(&skinned.0).materials.len(), 1);
}
