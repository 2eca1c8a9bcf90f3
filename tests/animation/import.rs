//! Valid glTF documents of many kinds.

use relievo::asset::clip::{Interpolation, TransformPart};
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::asset::{Model, Transform};
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use serde_json::json;

use crate::scene::{FLOAT, Scene};

fn read(scene: &Scene) -> Model {
    let model = Model::from_gltf(&scene.gltf(), None).expect("valid");
    let binary = Model::from_gltf(&scene.glb(), None).expect("valid");
    assert_eq!(model, binary, "GLB and JSON differ");
    model
}

fn pose(model: &Model, clip: usize, time: f32) -> Vec<Affine> {
    local_to_model(&model.skeleton, &sample(&model.clips[clip], time, RotationPath::Slerp))
}

fn place(affine: &Affine) -> [f32; 3] {
    affine.map(|row| row[3])
}

#[test]
fn bones_above_and_between_joints_count() {
    let mut scene = Scene::new();
    // The nodes: 3 (moves) ─ 2 (joint) ─ 0 (no joint, scaled) ─ 1 (joint), and an unrelated node.
    scene.push("nodes", json!({"name": "between", "scale": [2.0, 2.0, 2.0], "children": [1, 4]}));
    scene.push("nodes", json!({"name": "tip", "translation": [0.0, 1.0, 0.0]}));
    scene.push("nodes", json!({"name": "root", "translation": [1.0, 0.0, 0.0], "children": [0]}));
    scene.push("nodes", json!({"name": "above", "children": [2]}));
    scene.push("nodes", json!({"name": "lamp"}));
    scene.push("skins", json!({"joints": [1, 2]}));
    let (times, values) =
        (scene.floats("SCALAR", &[0.0, 1.0]), scene.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 8.0]));
    scene.animate(3, "translation", "LINEAR", times, values);
    let model = read(&scene);
    let names: Vec<_> = model.skeleton.bones().iter().map(|bone| bone.name.as_str()).collect();
    assert_eq!(names, ["above", "root", "between", "tip"]);
    assert_eq!(model.skeleton.joints(), [3, 1]);
    assert_eq!(model.skeleton.joint_parents(), [Some(1), None]);
    assert_eq!(place(&pose(&model, 0, 0.5)[3]), [1.0, 2.0, 4.0]);
    // Without inverse bind matrices they are the identity.
    assert_eq!(model.skins[0].inverse_binds, vec![glam::Mat4::IDENTITY.to_cols_array(); 2]);
}

#[test]
fn skins_share_joints() {
    let mut scene = Scene::of_two_bones();
    scene.push("nodes", json!({"name": "other"}));
    scene.push("skins", json!({"name": "second", "joints": [2, 1]}));
    let matrices: Vec<f32> = [2.0_f32, 3.0]
        .iter()
        .flat_map(|s| glam::Mat4::from_scale(glam::Vec3::splat(*s)).to_cols_array())
        .collect();
    let accessor = scene.floats("MAT4", &matrices);
    scene.json["skins"][1]["inverseBindMatrices"] = json!(accessor);
    let model = read(&scene);
    assert_eq!(model.skeleton.joints(), [0, 1, 2]);
    assert_eq!(model.skeleton.joint_parents(), [None, Some(0), None]);
    assert_eq!((&*model.skins[1].name, &model.skins[1].bones[..]), ("second", &[2, 1][..]));
    assert_eq!(model.skins[1].inverse_binds[1][0], 3.0);
    assert_eq!(model.skins[0].name, "skin_0");
    assert!(model.clips.is_empty());
}

#[test]
fn matrix_nodes_are_taken_apart() {
    let mut scene = Scene::of_two_bones();
    let rotation = glam::Quat::from_rotation_y(0.3);
    let matrix = glam::Mat4::from_scale_rotation_translation(
        glam::vec3(1.0, 2.0, 3.0),
        rotation,
        glam::vec3(4.0, 5.0, 6.0),
    );
    scene.json["nodes"][0]["matrix"] = json!(matrix.to_cols_array());
    let rest = read(&scene).skeleton.bones()[0].rest;
    assert_eq!(rest.translation, [4.0, 5.0, 6.0]);
    assert!((glam::Vec3::from(rest.scale) - glam::vec3(1.0, 2.0, 3.0)).length() < 1e-6);
    assert!(glam::Quat::from_array(rest.rotation).angle_between(rotation) < 1e-3);
}

