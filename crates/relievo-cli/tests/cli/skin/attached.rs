//! `relievo skin` on meshes that hang on nodes and have no skin.

use serde_json::json;

use super::Bench;
use crate::scene::Scene;

/// Matrices for column vectors in double precision, independent of other code.
type Matrix = [[f64; 4]; 4];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..4).map(|at| a[row][at] * b[at][column]).sum()))
}

/// A matrix that scales, then rotates about an axis (0, 1, 2: x, y, z), then translates.
fn placed(moved: [f64; 3], axis: usize, angle: f64, scale: [f64; 3]) -> Matrix {
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turn = [[0.0; 3]; 3];
    turn[axis][axis] = 1.0;
    (turn[next][next], turn[last][last]) = (angle.cos(), angle.cos());
    (turn[next][last], turn[last][next]) = (-angle.sin(), angle.sin());
    std::array::from_fn(|row| {
        std::array::from_fn(|column| match (row, column) {
            (3, _) => f64::from(column == 3),
            (_, 3) => moved[row],
            _ => turn[row][column] * scale[column],
        })
    })
}

fn turned(axis: usize, angle: f64) -> [f64; 4] {
    let mut quaternion = [0.0, 0.0, 0.0, (angle / 2.0).cos()];
    quaternion[axis] = (angle / 2.0).sin();
    quaternion
}

/// A sword in a hand, a charm that swings on its own belt, a mirrored hat on the wagon that carries everything,
/// and a stone by the road; none has a skin.
#[test]
fn meshes_without_a_skin_follow_what_they_hang_on() {
    let bench = Bench::new();
    let mut scene = Scene::of_two_bones();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let positions = scene.floats("VEC3", corners.map(|corner| corner.map(|x| x as f32)).as_flattened());
    scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
    scene.json["accessors"][positions]["max"] = json!([1, 2, 3]);
    let indices = scene.integers("SCALAR", 2, &[0, 1, 3, 1, 2, 3]);
    scene.json["meshes"] =
        json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    let wagon_scale = [2.0, 1.0, 0.5];
    let grip = placed([0.25, -0.5, 0.0], 0, 0.8, [1.0, 3.0, 1.0]);
    // A node with a matrix that shears: nothing has to decompose it.
    let blade: Matrix =
        [[1.0, 0.5, 0.0, 0.1], [0.0, 1.0, 0.25, 0.2], [0.0, 0.0, 0.75, 0.3], [0.0, 0.0, 0.0, 1.0]];
    let by_columns: Vec<f64> = (0..16).map(|at| blade[at % 4][at / 4]).collect();
    let wagon = scene.push("nodes", json!({"children": [0, 7], "scale": wagon_scale}));
    scene.push(
        "nodes",
        json!({"children": [4, 5], "translation": [0.25, -0.5, 0.0],
        "rotation": turned(0, 0.8), "scale": [1, 3, 1]}),
    );
    scene.push("nodes", json!({"name": "blade", "mesh": 0, "matrix": by_columns}));
    let charm = scene.push("nodes", json!({"name": "charm", "mesh": 0, "translation": [1, 0, 0]}));
    scene.push("nodes", json!({"children": [8], "translation": [-5, 0, 0], "rotation": turned(2, 0.3)}));
    scene.push("nodes", json!({"name": "hat", "mesh": 0, "scale": [1, -1, 1], "translation": [0, 4, 0]}));
    scene.push("nodes", json!({"name": "stone", "mesh": 0, "scale": [2, 2, 2]}));
    scene.json["nodes"][1]["children"] = json!([3]);
    // The node moves from rest to twice the way and back; it is half way at ¼ and ¾ of two seconds.
    let times = scene.floats("SCALAR", &[0.0, 2.0]);
    let mut animate = |node: usize, path: &str, values: &[f64]| {
        let kind = if path == "rotation" { "VEC4" } else { "VEC3" };
        let values: Vec<f32> = values.iter().map(|x| *x as f32).collect();
        let values = scene.floats(kind, &values);
        (json!({"input": times, "output": values}), json!({"node": node, "path": path}))
    };
    let channels = [
        animate(wagon, "translation", &[0.0, 0.0, 0.0, 8.0, 0.0, -4.0]),
        animate(wagon, "rotation", &[turned(1, 0.0), turned(1, 2.0)].concat()),
        animate(1, "rotation", &[turned(2, 0.0), turned(2, -1.6)].concat()),
        animate(charm, "rotation", &[turned(0, 0.2), turned(0, 1.4)].concat()),
    ];
    let samplers: Vec<_> = channels.iter().map(|(sampler, _)| sampler).collect();
    let targets = channels.iter().enumerate();
    let targets: Vec<_> = targets.map(|(at, (_, target))| json!({"sampler": at, "target": target})).collect();
    let animation = json!({"samplers": samplers, "channels": targets});
    scene.push("animations", animation);
    std::fs::write(bench.path("armed.glb"), scene.glb()).expect("writable");

    // The time is half way through the clip.
    let one = [1.0; 3];
    let wagon = placed([4.0, 0.0, -2.0], 1, 1.0, wagon_scale);
    let tip = product(&wagon, &placed([0.0, 1.0, 0.0], 2, -0.8, one));
    let hand = product(&tip, &grip);
    let stone = product(&placed([-5.0, 0.0, 0.0], 2, 0.3, one), &placed([0.0; 3], 0, 0.0, [2.0; 3]));
    let expected = [
        ("blade_0", product(&hand, &blade), [1, 2, 4]),
        ("charm_0", product(&hand, &placed([1.0, 0.0, 0.0], 0, 0.8, one)), [1, 2, 4]),
        ("hat_0", product(&wagon, &placed([0.0, 4.0, 0.0], 0, 0.0, [1.0, -1.0, 1.0])), [1, 4, 2]),
        ("stone_0", stone, [1, 2, 4]),
    ];
    for backend in ["gpu", "cpu"] {
        let lines =
            bench.skin(&bench.path("armed.glb"), &["--clip", "0", "--time", "1", "--backend", backend]);
        let objects: Vec<_> = lines.split(|line| line.starts_with("o ")).skip(1).collect();
        let names: Vec<_> = lines.iter().filter_map(|line| line.strip_prefix("o ")).collect();
        assert_eq!(names, expected.map(|(name, ..)| name));
        for (at, (object, (name, matrix, face))) in objects.iter().zip(expected).enumerate() {
            let places = object.iter().filter_map(|line| line.strip_prefix("v "));
            let places: Vec<Vec<f64>> =
                places.map(|line| line.split(' ').map(|x| x.parse().expect("a number")).collect()).collect();
            assert_eq!(places.len(), 4);
            for (place, [x, y, z]) in places.iter().zip(corners) {
                for (found, [a, b, c, d]) in place.iter().zip(matrix) {
                    let wanted = a * x + b * y + c * z + d;
                    assert!((found - wanted).abs() < 1e-5, "{name}: {found} for {wanted}");
                }
            }
            // The winding of a mirrored mesh is reversed, so that its outside remains its outside.
            let first = object.iter().find_map(|line| line.strip_prefix("f ")).expect("a face");
            let first: Vec<usize> = first
                .split(' ')
                .map(|corner| corner.split('/').next().expect("some").parse().expect("a number"))
                .collect();
            assert_eq!(first, face.map(|corner| 4 * at + corner), "{name}");
        }
    }
}
