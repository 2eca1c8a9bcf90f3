//! Tangents that a document lacks: the values of MikkTSpace's own implementation, and the treatment of vertices
//! whose corners have several.

use relievo::InputError;
use relievo::asset::Mesh;
use relievo::asset::Model;
use serde_json::{Value, json};

use crate::scene::Scene;

/// A document with one mesh, without a skin.
struct Surface {
    scene: Scene,
    vertices: usize,
}

impl Surface {
    fn new(positions: &[[f32; 3]], normals: &[[f32; 3]], uv: &[[f32; 2]], indices: &[u32]) -> Self {
        let mut scene = Scene::new();
        let [low, high] = [f32::min, f32::max].map(|pick: fn(f32, f32) -> f32| {
            [0, 1, 2].map(|axis| positions.iter().map(|place| place[axis]).fold(positions[0][axis], pick))
        });
        let at = scene.floats("VEC3", positions.as_flattened());
        (scene.json["accessors"][at]["min"], scene.json["accessors"][at]["max"]) = (json!(low), json!(high));
        let indices = scene.integers("SCALAR", 4, indices);
        scene.json["meshes"] =
            json!([{"primitives": [{"attributes": {"POSITION": at}, "indices": indices}]}]);
        scene.push("nodes", json!({"mesh": 0}));
        let mut surface = Self { scene, vertices: positions.len() };
        surface.attribute("NORMAL", "VEC3", normals.as_flattened());
        surface.attribute("TEXCOORD_0", "VEC2", uv.as_flattened());
        surface
    }

    fn attribute(&mut self, name: &str, kind: &str, values: &[f32]) -> usize {
        let accessor = self.scene.floats(kind, values);
        self.primitive()["attributes"][name] = json!(accessor);
        accessor
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.scene.json["meshes"][0]["primitives"][0]
    }

    fn read(&self) -> Result<Mesh, InputError> {
        let model = Model::from_gltf(&self.scene.gltf(), None)?;
        let mesh = &model.meshes[0];
        assert_eq!(mesh.validate(&model.skins), Ok(()));
        for tangent in &mesh.tangents {
            let length = tangent[..3].iter().map(|x| x * x).sum::<f32>().sqrt();
            assert!((length - 1.0).abs() < 1e-4 && tangent[3].abs() == 1.0, "{tangent:?}");
        }
        Ok(mesh.clone())
    }
}

/// A square of two triangles in x and y, its texture upright: u along x, v against y.
fn square() -> Surface {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let uv = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    Surface::new(&positions, &[[0.0, 0.0, 1.0]; 4], &uv, &[0, 1, 2, 0, 2, 3])
}

/// Two squares side by side that share an edge; the right one's texture is the left one's in a mirror.
fn mirrored() -> Surface {
    let positions = [0.0, 1.0, 2.0].map(|x| [[x, 0.0, 0.0], [x, 1.0, 0.0]]);
    let uv = [0.0, 1.0, 0.0].map(|u| [[u, 1.0], [u, 0.0]]);
    let indices = [0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3];
    Surface::new(positions.as_flattened(), &[[0.0, 0.0, 1.0]; 6], uv.as_flattened(), &indices)
}

/// The numbers of tests/animation/mikktspace.json; the file beside it says how they were made.
fn numbers<const N: usize>(document: &Value, list: &str) -> Vec<[f32; N]> {
    let vectors = document[list].as_array().expect("a list").iter();
    let number = |value: &Value| value.as_f64().expect("a number") as f32;
    vectors.map(|vector| std::array::from_fn(|at| number(&vector[at]))).collect()
}

#[test]
fn tangents_are_those_of_the_reference_implementation() {
    let document: Value = serde_json::from_str(include_str!("mikktspace.json")).expect("JSON");
    let indices = document["indices"].as_array().expect("a list").iter();
    let indices: Vec<u32> = indices.map(|index| index.as_u64().expect("a number") as u32).collect();
    let (positions, normals) = (numbers(&document, "positions"), numbers(&document, "normals"));
    let uv = numbers(&document, "uv");
    let surface = Surface::new(&positions, &normals, &uv, &indices);
    let mesh = surface.read().expect("valid");
    let expected = numbers::<4>(&document, "tangents");
    assert_eq!(mesh.indices.len(), expected.len());
    for (corner, (vertex, expected)) in mesh.indices.iter().zip(&expected).enumerate() {
        let (at, file) = (*vertex as usize, indices[corner] as usize);
        let error = mesh.tangents[at].iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(error < 1e-6, "corner {corner}: {:?} for {expected:?}", mesh.tangents[at]);
        assert_eq!(
            (mesh.positions[at], mesh.normals[at], mesh.uv[at]),
            (positions[file], normals[file], uv[file])
        );
    }
    // The six mirrored vertices have two tangents; all others keep their index.
    assert_eq!(mesh.vertices(), surface.vertices + 6);
    assert_eq!(mesh.positions[..surface.vertices], positions);
}

