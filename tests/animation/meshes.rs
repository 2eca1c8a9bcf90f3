//! Meshes of glTF documents, valid and invalid.

use relievo::InputError;
use relievo::asset::Model;
use relievo::asset::{Mesh, MorphTarget};
use serde_json::{Value, json};

use crate::scene::Scene;

/// Two bones, and a node with a skinned mesh of one primitive of 4 vertices.
pub struct Skinned(pub Scene);

impl Skinned {
    pub fn new() -> Self {
        let mut scene = Scene::of_two_bones();
        let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
        scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
        scene.json["accessors"][positions]["max"] = json!([1, 1, 0]);
        let weights =
            scene.floats("VEC4", &[[1.0, 0.0, 0.0, 0.0], [0.25, 0.75, 0.0, 0.0]].concat().repeat(2));
        let joints = scene.integers("VEC4", 1, &[0, 1, 0, 0].repeat(4));
        scene.json["meshes"] = json!([{"primitives": [{
            "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights}, "mode": 5
        }]}]);
        scene.push("nodes", json!({"name": "body", "skin": 0, "mesh": 0, "translation": [9.0, 9.0, 9.0]}));
        Self(scene)
    }

    pub fn attribute(&mut self, name: &str, accessor: usize) {
        self.primitive()["attributes"][name] = json!(accessor);
    }

    pub fn primitive(&mut self) -> &mut Value {
        &mut self.0.json["meshes"][0]["primitives"][0]
    }

    pub fn read(&self) -> Result<Mesh, InputError> {
        let model = Model::from_gltf(&self.0.gltf(), None)?;
        assert_eq!(model, Model::from_gltf(&self.0.glb(), None)?);
        assert_eq!(model.meshes[0].validate(&model.skins), Ok(()));
        Ok(model.meshes.into_iter().next().expect("a mesh"))
    }

    pub fn refused(&self, field: &str, words: &str) {
        let error = self.read().expect_err(field);
        assert!(error.path == field && error.to_string().contains(words), "{error}");
    }
}

fn weights(mesh: &Mesh, vertex: usize) -> Vec<(u32, f32)> {
    mesh.influences.of(vertex).iter().map(|influence| (influence.bone, influence.weight)).collect()
}

#[test]
fn materials_say_whether_both_sides_are_seen() {
    let mut skinned = Skinned::new();
    assert!(!skinned.read().expect("valid").double_sided);
    skinned.0.json["materials"] = json!([{}, {"doubleSided": true}]);
    for (material, double_sided) in [(0, false), (1, true)] {
        skinned.primitive()["material"] = json!(material);
        assert_eq!(skinned.read().expect("valid").double_sided, double_sided);
    }
    skinned.primitive()["material"] = json!(2);
    skinned.refused("meshes[0].primitives[0].material", "must lie in");
}

#[test]
fn a_mesh_is_read() {
    let mut skinned = Skinned::new();
    let normals = skinned.0.floats("VEC3", &[[0.0, 0.0, 2.0], [0.0; 3]].concat().repeat(2));
    let tangents =
        skinned.0.floats("VEC4", &[[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, -1.0]].concat().repeat(2));
    let uv = skinned.0.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    skinned.attribute("NORMAL", normals);
    skinned.attribute("TANGENT", tangents);
    skinned.attribute("TEXCOORD_0", uv);
    skinned.attribute("_OWN", uv);
    let mesh = skinned.read().expect("valid");
    assert_eq!((&*mesh.name, mesh.skin, mesh.vertices()), ("body_0", 0, 4));
    assert_eq!(mesh.positions[3], [1.0, 1.0, 0.0]);
    // Longer normals are scaled to units; those without length are replaced by the surface's.
    assert_eq!(mesh.normals, vec![[0.0, 0.0, 1.0]; 4]);
    // glTF's handedness has the opposite sign.
    assert_eq!(mesh.tangents[..2], [[1.0, 0.0, 0.0, -1.0], [0.0, 1.0, 0.0, 1.0]]);
    assert_eq!(mesh.uv[1], [1.0, 1.0]);
    // The primitive is a triangle strip.
    assert_eq!(mesh.indices, [0, 1, 2, 2, 1, 3]);
    assert_eq!((weights(&mesh, 0), weights(&mesh, 1)), (vec![(0, 1.0)], vec![(1, 0.75), (0, 0.25)]));
    // Solved tangents agree with the file's convention: v points down here, against +Y.
    skinned.primitive()["attributes"].as_object_mut().expect("an object").remove("TANGENT");
    assert_eq!(skinned.read().expect("valid").tangents, vec![[1.0, 0.0, 0.0, -1.0]; 4]);
}

