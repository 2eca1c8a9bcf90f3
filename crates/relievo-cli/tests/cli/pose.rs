//! `relievo pose` on models of its own and on the built-in one.

use std::path::Path;

use serde_json::{Value, json};

use crate::harness::relievo;
use crate::scene::Scene;

/// A folder with `model.gltf`: two joints below a node that is no joint, and a clip that lifts the upper
/// joint.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let mut scene = Scene::of_two_bones();
        scene.push("nodes", json!({"name": "scene", "scale": [2.0, 2.0, 2.0], "children": [0]}));
        let times = scene.floats("SCALAR", &[0.0, 2.0]);
        let values = scene.floats("VEC3", &[0.0, 1.0, 0.0, 0.0, 5.0, 0.0]);
        let clip = scene.animate(1, "translation", "LINEAR", times, values);
        scene.json["animations"][clip]["name"] = json!("lift");
        let bench = Self(tempfile::tempdir().expect("a temporary folder"));
        std::fs::write(bench.path("model.gltf"), scene.gltf()).expect("writable");
        scene.json["nodes"][1]["rotation"] = json!([0, 0, 0, 0]);
        std::fs::write(bench.path("bad.gltf"), scene.gltf()).expect("writable");
        bench
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().expect("UTF-8").to_owned()
    }

    fn pose(&self, model: &str, more: &[&str]) -> Value {
        let out = self.path("pose.json");
        let run = relievo(&[&["pose", "--model", model, "--out", &out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.stdout.is_empty() && run.stderr.is_empty());
        serde_json::from_slice(&std::fs::read(out).expect("written")).expect("JSON")
    }
}

#[test]
fn a_pose_is_written_as_documented() {
    let bench = Bench::new();
    let pose = bench.pose(&bench.path("model.gltf"), &["--clip", "lift", "--time", "0.5"]);
    let identity = json!([2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let lifted = json!([2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 4.0, 0.0, 1.0]);
    let local = |y: f64| json!({"translation": [0.0, y, 0.0], "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0, 1.0, 1.0]});
    let expected = json!({"clip": "lift", "time": 0.5, "bones": [
        {"name": "root", "parent": -1, "local": local(0.0), "model": identity},
        {"name": "tip", "parent": 0, "local": local(2.0), "model": lifted},
    ]});
    assert_eq!(pose, expected);
}

#[test]
fn times_outside_the_clip_wrap() {
    let bench = Bench::new();
    for (more, time, height) in [
        (&["--time", "2.5"][..], 0.5, 4.0),
        (&["--time", "-0.5"], 1.5, 8.0),
        (&["--time", "2", "--wrap", "loop"], 0.0, 2.0),
        (&["--time", "2.5", "--wrap", "clamp"], 2.0, 10.0),
        (&["--time=-1", "--wrap", "clamp"], 0.0, 2.0),
    ] {
        let pose = bench.pose(&bench.path("model.gltf"), &[&["--clip", "0"], more].concat());
        assert_eq!(
            (&pose["time"], &pose["bones"][1]["model"][13]),
            (&json!(time), &json!(height)),
            "{more:?}"
        );
    }
}

#[test]
fn the_built_in_creature_has_clips() {
    let bench = Bench::new();
    for clip in ["walk", "idle", "wave", "2"] {
        let pose = bench.pose("builtin", &["--clip", clip, "--time", "0.7"]);
        let bones = pose["bones"].as_array().expect("a list");
        assert_eq!((bones.len(), &bones[0]["name"], &bones[0]["parent"]), (153, &json!("root"), &json!(-1)));
        let parents = bones.iter().map(|bone| bone["parent"].as_i64().expect("a number"));
        assert!(parents.enumerate().all(|(index, parent)| parent < index as i64));
    }
}

/// The file's pose and the creature's, on both backends.
#[test]
fn both_backends_agree() {
    let bench = Bench::new();
    for (model, clip) in
        [(&*bench.path("model.gltf"), "lift"), ("builtin", "walk"), ("builtin", "idle"), ("builtin", "wave")]
    {
        for time in ["0", "0.37", "1.9", "-3.3"] {
            let pose = |backend| bench.pose(model, &["--clip", clip, "--time", time, "--backend", backend]);
            let (mut gpu, mut cpu) = (Vec::new(), Vec::new());
            numbers(&pose("gpu"), &mut gpu);
            numbers(&pose("cpu"), &mut cpu);
            assert_eq!(gpu.len(), cpu.len());
            let error = gpu.iter().zip(&cpu).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-5, "{model} {clip} {time}: {error:e}");
        }
    }
}

fn numbers(value: &Value, found: &mut Vec<f64>) {
    match value {
        Value::Number(number) => found.extend(number.as_f64()),
        Value::Array(values) => values.iter().for_each(|value| numbers(value, found)),
        Value::Object(values) => values.values().for_each(|value| numbers(value, found)),
        _ => {}
    }
}

#[test]
fn bad_input_is_refused_in_one_line() {
    let bench = Bench::new();
    let [model, bad] = ["model.gltf", "bad.gltf"].map(|name| bench.path(name));
    let missing = bench.path("missing.glb");
    let out = bench.path("refused.json");
    for (model, clip, time, words) in [
        (&*missing, "0", "0", &["missing.glb"][..]),
        (&*bad, "0", "0", &["bad.gltf", "nodes[1].rotation", "unit"]),
        (&*model, "jump", "0", &["model.gltf", "clip", "jump", "\"lift\""]),
        (&*model, "1", "0", &["clip", "below 1"]),
        (&*model, "0", "NaN", &["time", "NaN", "finite"]),
        (&*model, "0", "soon", &["'soon'", "--time"]),
        ("builtin", "run", "0", &["builtin", "\"walk\"", "\"idle\"", "\"wave\""]),
    ] {
        let run = relievo(&["pose", "--model", model, "--clip", clip, "--time", time, "--out", &out]);
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{words:?} not in: {}", run.stderr);
        assert!(!Path::new(&out).exists() && run.stdout.is_empty());
    }
}
