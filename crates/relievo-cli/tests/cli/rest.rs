//! Models at rest, and models without a skin: `relievo pose`, `relievo skin` and `relievo crowd`.

use std::path::Path;

use serde_json::{Value, json};

use crate::harness::relievo;
use crate::scene::Scene;

/// A folder with `still.gltf`, two boards of which one is twice as large, and `moving.gltf`, where a clip lifts that one.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let mut scene = Scene::new();
        let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
        scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
        scene.json["accessors"][positions]["max"] = json!([1, 1, 0]);
        let indices = scene.integers("SCALAR", 2, &[0, 1, 2, 0, 2, 3]);
        scene.json["meshes"] =
            json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
        scene.push("nodes", json!({"name": "floor", "mesh": 0, "children": [1], "translation": [0, 0, 1]}));
        scene.push("nodes", json!({"name": "lid", "mesh": 0, "translation": [1, 1, 0], "scale": [2, 2, 2]}));
        let bench = Self(tempfile::tempdir().expect("a temporary folder"));
        std::fs::write(bench.path("still.gltf"), scene.gltf()).expect("writable");
        let times = scene.floats("SCALAR", &[0.0, 2.0]);
        let values = scene.floats("VEC3", &[2.0, 1.0, 0.0, 2.0, 5.0, 0.0]);
        scene.animate(1, "translation", "LINEAR", times, values);
        std::fs::write(bench.path("moving.gltf"), scene.gltf()).expect("writable");
        bench
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().expect("UTF-8").to_owned()
    }

    fn pose(&self, model: &str, more: &[&str]) -> Value {
        let out = self.path("pose.json");
        let run = relievo(&[&["pose", "--model", &self.path(model), "--out", &out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        serde_json::from_slice(&std::fs::read(out).expect("written")).expect("JSON")
    }

    /// The positions of the vertices, as the file has them.
    fn skin(&self, model: &str, more: &[&str]) -> Vec<String> {
        let out = self.path("out");
        let run = relievo(&[&["skin", "--model", &self.path(model), "--out", &out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let picture = relievo_testing::picture(Path::new(&out).join("skin.png")).to_rgb8();
        let corner = picture.get_pixel(0, 0);
        assert!(picture.pixels().filter(|pixel| *pixel != corner).count() > 10_000);
        let text = std::fs::read_to_string(Path::new(&out).join("attached.obj")).expect("written");
        assert!(!Path::new(&out).join("mesh.obj").exists());
        text.lines().filter_map(|line| line.strip_prefix("v ")).map(str::to_owned).collect()
    }
}

fn places(pose: &Value) -> Vec<(&str, [&Value; 3])> {
    let bones = pose["bones"].as_array().expect("a list").iter();
    bones
        .map(|bone| (bone["name"].as_str().expect("a name"), [12, 13, 14].map(|at| &bone["model"][at])))
        .collect()
}

#[test]
fn a_model_is_at_rest_without_a_clip() {
    let bench = Bench::new();
    let zero = ["0 0 1", "1 0 1", "1 1 1", "0 1 1"];
    for backend in ["gpu", "cpu"] {
        let more = ["--backend", backend];
        let still = bench.pose("still.gltf", &more);
        assert_eq!((&still["clip"], &still["time"]), (&Value::Null, &Value::Null));
        assert_eq!(places(&still), [("floor", [&json!(0.0), &json!(0.0), &json!(1.0)])]);
        let moving = bench.pose("moving.gltf", &more);
        assert_eq!((&moving["clip"], places(&moving)[1].1[0]), (&Value::Null, &json!(1.0)));
        assert_eq!(moving["bones"][1]["parent"], json!(0));
        for model in ["still.gltf", "moving.gltf"] {
            let vertices = bench.skin(model, &more);
            assert_eq!(vertices[..4], zero, "{model}");
            assert_eq!(vertices[4..], ["1 1 1", "3 1 1", "3 3 1", "1 3 1"], "{model}");
        }
        assert_eq!(bench.skin("still.gltf", &["--within", "0.1", "--backend", backend])[..4], zero);
        // A clip starts at 0.
        assert_eq!(bench.skin("moving.gltf", &["--clip", "0", "--backend", backend])[4], "2 1 1");
        let later = ["--clip", "0", "--time", "1", "--backend", backend];
        assert_eq!(bench.skin("moving.gltf", &later)[4], "2 3 1");
        let later = bench.pose("moving.gltf", &later);
        assert_eq!((&later["clip"], &later["time"]), (&json!("animation_0"), &json!(1.0)));
    }
    assert!(bench.pose("still.gltf", &[])["bones"].as_array().is_some_and(|bones| bones.len() == 1));
}

#[test]
fn a_time_is_a_moment_of_a_clip() {
    let bench = Bench::new();
    let out = bench.path("refused");
    for command in ["pose", "skin"] {
        for (more, words) in [
            (&["--time", "0.5"][..], "--clip"),
            (&["--clip", "0"], "the model has no clips"),
            (&["--clip", "0", "--time", "0.5"], "the model has no clips"),
        ] {
            let model = bench.path("still.gltf");
            let run = relievo(&[&[command, "--model", &model, "--out", &out], more].concat());
            assert_eq!((run.code, run.stderr.lines().count()), (Some(2), 1), "{}", run.stderr);
            assert!(run.stderr.contains(words) && !Path::new(&out).exists(), "{}", run.stderr);
        }
    }
}

/// A crowd of rigid parts is gated, skinned and drawn as any other.
#[test]
fn rigid_parts_form_crowds() {
    let bench = Bench::new();
    let out = bench.path("crowd");
    let model = bench.path("moving.gltf");
    let run = relievo(&[
        "crowd",
        "--model",
        &model,
        "--clip",
        "0",
        "--instances",
        "4",
        "--frames",
        "8",
        "--gate",
        "bounded",
        "--distance",
        "400",
        "--image",
        "--mesh",
        "bounded:0.5",
        "--out",
        &out,
    ]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let report = std::fs::read(Path::new(&out).join("report.json")).expect("written");
    let report: Value = serde_json::from_slice(&report).expect("JSON");
    let row = &report["distances"][0];
    assert_eq!((&report["bones"], &report["animated_bones"]), (&json!(2), &json!(1)));
    assert!(row["error"]["max_pixels"].as_f64().is_some_and(|pixels| pixels <= 1.0), "{row}");
    assert!(row["displacement"]["largest"].as_f64().is_some_and(|pixels| pixels <= 1.5), "{row}");
    assert!(row["skinned_fraction"].as_f64().is_some_and(|fraction| fraction > 0.0), "{row}");
}