#[test]
fn triangles_of_every_mode() {
    let mut skinned = Skinned::new();
    let mut indices = |mode: u32, bytes: usize, indices: &[u32]| {
        let accessor = skinned.0.integers("SCALAR", bytes, indices);
        *skinned.primitive() = {
            let mut primitive = skinned.primitive().clone();
            primitive["mode"] = json!(mode);
            primitive["indices"] = json!(accessor);
            primitive
        };
        skinned.read().expect("valid").indices
    };
    assert_eq!(indices(4, 1, &[2, 1, 0, 3, 1, 2]), [2, 1, 0, 3, 1, 2]);
    assert_eq!(indices(5, 2, &[0, 1, 2, 2, 2, 3, 1]), [0, 1, 2, 2, 3, 1]);
    assert_eq!(indices(6, 4, &[0, 1, 3, 2]), [0, 1, 3, 0, 3, 2]);
    assert_eq!(indices(0, 1, &[0, 1]), [0; 0]);
    assert_eq!(indices(5, 1, &[0]), [0; 0]);
    let mut whole = Skinned::new();
    whole.primitive()["mode"] = json!(4);
    whole.refused("meshes[0].primitives[0].indices.count", "multiple of 3");
    let wrong = whole.0.integers("SCALAR", 2, &[0, 1, 4]);
    whole.primitive()["indices"] = json!(wrong);
    whole.refused("meshes[0].primitives[0].indices[2]", "below 4");
    let float = whole.0.floats("SCALAR", &[0.0, 1.0, 2.0]);
    whole.primitive()["indices"] = json!(float);
    whole.refused(&format!("accessors[{float}].componentType"), "unsigned");
}

#[test]
fn weights_of_every_type_and_number() {
    let mut skinned = Skinned::new();
    for (bytes, one) in [(1, 255), (2, 65_535)] {
        let given = skinned.0.integers("VEC4", bytes, &[0, one / 5, 4 * one / 5, 0].repeat(4));
        skinned.0.json["accessors"][given]["normalized"] = json!(true);
        let joints = skinned.0.integers("VEC4", bytes, &[0, 1, 0, 77].repeat(4));
        skinned.attribute("WEIGHTS_0", given);
        skinned.attribute("JOINTS_0", joints);
        let mesh = skinned.read().expect("valid");
        let found = weights(&mesh, 3);
        assert_eq!((found[0].0, found[1].0, found.len()), (0, 1, 2));
        assert!((found[0].1 - 0.8).abs() < 1e-7 && (found[1].1 - 0.2).abs() < 1e-7);
    }
    // A second set: five influences of three joints that do not sum to 1.
    skinned.0.push("nodes", json!({"name": "third"}));
    skinned.0.json["skins"][0]["joints"] = json!([0, 1, 3]);
    let given = skinned.0.floats("VEC4", &[1.0, 1.0, 1.0, 0.0].repeat(4));
    let joints = skinned.0.integers("VEC4", 1, &[2, 1, 2, 9].repeat(4));
    skinned.attribute("WEIGHTS_1", given);
    skinned.refused("meshes[0].primitives[0].attributes.JOINTS_1", "missing");
    skinned.attribute("JOINTS_1", joints);
    let found = weights(&skinned.read().expect("valid"), 0);
    assert_eq!(found.iter().map(|(joint, _)| *joint).collect::<Vec<_>>(), [2, 1, 0]);
    assert!((found.iter().map(|(_, weight)| weight).sum::<f32>() - 1.0).abs() < 1e-6);
    assert!((found[0].1 - 0.5).abs() < 1e-6 && (found[1].1 - 0.3).abs() < 1e-6);
}