#[test]
fn interpolations_names_and_durations() {
    let mut scene = Scene::of_two_bones();
    let times = scene.floats("SCALAR", &[0.0, 2.0]);
    let vectors = scene.floats("VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]);
    let spline = scene.floats("VEC3", &[0.0; 18]);
    let step = scene.animate(0, "translation", "STEP", times, vectors);
    scene.json["animations"][step]["name"] = json!("hop");
    scene.animate(1, "scale", "CUBICSPLINE", times, spline);
    // Channels of a node that is not a bone, and of no node, count only for the duration.
    scene.push("nodes", json!({"name": "lamp"}));
    let late = scene.floats("SCALAR", &[0.0, 9.0]);
    scene.json["animations"][0]["samplers"]
        .as_array_mut()
        .expect("a list")
        .push(json!({"input": late, "output": vectors}));
    let channels = scene.json["animations"][0]["channels"].as_array_mut().expect("a list");
    channels.push(json!({"sampler": 1, "target": {"node": 2, "path": "translation"}}));
    channels.push(json!({"sampler": 1, "target": {"path": "pointer", "extensions": {}}}));
    let model = read(&scene);
    let [hop, unnamed] = &model.clips[..] else { panic!("two clips") };
    assert_eq!((hop.name(), hop.duration()), ("hop", 9.0));
    assert_eq!((unnamed.name(), unnamed.duration()), ("animation_1", 2.0));
    assert_eq!(hop.track(0, TransformPart::Translation).interpolation, Interpolation::Step);
    assert_eq!(unnamed.track(1, TransformPart::Scale).interpolation, Interpolation::CubicSpline);
    assert_eq!(place(&pose(&model, 0, 1.9)[0]), [0.0; 3]);
    assert_eq!(place(&pose(&model, 0, 2.0)[0]), [4.0, 0.0, 0.0]);
    assert_eq!(model.clip("hop").expect("by name").duration(), 9.0);
    assert_eq!(model.clip("1").expect("by number").name(), "animation_1");
    let error = model.clip("2").expect_err("no such clip");
    assert!(error.path == "clip" && error.bound.contains("hop"), "{error}");
}

#[test]
fn interpolation_is_linear_when_nothing_is_said() {
    let mut scene = Scene::of_two_bones();
    let (times, values) =
        (scene.floats("SCALAR", &[0.0, 2.0]), scene.floats("VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]));
    let animation = scene.animate(0, "translation", "LINEAR", times, values);
    scene.json["animations"][animation]["samplers"][0]
        .as_object_mut()
        .expect("an object")
        .remove("interpolation");
    assert_eq!(place(&pose(&read(&scene), 0, 1.0)[0]), [2.0, 0.0, 0.0]);
}

/// Every element type that may stand for a fraction, with bytes between elements.
#[test]
fn normalized_integers_are_fractions() {
    for (kind, signed, bytes) in [(5120, true, 1), (5121, false, 1), (5122, true, 2), (5123, false, 2)] {
        let one: i32 = if signed { (1 << (8 * bytes - 1)) - 1 } else { (1 << (8 * bytes)) - 1 };
        let lowest = if signed { -one - 1 } else { 0 };
        // Two quaternions, each followed by 4 unrelated bytes.
        let mut buffer = Vec::new();
        for component in [0, 0, 0, one, lowest, 0, 0, one] {
            buffer.extend(&component.to_le_bytes()[..bytes]);
            if buffer.len() % (4 * bytes + 4) == 4 * bytes {
                buffer.extend([0x55; 4]);
            }
        }
        let mut scene = Scene::of_two_bones();
        let times = scene.floats("SCALAR", &[0.0, 1.0]);
        let view = scene.view(&buffer);
        scene.json["bufferViews"][view]["byteStride"] = json!(4 * bytes + 4);
        let values = scene.push(
            "accessors",
            json!({
                "bufferView": view, "componentType": kind, "type": "VEC4", "count": 2, "normalized": true
            }),
        );
        scene.animate(0, "rotation", "STEP", times, values);
        let model = read(&scene);
        let last = sample(&model.clips[0], 1.0, RotationPath::Slerp)[0].rotation;
        let expected =
            if signed { [-0.5_f32.sqrt(), 0.0, 0.0, 0.5_f32.sqrt()] } else { [0.0, 0.0, 0.0, 1.0] };
        assert!(last.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{kind}: {last:?}");
    }
}

#[test]
fn sparse_accessors_replace_some_elements() {
    for (kind, bytes) in [(5121, 1), (5123, 2), (5125, 4)] {
        for with_view in [true, false] {
            let mut scene = Scene::of_two_bones();
            let times = scene.floats("SCALAR", &[0.0, 1.0, 2.0]);
            let indices: Vec<u8> =
                [0_u32, 2].iter().flat_map(|i| i.to_le_bytes()[..bytes].to_vec()).collect();
            let indices = scene.view(&indices);
            let new: Vec<u8> =
                [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0].iter().flat_map(|v| v.to_le_bytes()).collect();
            let new = scene.view(&new);
            let dense = scene.floats("VEC3", &[9.0; 9]);
            let sparse = json!({
                "count": 2, "indices": {"bufferView": indices, "componentType": kind}, "values": {"bufferView": new}
            });
            scene.json["accessors"][dense]["sparse"] = sparse;
            if !with_view {
                scene.json["accessors"][dense].as_object_mut().expect("an object").remove("bufferView");
            }
            scene.animate(0, "translation", "LINEAR", times, dense);
            let model = read(&scene);
            let rest = if with_view { 9.0 } else { 0.0 };
            let at = |time| sample(&model.clips[0], time, RotationPath::Slerp)[0].translation;
            assert_eq!([at(0.0), at(1.0), at(2.0)], [[1.0, 2.0, 3.0], [rest; 3], [4.0, 5.0, 6.0]]);
        }
    }
}

#[test]
fn buffers_lie_beside_the_document() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut scene = Scene::of_two_bones();
    let (times, values) = (scene.floats("SCALAR", &[0.0]), scene.floats("VEC3", &[1.0, 2.0, 3.0]));
    scene.animate(1, "translation", "LINEAR", times, values);
    let length = scene.buffer.len();
    scene.json["buffers"] = json!([{"byteLength": length, "uri": "a%20b/data.bin"}]);
    std::fs::create_dir(folder.path().join("a b")).expect("writable");
    std::fs::write(folder.path().join("a b/data.bin"), &scene.buffer).expect("writable");
    std::fs::write(folder.path().join("model.gltf"), scene.gltf()).expect("writable");
    let model = Model::from_file(&folder.path().join("model.gltf")).expect("valid");
    assert_eq!(
        sample(&model.clips[0], 0.0, RotationPath::Slerp)[1],
        Transform::from_translation([1.0, 2.0, 3.0])
    );
    let error = Model::from_gltf(&scene.gltf(), None).expect_err("no folder");
    assert_eq!(error.path, "buffers[0].uri");
}

#[test]
fn unknown_chunks_are_skipped() {
    let mut scene = Scene::of_two_bones();
    scene.json["asset"]["extras"] = json!({"float": FLOAT});
    assert_eq!(read(&scene).skeleton.len(), 2);
    let mut bytes = scene.glb();
    bytes.extend([4, 0, 0, 0, b'W', b'H', b'A', b'T', 1, 2, 3, 4]);
    let length = (bytes.len() as u32).to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    assert!(Model::from_gltf(&bytes, None).is_ok());
}

/// A chain of a thousand bones is imported without recursion.
#[test]
fn chains_may_be_long() {
    let mut scene = Scene::new();
    let bones = 20_000;
    for node in 0..bones {
        let children = if node + 1 < bones { json!([node + 1]) } else { json!([]) };
        scene.push("nodes", json!({"children": children, "translation": [0.0, 1.0, 0.0]}));
    }
    scene.push("skins", json!({"joints": [bones - 1, 0]}));
    // glTF does not allow empty lists.
    scene.json["nodes"][bones - 1].as_object_mut().expect("an object").remove("children");
    let model = read(&scene);
    let models = local_to_model(&model.skeleton, &model.skeleton.rest());
    assert_eq!(place(models.last().expect("bones")), [0.0, bones as f32, 0.0]);
    assert_eq!(model.skeleton.joint_parents(), [Some(1), None]);
}

/// Puts an application's data into every object.
fn add_extras(value: &mut serde_json::Value, extras: &serde_json::Value) {
    match value {
        serde_json::Value::Object(members) => {
            members.values_mut().for_each(|member| add_extras(member, extras));
            members.insert("extras".to_owned(), extras.clone());
        }
        serde_json::Value::Array(elements) => {
            elements.iter_mut().for_each(|element| add_extras(element, extras))
        }
        _ => {}
    }
}

/// A document with a mesh, a material, a texture, an animation and a sparse accessor.
fn varied() -> Scene {
    let mut skinned = crate::meshes::Skinned::new();
    let uv = skinned.0.floats("VEC2", &[0.5; 8]);
    skinned.attribute("TEXCOORD_0", uv);
    crate::textures::add_texture(&mut skinned);
    let mut scene = skinned.0;
    let (indices, new) = (scene.view(&[1]), scene.view(&[0; 12]));
    let (times, values) = (scene.floats("SCALAR", &[0.0, 1.0]), scene.floats("VEC3", &[0.5; 6]));
    scene.json["accessors"][values]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": new}
    });
    scene.animate(1, "translation", "LINEAR", times, values);
    scene.json["scenes"] = json!([{"nodes": [0, 2]}]);
    scene.json["scene"] = json!(0);
    scene.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]);
    scene
}