#[test]
fn corners_with_tangents_of_their_own_become_vertices() {
    let mut surface = mirrored();
    let delta: Vec<f32> =
        (0..6).flat_map(|vertex| [0.0, 0.0, if vertex > 1 { vertex as f32 } else { 0.0 }]).collect();
    let delta = surface.scene.floats("VEC3", &delta);
    surface.primitive()["targets"] = json!([{"POSITION": delta}]);
    let mesh = surface.read().expect("valid");
    assert_eq!(mesh.vertices(), 8);
    assert_eq!(mesh.indices, [0, 2, 3, 0, 3, 1, 6, 4, 5, 6, 5, 7]);
    // glTF's handedness has the opposite sign of MikkTSpace's: +1 where the texture is upright.
    for (vertex, tangent) in mesh.tangents.iter().enumerate() {
        let wanted = if vertex < 4 { [1.0, 0.0, 0.0, -1.0] } else { [-1.0, 0.0, 0.0, 1.0] };
        assert_eq!(*tangent, wanted, "{vertex}");
    }
    assert_eq!(mesh.positions[6..], mesh.positions[2..4]);
    assert_eq!(mesh.uv[6..], mesh.uv[2..4]);
    assert_eq!(mesh.influences.vertices(), 8);
    let target = &mesh.targets[0];
    assert_eq!(target.vertices, [2, 3, 4, 5, 6, 7]);
    assert_eq!(target.deltas[4..], target.deltas[..2]);
    // Tangents of the file are kept.
    surface.attribute("TANGENT", "VEC4", &[0.0, 1.0, 0.0, 1.0].repeat(6));
    let given = surface.read().expect("valid");
    assert_eq!(given.tangents, vec![[0.0, 1.0, 0.0, -1.0]; 6]);
    // Without normals, the file's tangents are meaningless.
    surface.primitive()["attributes"].as_object_mut().expect("an object").remove("NORMAL");
    assert_eq!(surface.read().expect("valid").tangents, mesh.tangents);
}

/// Influences go with the vertex that is copied.
#[test]
fn copies_follow_the_same_bones() {
    let mut surface = mirrored();
    surface.scene.json["nodes"] =
        json!([{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [0, 1, 0]}]);
    surface.scene.push("skins", json!({"joints": [1, 2]}));
    let joints = surface.scene.integers("VEC4", 1, &[0, 1, 0, 0].repeat(6));
    surface.primitive()["attributes"]["JOINTS_0"] = json!(joints);
    let weights: Vec<f32> = (0..6).flat_map(|vertex| [vertex as f32 + 1.0, 2.5, 0.0, 0.0]).collect();
    surface.attribute("WEIGHTS_0", "VEC4", &weights);
    let mesh = surface.read().expect("valid");
    assert_eq!(mesh.influences.vertices(), 8);
    for (copy, vertex) in [(6, 2), (7, 3)] {
        assert_eq!(mesh.influences.of(copy), mesh.influences.of(vertex));
    }
    assert_ne!(mesh.influences.of(6), mesh.influences.of(7));
}