/// Exporters write weights of 0 where nobody painted any. Such a vertex follows the joint in its first slot, as in three.js.
#[test]
fn vertices_without_weight_follow_their_first_joint() {
    use relievo::ops::animation::local_to_model::reference::local_to_model;
    use relievo::ops::skinning::palette::reference::palette_for;
    use relievo::ops::skinning::skin::reference::skin;
    use relievo::ops::skinning::{Blend, InstanceLod};
    let mut skinned = Skinned::new();
    let given = skinned.0.floats("VEC4", &[[0.0; 4], [1.0, 0.0, 0.0, 0.0], [0.0; 4], [-0.0; 4]].concat());
    let joints = skinned.0.integers("VEC4", 1, &[1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 1, 1, 1]);
    skinned.attribute("WEIGHTS_0", given);
    skinned.attribute("JOINTS_0", joints);
    let mesh = skinned.read().expect("valid");
    let followed = |mesh: &Mesh| (0..4).flat_map(|vertex| weights(mesh, vertex)).collect::<Vec<_>>();
    assert_eq!(followed(&mesh), [(1, 1.0), (0, 1.0), (0, 1.0), (1, 1.0)]);
    // The second joint is raised by 1, and the vertices that follow it too.
    let model = Model::from_gltf(&skinned.0.gltf(), None).expect("valid");
    let bones = local_to_model(&model.skeleton, &model.skeleton.rest());
    let palette = palette_for(&model.skins[0], &bones, Blend::Linear);
    let vertices = relievo::ops::skinning::morph::reference::morph(&mesh, &[]);
    let posed = skin(&vertices, &mesh.influences, &palette, InstanceLod::FULL);
    assert_eq!([0, 1, 2, 3].map(|vertex: usize| posed[vertex].position[1]), [1.0, 0.0, 1.0, 2.0]);
    // They are written as they are read.
    let again = Model::from_gltf(&model.to_glb().expect("written"), None).expect("valid");
    assert_eq!(again.meshes[0].influences, mesh.influences);
    // A joint of the first slot that the skin lacks is refused, although its weight is 0.
    let joints = skinned.0.integers("VEC4", 1, &[1, 0, 0, 0, 0, 0, 0, 0, 7, 1, 0, 0, 1, 1, 1, 1]);
    skinned.attribute("JOINTS_0", joints);
    skinned.refused("meshes[0].primitives[0].attributes.WEIGHTS_0[2]", "below 2, the skin's joints");
}

/// glTF has any number of influences.
#[test]
fn a_vertex_follows_the_strongest_of_many_joints() {
    let mut skinned = Skinned::new();
    for joint in 2..12 {
        skinned.0.push("nodes", json!({"name": format!("joint_{joint}")}));
    }
    skinned.0.json["skins"][0]["joints"] = json!([0, 1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
    for set in 0..3_u32 {
        let joints =
            skinned.0.integers("VEC4", 1, &[4 * set, 4 * set + 1, 4 * set + 2, 4 * set + 3].repeat(4));
        let weights: Vec<f32> =
            (0..4).map(|slot| if 4 * set + slot < 10 { (4 * set + slot + 1) as f32 } else { 0.0 }).collect();
        let weights = skinned.0.floats("VEC4", &weights.repeat(4));
        skinned.attribute(&format!("JOINTS_{set}"), joints);
        skinned.attribute(&format!("WEIGHTS_{set}"), weights);
    }
    let found = weights(&skinned.read().expect("valid"), 3);
    // Of the weights 1 to 10 the eight largest, whose sum is 52.
    let wanted: Vec<(u32, f32)> =
        (2..10).rev().map(|joint| (joint, (f64::from(joint + 1) / 52.0) as f32)).collect();
    assert_eq!(found, wanted);
}

/// Bounds of positions are not read.
#[test]
fn positions_need_no_bounds() {
    let mut skinned = Skinned::new();
    let plain = skinned.read().expect("valid");
    let accessor = skinned.primitive()["attributes"]["POSITION"].as_u64().expect("an index") as usize;
    for bound in ["min", "max"] {
        skinned.0.json["accessors"][accessor].as_object_mut().expect("an object").remove(bound);
        assert_eq!(skinned.read().expect("valid"), plain);
    }
}

/// glTF lets readers skip primitives without positions; extensions may give them.
#[test]
fn primitives_without_positions_are_left_out() {
    let mut skinned = Skinned::new();
    let mut bare = skinned.primitive().clone();
    bare["attributes"].as_object_mut().expect("an object").remove("POSITION");
    let whole = skinned.primitive().clone();
    skinned.0.json["meshes"][0]["primitives"] = json!([bare.clone(), whole, bare.clone()]);
    let model = Model::from_gltf(&skinned.0.gltf(), None).expect("valid");
    let names: Vec<_> = model.meshes.iter().map(|mesh| (mesh.name.as_str(), mesh.indices.len())).collect();
    assert_eq!(names, [("body_1", 6)]);
    // Nothing would be left.
    skinned.0.json["meshes"][0]["primitives"] = json!([bare]);
    skinned.refused("meshes[0].primitives[0].attributes.POSITION", "no primitive of the scene has positions");
}

#[test]
fn vertices_that_follow_nothing_are_refused() {
    let path = "meshes[0].primitives[0].attributes";
    let vertex = format!("{path}.WEIGHTS_0[2]");
    let wrong = |weights: [f32; 4], words: &str| {
        let mut skinned = Skinned::new();
        let all = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], weights, [1.0, 0.0, 0.0, 0.0]].concat();
        let accessor = skinned.0.floats("VEC4", &all);
        skinned.attribute("WEIGHTS_0", accessor);
        skinned.refused(&vertex, words);
    };
    wrong([1.5, -0.5, 0.0, 0.0], "-0.5");
    wrong([f32::NAN, 0.5, 0.0, 0.0], "NaN");
    let mut skinned = Skinned::new();
    let joints = skinned.0.integers("VEC4", 1, &[0, 1, 0, 0, 0, 1, 0, 0, 2, 1, 0, 0, 0, 1, 0, 0]);
    skinned.attribute("JOINTS_0", joints);
    skinned.refused(&vertex, "below 2, the skin's joints");
    let short = skinned.0.floats("VEC4", &[1.0; 12]);
    skinned.attribute("WEIGHTS_0", short);
    skinned.refused(&format!("{path}.WEIGHTS_0.count"), "must be 4");
    let mut without = Skinned::new();
    without.primitive()["attributes"].as_object_mut().expect("an object").remove("JOINTS_0");
    without.refused(&format!("{path}.JOINTS_0"), "must be given");
    let mut far = Skinned::new();
    let normals = far.0.floats("VEC3", &[f32::INFINITY; 12]);
    far.attribute("NORMAL", normals);
    far.refused(&format!("{path}.NORMAL[0][0]"), "finite");
}