#[test]
fn extras_may_be_any_value() {
    let scene = varied();
    let plain = read(&scene);
    assert_eq!((plain.meshes.len(), plain.materials.len(), plain.clips.len()), (1, 1, 1));
    for extras in
        [json!(null), json!(true), json!(1.5), json!("Blender"), json!([1, "a"]), json!({"a": {"b": 1}})]
    {
        let mut changed = Scene { json: scene.json.clone(), buffer: scene.buffer.clone() };
        // Members of attributes are accessors.
        let attributes = changed.json["meshes"][0]["primitives"][0]["attributes"].clone();
        add_extras(&mut changed.json, &extras);
        changed.json["meshes"][0]["primitives"][0]["attributes"] = attributes;
        assert_eq!(read(&changed), plain, "{extras}");
    }
}

#[test]
fn integers_may_be_written_with_a_fraction_or_an_exponent() {
    fn as_floats(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Object(members) => members.values_mut().for_each(as_floats),
            serde_json::Value::Array(elements) => elements.iter_mut().for_each(as_floats),
            serde_json::Value::Number(number) => *value = json!(number.as_f64().expect("a number")),
            _ => {}
        }
    }
    let scene = varied();
    let plain = read(&scene);
    let mut changed = Scene { json: scene.json.clone(), buffer: scene.buffer.clone() };
    as_floats(&mut changed.json);
    assert!(changed.json["accessors"][0]["count"].is_f64() && changed.json["nodes"][2]["mesh"].is_f64());
    assert_eq!(read(&changed), plain);
    let text = String::from_utf8(scene.gltf()).expect("text").replace("\"count\":4,", "\"count\":0.4e1,");
    assert!(text.contains("0.4e1"));
    assert_eq!(Model::from_gltf(text.as_bytes(), None).expect("valid"), plain);
    // Not a whole number.
    changed.json["accessors"][0]["count"] = json!(4.5);
    let error = Model::from_gltf(&changed.gltf(), None).expect_err("refused");
    assert!(error.path == "accessors[0].count" && error.to_string().contains("4.5"), "{error}");
}

