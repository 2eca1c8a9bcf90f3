//! Levels of detail of nodes (`MSFT_lod`).

use relievo::InputError;
use relievo::asset::Model;
use relievo::ops::skinning::join_levels;
use serde_json::{Value, json};

use crate::scene::Scene;

/// Nodes whose meshes are triangles of the sizes 1, 2, 3 …, in a scene of the first `roots` nodes.
fn nodes(count: usize, roots: usize) -> Scene {
    let mut scene = Scene::new();
    scene.json["meshes"] = json!([]);
    for node in 0..count {
        let size = node as f32 + 1.0;
        let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, size, 0.0, 0.0, 0.0, size, 0.0]);
        scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
        scene.json["accessors"][positions]["max"] = json!([size, size, 0]);
        scene.push("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}}]}));
        scene.push("nodes", json!({"name": format!("n{node}"), "mesh": node}));
    }
    scene.json["scenes"] = json!([{"nodes": (0..roots).collect::<Vec<_>>()}]);
    scene
}

fn set(scene: &mut Scene, node: usize, ids: Value) {
    scene.json["nodes"][node]["extensions"] = json!({"MSFT_lod": {"ids": ids}});
}

fn read(scene: &Scene) -> Result<Vec<Model>, InputError> {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    Model::levels_from_bytes_beside("a.gltf".as_ref(), &scene.gltf(), &none)
}

/// The names of the meshes at each level.
fn names(scene: &Scene) -> Vec<Vec<String>> {
    let of = |model: &Model| model.meshes.iter().map(|mesh| mesh.name.clone()).collect();
    read(scene).expect("valid").iter().map(of).collect()
}

#[test]
fn each_level_has_the_nodes_that_it_lists() {
    let mut scene = nodes(6, 2);
    assert_eq!(names(&scene), [["n0_0", "n1_0"]]);
    // The first node has two levels more, the second has one. The last node is its child.
    set(&mut scene, 0, json!([2, 3]));
    set(&mut scene, 1, json!([4]));
    scene.json["nodes"][1]["children"] = json!([5]);
    scene.json["extensionsUsed"] = json!(["MSFT_lod"]);
    scene.json["extensionsRequired"] = json!(["MSFT_lod"]);
    scene.json["nodes"][0]["extras"] = json!({"MSFT_screencoverage": [0.5, 0.2, 0.01]});
    let wanted = [vec!["n0_0", "n1_0", "n5_0"], vec!["n2_0", "n4_0"], vec!["n3_0", "n4_0"]];
    assert_eq!(names(&scene), wanted);
    assert_eq!(Model::from_gltf(&scene.gltf(), None).expect("valid"), read(&scene).expect("valid")[0]);
    // Without a scene, listed nodes are not at level 0.
    scene.json.as_object_mut().expect("an object").remove("scenes");
    assert_eq!(names(&scene), wanted);
    let joined = join_levels(&read(&scene).expect("valid")).expect("joined");
    // Five meshes, of which the last is in two levels, and the child.
    assert_eq!(joined.meshes.len(), 6);
    let triangles =
        |level: u32| joined.meshes.iter().map(|mesh| mesh.triangles(level).len() / 3).collect::<Vec<_>>();
    let counts = [0, 1, 2].map(|level| triangles(level).into_iter().sum::<usize>());
    assert_eq!(counts, [3, 2, 2]);
}

#[test]
fn levels_stand_where_the_finest_stands() {
    let mut scene = nodes(4, 0);
    scene.json["nodes"][0] = json!({"name": "n0", "children": [1], "translation": [0, 5, 0]});
    scene.json["scenes"] = json!([{"nodes": [0]}]);
    set(&mut scene, 1, json!([2]));
    scene.json["nodes"][2]["translation"] = json!([7, 0, 0]);
    // Levels below levels do not count.
    scene.json["nodes"][1]["children"] = json!([3]);
    let levels = read(&scene).expect("valid");
    let first = |model: &Model| relievo::ops::skinning::at_rest(model).expect("valid").meshes[0].positions[0];
    assert_eq!(levels.iter().map(first).collect::<Vec<_>>(), [[0.0, 5.0, 0.0], [7.0, 5.0, 0.0]]);
    assert_eq!(levels.iter().map(|model| model.meshes.len()).collect::<Vec<_>>(), [2, 1]);
}