#[test]
fn targets_are_sparse_and_animated() {
    let mut skinned = Skinned::new();
    let (index, value) = (skinned.0.view(&[2]), skinned.0.view(&3.0_f32.to_le_bytes().repeat(3)));
    let sparse = skinned.0.push("accessors", json!({
        "componentType": 5126, "type": "VEC3", "count": 4, "sparse": {
            "count": 1, "indices": {"bufferView": index, "componentType": 5121}, "values": {"bufferView": value}
        }
    }));
    let dense = skinned.0.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    skinned.primitive()["targets"] = json!([{"POSITION": sparse}, {"NORMAL": dense, "POSITION": sparse}]);
    skinned.0.json["meshes"][0]["weights"] = json!([0.5, 0.25]);
    let mesh = skinned.read().expect("valid");
    assert_eq!(mesh.weights, [0.5, 0.25]);
    let found = |target: &MorphTarget| {
        (target.vertices.clone(), target.deltas.iter().map(|d| d.position).collect::<Vec<_>>())
    };
    assert_eq!(found(&mesh.targets[0]), (vec![2], vec![[3.0; 3]]));
    assert_eq!(found(&mesh.targets[1]), (vec![1, 2], vec![[0.0; 3], [3.0; 3]]));
    assert_eq!(mesh.targets[1].deltas[0].normal, [0.0, 5.0, 0.0]);
    // The node's weights take precedence.
    skinned.0.json["nodes"][2]["weights"] = json!([1.0, 2.0]);
    let (times, values) =
        (skinned.0.floats("SCALAR", &[0.0, 2.0]), skinned.0.floats("SCALAR", &[0.0, 1.0, 4.0, -1.0]));
    skinned.0.animate(0, "translation", "LINEAR", times, dense);
    skinned.0.json["animations"] = json!([]);
    skinned.0.animate(2, "weights", "LINEAR", times, values);
    let mesh = skinned.read().expect("valid");
    assert_eq!((mesh.weights_at(0, 1.0), mesh.weights_at(1, 1.0)), (vec![2.0, 0.0], vec![1.0, 2.0]));
    let short = skinned.0.floats("SCALAR", &[0.0; 3]);
    skinned.0.json["animations"][0]["samplers"][0]["output"] = json!(short);
    skinned.refused("animations[0].samplers[0].output.len", "must be 4");
    skinned.0.json["nodes"][2]["weights"] = json!([1.0]);
    skinned.refused("nodes[2].weights.len", "must be 2");
}