#[test]
fn a_byte_order_mark_is_skipped() {
    let scene = Scene::of_two_bones();
    let text = [b"\xef\xbb\xbf", &scene.gltf()[..]].concat();
    assert_eq!(Model::from_gltf(&text, None).expect("valid"), read(&scene));
}

/// A pointer at a part of a node is a channel of this node; pointers at other things are left out.
#[test]
fn pointers_at_nodes_are_channels() {
    let mut scene = Scene::of_two_bones();
    let (times, values) =
        (scene.floats("SCALAR", &[0.0, 2.0]), scene.floats("VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]));
    scene.animate(1, "translation", "LINEAR", times, values);
    let plain = read(&scene);
    let pointing = |pointer: &str| json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}});
    let channels = &mut scene.json["animations"][0]["channels"];
    channels[0]["target"] = pointing("/nodes/1/translation");
    channels
        .as_array_mut()
        .expect("a list")
        .push(json!({"sampler": 0, "target": pointing("/materials/0/alphaCutoff")}));
    assert_eq!(read(&scene), plain);
    scene.json["animations"][0]["channels"][0]["target"] = pointing("/nodes/9/translation");
    let error = Model::from_gltf(&scene.gltf(), None).expect_err("refused");
    assert_eq!((&*error.path, &*error.value), ("animations[0].channels[0].target.node", "9"));
}
