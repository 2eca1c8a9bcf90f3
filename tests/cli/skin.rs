//! `relievo skin` on models of its own and on the built-in one.

use std::path::Path;

use serde_json::json;

use crate::harness::relievo;
use crate::scene::Scene;

/// A folder with `model.gltf`: a triangle whose last corner follows the upper of two joints and a morph target, and a
/// clip that lifts that joint and the target's weight.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let mut scene = Scene::of_two_bones();
        let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.1, 0.0]);
        scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
        scene.json["accessors"][positions]["max"] = json!([1, 0.1, 0]);
        let target = scene.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]);
        let weights = scene.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
        let joints = scene.integers("VEC4", 1, &[0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]);
        scene.json["meshes"] = json!([{"primitives": [{
            "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights},
            "targets": [{"POSITION": target}],
        }]}]);
        scene.push("nodes", json!({"name": "my body", "skin": 0, "mesh": 0}));
        let times = scene.floats("SCALAR", &[0.0, 2.0]);
        let values = scene.floats("VEC3", &[0.0, 1.0, 0.0, 0.0, 5.0, 0.0]);
        let shares = scene.floats("SCALAR", &[0.0, 1.0]);
        scene.push(
            "animations",
            json!({
                "samplers": [{"input": times, "output": values}, {"input": times, "output": shares}],
                "channels": [
                    {"sampler": 0, "target": {"node": 1, "path": "translation"}},
                    {"sampler": 1, "target": {"node": 2, "path": "weights"}},
                ],
            }),
        );
        let bench = Self(tempfile::tempdir().expect("a temporary folder"));
        std::fs::write(bench.path("model.gltf"), scene.gltf()).expect("writable");
        let none = scene.floats("VEC4", &[0.0; 12]);
        scene.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(none);
        std::fs::write(bench.path("loose.gltf"), scene.gltf()).expect("writable");
        scene.json["nodes"][2].as_object_mut().expect("an object").remove("mesh");
        std::fs::write(bench.path("bare.gltf"), scene.gltf()).expect("writable");
        bench
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().expect("UTF-8").to_owned()
    }

    /// The lines of mesh.obj.
    fn skin(&self, model: &str, more: &[&str]) -> Vec<String> {
        let out = self.path("out");
        let run = relievo(&[&["skin", "--model", model, "--out", &out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.stdout.is_empty() && run.stderr.is_empty());
        let picture = image::open(Path::new(&out).join("skin.png")).expect("a picture").to_rgb8();
        // Something is seen, in the middle of something else.
        let corner = picture.get_pixel(0, 0);
        let covered = picture.pixels().filter(|pixel| *pixel != corner).count() as f64;
        let share = covered / f64::from(picture.width() * picture.height());
        assert!((0.02..0.9).contains(&share), "{share}");
        let text = std::fs::read_to_string(Path::new(&out).join("mesh.obj")).expect("written");
        text.lines().map(str::to_owned).collect()
    }

    fn refused(&self, model: &str, more: &[&str], words: &str) {
        let out = self.path("never");
        let run = relievo(&[&["skin", "--model", model, "--out", &out, "--time", "0"], more].concat());
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(run.stderr.contains(words) && run.stderr.lines().count() == 1, "{}", run.stderr);
        assert!(!Path::new(&out).exists());
    }
}

#[test]
fn a_mesh_is_written_where_its_bones_and_targets_are() {
    let bench = Bench::new();
    for backend in ["gpu", "cpu"] {
        let lines =
            bench.skin(&bench.path("model.gltf"), &["--clip", "0", "--time", "2.5", "--backend", backend]);
        // A quarter of the way: the joint is at y = 2, the target's weight ¼.
        assert_eq!(lines[..4], ["o my_body_0", "v 0 0 0", "v 1 0 0", "v 0 2.1 1"]);
        assert_eq!(lines.last().map(String::as_str), Some("f 1/1/1 2/2/2 3/3/3"));
        assert_eq!(lines.len(), 1 + 3 * 3 + 1);
        let end = ["--clip", "0", "--time", "9", "--wrap", "clamp", "--backend", backend];
        assert_eq!(bench.skin(&bench.path("model.gltf"), &end)[3], "v 0 5.1 4");
    }
}

#[test]
fn both_backends_agree_and_every_option_matters() {
    let bench = Bench::new();
    let vertices = |more: &[&str]| -> Vec<f32> {
        let all = bench.skin("builtin", &[&["--clip", "walk", "--time", "0.3"], more].concat());
        let of_places = all.iter().filter_map(|line| line.strip_prefix("v "));
        of_places.flat_map(|line| line.split(' ').map(|x| x.parse::<f32>().expect("a number"))).collect()
    };
    let largest = |a: &[f32], b: &[f32]| {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    let full = vertices(&[]);
    for options in [
        &["--dual-quaternion"][..],
        &["--influences", "truncate:2"],
        &["--influences", "fade:0.5"],
        &["--influences", "fade:1", "--dual-quaternion"],
    ] {
        let [gpu, cpu] = ["gpu", "cpu"].map(|name| vertices(&[options, &["--backend", name]].concat()));
        assert!(largest(&gpu, &cpu) < 1e-5, "{options:?}");
        assert!(largest(&gpu, &full) > 1e-4, "{options:?}");
    }
    assert_eq!(vertices(&["--influences", "fade:0"]), full);
    assert_eq!(vertices(&["--influences", "truncate:8"]), full);
    assert_eq!(vertices(&["--influences", "fade:1"]), vertices(&["--influences", "truncate:1"]));
}

#[test]
fn what_cannot_be_skinned_is_refused() {
    let bench = Bench::new();
    let path = |name| bench.path(name);
    for (influences, words) in [
        ("half", "must be full, truncate:K or fade:LAMBDA"),
        ("truncate:0", "must be in 1..=8"),
        ("truncate:9", "must be in 1..=8"),
        ("fade:1.5", "must be in 0..=1"),
        ("fade:NaN", "must be in 0..=1"),
        ("fade:", "must be full"),
    ] {
        bench.refused(&path("model.gltf"), &["--clip", "0", "--influences", influences], words);
    }
    bench.refused(
        &path("loose.gltf"),
        &["--clip", "0"],
        "meshes[0].primitives[0].attributes.WEIGHTS_0[0] = 0",
    );
    bench.refused(&path("bare.gltf"), &["--clip", "0"], "meshes = none");
    bench.refused(&path("model.gltf"), &["--clip", "5"], "clip = 5");
    bench.refused("builtin", &["--clip", "run"], "walk");
}