/// Tangents follow the texture coordinates of the normal texture, before any transform, or else those of the
/// base colour.
#[test]
fn tangents_go_along_the_normal_texture() {
    let mut surface = square();
    let tangent = |surface: &Surface| surface.read().expect("valid").tangents[0];
    assert_eq!(tangent(&surface), [1.0, 0.0, 0.0, -1.0]);
    // These coordinates are turned by a quarter, once as another set and once as a transform of the base
    // colour's set.
    surface.attribute("TEXCOORD_1", "VEC2", &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0]);
    surface.primitive()["material"] = json!(0);
    surface.scene.json["images"] = json!([{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg=="}]);
    surface.scene.json["textures"] = json!([{"source": 0}, {"source": 0}]);
    surface.scene.json["materials"] = json!([{"normalTexture": {"index": 1, "texCoord": 1}}]);
    assert_eq!(tangent(&surface), [0.0, 1.0, 0.0, -1.0]);
    let turned = json!({"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 1.5707964}}});
    surface.scene.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": turned});
    assert_eq!(tangent(&surface), [0.0, 1.0, 0.0, -1.0]);
    surface.scene.json["materials"][0]["normalTexture"]["texCoord"] = json!(0);
    assert_eq!(tangent(&surface), [1.0, 0.0, 0.0, -1.0]);
    surface.scene.json["materials"][0].as_object_mut().expect("an object").remove("normalTexture");
    assert_eq!(tangent(&surface), [1.0, 0.0, 0.0, -1.0]);
    // The normal texture, which is left out beside a base colour at other coordinates, names a set that does not exist.
    let of_color = json!({"baseColorTexture": {"index": 0}});
    surface.scene.json["materials"] =
        json!([{"pbrMetallicRoughness": of_color, "normalTexture": {"index": 1, "texCoord": 5}}]);
    assert_eq!(tangent(&surface), [1.0, 0.0, 0.0, -1.0]);
}

/// Tangents follow circles of latitude on a globe, except at the poles.
#[test]
fn a_globe_has_tangents_along_its_latitudes() {
    let (rows, columns) = (16_u32, 32_u32);
    let place = |row: u32, column: u32| {
        let [polar, turn] = [row as f32 / rows as f32, 2.0 * column as f32 / columns as f32]
            .map(|fraction| fraction * std::f32::consts::PI);
        [polar.sin() * turn.cos(), -polar.cos(), -polar.sin() * turn.sin()]
    };
    let all = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column)));
    let positions: Vec<[f32; 3]> = all.clone().map(|(row, column)| place(row, column)).collect();
    let uv: Vec<[f32; 2]> =
        all.map(|(row, column)| [column as f32 / columns as f32, 1.0 - row as f32 / rows as f32]).collect();
    let mut indices = Vec::new();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let at = row * (columns + 1) + column;
        let next = at + columns + 1;
        indices.extend([at, at + 1, next + 1, at, next + 1, next]);
    }
    let mesh = Surface::new(&positions, &positions, &uv, &indices).read().expect("valid");
    for (tangent, [x, _, z]) in mesh.tangents.iter().zip(&mesh.positions) {
        let radius = x.hypot(*z);
        if radius > 0.1 {
            let along = [z / radius, -x / radius];
            let cosine = tangent[0] * along[0] + tangent[2] * along[1];
            // The tangent points east; at the end of the seam it may be off by half a column.
            assert!(cosine > 0.99 && tangent[3] == -1.0, "{tangent:?} at {x} {z}");
        }
    }
}

#[test]
fn nothing_has_to_have_an_area() {
    let mut surface = square();
    let points = [[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    // Triangles without area in space, triangles without area in the texture, and a vertex without triangles.
    for uv in [[[0.5; 2]; 4], [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]] {
        let indices = [0, 1, 2, 1, 2, 3, 2, 2, 2];
        assert_eq!(
            Surface::new(&points, &[[0.0, 0.0, 1.0]; 4], &uv, &indices).read().expect("valid").vertices(),
            4
        );
    }
    for size in [1e-30_f32, 1e18] {
        let place = |[x, y]: [f32; 2]| [x * size, y * size, 0.0];
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for stretch in [1e-30_f32, 1.0, 1e18] {
            let uv = corners.map(|[x, y]| [stretch * x, -stretch * y]);
            let one = Surface::new(&corners.map(place), &[[0.0, 0.0, 1.0]; 4], &uv, &[0, 1, 2, 0, 2, 3]);
            assert_eq!(one.read().expect("valid").vertices(), 4);
        }
    }
    surface.primitive()["mode"] = json!(0);
    assert!(surface.read().expect("valid").indices.is_empty());
}

/// More triangles around a vertex than MikkTSpace could visit in time, or on the stack.
#[test]
fn crowded_vertices_are_solved() {
    wheel(1_000);
    wheel(100_000);
}

/// Solves a fan of `one_ring` − 1 triangles around a central vertex.
fn wheel(one_ring: u32) {
    let rim = (0..one_ring).map(|ring| std::f32::consts::TAU * ring as f32 / one_ring as f32);
    let positions: Vec<[f32; 3]> =
        std::iter::once([0.0; 3]).chain(rim.map(|turn| [turn.cos(), turn.sin(), 0.0])).collect();
    let uv: Vec<[f32; 2]> = positions.iter().map(|[x, y, _]| [*x, -y]).collect();
    let indices: Vec<u32> = (1..one_ring).flat_map(|ring| [0, ring, ring + 1]).collect();
    let mesh = Surface::new(&positions, &vec![[0.0, 0.0, 1.0]; positions.len()], &uv, &indices)
        .read()
        .expect("valid");
    assert!(mesh.tangents.iter().all(|tangent| tangent[0] > 0.99 && tangent[3] == -1.0));
}

/// An import without materials keeps the file's vertices.
#[test]
fn bare_models_have_no_copies() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("model.gltf");
    std::fs::write(&path, mirrored().scene.gltf()).expect("writable");
    assert_eq!(Model::from_file_bare(&path).expect("valid").meshes[0].vertices(), 6);
    assert_eq!(Model::from_file(&path).expect("valid").meshes[0].vertices(), 8);
}