#[test]
fn what_is_no_level_is_refused_with_its_place() {
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = nodes(12, 2);
        change(&mut scene);
        // What is read without levels is not checked.
        Model::from_gltf(&scene.gltf(), None).expect("valid");
        let InputError { path, value, bound } = read(&scene).expect_err("refused");
        (path.replace("extensions.MSFT_lod.", ""), value, bound)
    };
    let wanted = |path: &str, value: &str, bound: &str| (path.to_owned(), value.to_owned(), bound.to_owned());
    let ids = |node: usize, ids: Value| refused(&|scene| set(scene, node, ids.clone()));
    assert_eq!(ids(0, json!([])), wanted("nodes[0].ids.len", "0", "must be in 1..=7"));
    assert_eq!(ids(0, json!([2, 3, 4, 5, 6, 7, 8, 9])), wanted("nodes[0].ids.len", "8", "must be in 1..=7"));
    assert_eq!(ids(0, json!([2, 12])), wanted("nodes[0].ids[1]", "12", "must be below 12"));
    assert_eq!(ids(0, json!([0])), wanted("nodes[0].ids[0]", "0", "must be another node"));
    let bound = "must not be in the scene, where it takes the place of nodes[0]";
    assert_eq!(ids(0, json!([1])), wanted("nodes[0].ids[0]", "1", bound));
    let bound = "must be listed once, and nodes[0] lists it";
    assert_eq!(ids(0, json!([2, 2])), wanted("nodes[0].ids[1]", "2", bound));
    assert_eq!(ids(0, json!(["far"])).0, "nodes[0].ids[0]");
    assert_eq!(ids(0, json!([-1])).0, "nodes[0].ids[0]");
    let cycle = refused(&|scene| {
        set(scene, 0, json!([2]));
        set(scene, 2, json!([0]));
    });
    assert_eq!(cycle, wanted("nodes[0].ids[0]", "2", "must be a node without levels"));
    let shared = refused(&|scene| {
        set(scene, 0, json!([2]));
        set(scene, 1, json!([3, 2]));
    });
    assert_eq!(shared, wanted("nodes[1].ids[1]", "2", "must be listed once, and nodes[0] lists it"));
    let child = refused(&|scene| {
        set(scene, 0, json!([2]));
        scene.json["nodes"][1]["children"] = json!([2]);
    });
    assert_eq!(child, wanted("nodes[0].ids[0]", "2", "must be no child, and nodes[1] is its parent"));
    let missing = refused(&|scene| scene.json["nodes"][0]["extensions"] = json!({"MSFT_lod": {}}));
    assert!(missing.0.starts_with("nodes[0]"), "{missing:?}");
}

/// A skinned level follows the joints below the node whose place it takes.
#[test]
fn skinned_levels_keep_their_joints() {
    let mut skinned = crate::meshes::Skinned::new();
    let json = &mut skinned.0.json;
    let node = json["nodes"].as_array().expect("a list").iter().position(|node| node.get("mesh").is_some());
    let node = node.expect("a node with a mesh");
    let mut far = json["nodes"][node].clone();
    far["name"] = json!("far");
    let at = skinned.0.push("nodes", far);
    let roots: Vec<usize> = (0..at)
        .filter(|node| {
            let nodes = skinned.0.json["nodes"].as_array().expect("a list");
            !nodes
                .iter()
                .any(|other| other["children"].as_array().is_some_and(|all| all.contains(&json!(node))))
        })
        .collect();
    skinned.0.json["scenes"] = json!([{"nodes": roots}]);
    set(&mut skinned.0, node, json!([at]));
    let levels = read(&skinned.0).expect("valid");
    assert_eq!(levels.len(), 2);
    assert_eq!(levels[0].skeleton, levels[1].skeleton);
    assert_eq!(levels[1].skinned, levels[0].skinned);
    assert!(levels[1].meshes[0].name.starts_with("far"));
}