/// A document with morph targets, their keys, indices, texture coordinates, tangents and a texture.
fn full() -> Scene {
    let mut skinned = Skinned::new();
    let delta = skinned.0.floats("VEC3", &[0.5; 12]);
    skinned.primitive()["targets"] = json!([{"POSITION": delta, "NORMAL": delta}]);
    let (tangents, uv) =
        (skinned.0.floats("VEC4", &[0.6, 0.8, 0.0, 1.0].repeat(4)), skinned.0.floats("VEC2", &[0.5; 8]));
    skinned.attribute("TANGENT", tangents);
    skinned.attribute("TEXCOORD_0", uv);
    let indices = skinned.0.integers("SCALAR", 2, &[0, 1, 2, 3]);
    skinned.primitive()["indices"] = json!(indices);
    crate::textures::add_texture(&mut skinned);
    skinned.0.json["meshes"][0]["weights"] = json!([0.5]);
    let (times, values) = (skinned.0.floats("SCALAR", &[0.0, 2.0]), skinned.0.floats("SCALAR", &[0.0, 1.0]));
    skinned.0.animate(2, "weights", "LINEAR", times, values);
    skinned.0
}

/// Everything that is imported can be skinned and stays finite.
fn skin_all(model: &Model) {
    use relievo::asset::bone_radii;
    use relievo::ops::animation::local_to_model::reference::local_to_model;
    use relievo::ops::skinning::clusters::Clusters;
    use relievo::ops::skinning::instance_lod::InstanceLod;
    use relievo::ops::skinning::morph::reference::morph;
    use relievo::ops::skinning::palette::reference::palette_for;
    use relievo::ops::skinning::skin::reference::skin;
    use relievo::ops::skinning::vertex::Blend;
    let models = local_to_model(&model.skeleton, &model.skeleton.rest());
    // Scales may move positions out of range; that is a property of the pose and not of the import.
    let is_sane = models.iter().flatten().flatten().all(|value| value.abs() < 1e6);
    assert_eq!(bone_radii(model.skeleton.len(), &model.skins, &model.meshes).len(), model.skeleton.len());
    for mesh in &model.meshes {
        assert!(model.material(mesh).is_ok());
        assert_eq!(mesh.validate(&model.skins), Ok(()));
        assert!(Clusters::new(mesh, &model.skins, &model.skeleton).is_ok());
        let weights = mesh.weights_at(0, 0.5);
        let large = |weights: &[f32]| weights.iter().any(|weight| weight.abs() > 1e6);
        let palette = palette_for(&model.skins[mesh.skin], &models, Blend::Linear);
        let vertices = skin(&morph(mesh, &weights), &mesh.influences, &palette, InstanceLod::FULL);
        let small = mesh.positions.as_flattened().iter().all(|x| x.abs() < 1e6)
            && mesh
                .targets
                .iter()
                .flat_map(|target| &target.deltas)
                .all(|delta| [delta.position, delta.normal].as_flattened().iter().all(|x| x.abs() < 1e6))
            && model.skins[mesh.skin].inverse_binds.as_flattened().iter().all(|x| x.abs() < 1e6);
        if is_sane && small && !large(&weights) {
            let finite = |vertex: &relievo::ops::skinning::vertex::Vertex| {
                vertex.position.iter().chain(&vertex.normal).all(|x| x.is_finite())
            };
            assert!(vertices.iter().all(finite));
        }
    }
}

#[test]
fn nothing_panics() {
    let mut read = 0;
    let mut try_it = |bytes: &[u8]| {
        if let Ok(model) = Model::from_gltf(bytes, None) {
            read += 1;
            skin_all(&model);
        }
    };
    let glb = full().glb();
    try_it(&glb);
    for case in 0..10_000 {
        let words = crate::sampling::noise(case ^ 0x3e54, 9);
        let mut changed = glb.clone();
        for pair in words[..2 * (1 + case as usize % 4)].chunks_exact(2) {
            let at = ((pair[0] + 1.0) / 2.0 * (glb.len() - 1) as f32) as usize;
            changed[at] = ((pair[1] + 1.0) * 128.0) as u8;
        }
        try_it(&changed);
    }
    let mut pointers = Vec::new();
    crate::malformed::collect(&full().json, String::new(), &mut pointers);
    for pointer in pointers {
        for value in
            [json!(null), json!(-1), json!(1), json!(3), json!(1e300), json!("x"), json!([]), json!({})]
        {
            let mut changed = full();
            *changed.json.pointer_mut(&pointer).expect("collected") = value;
            try_it(&changed.gltf());
        }
    }
    assert!(read > 500, "only {read} of the documents were still right");
}
