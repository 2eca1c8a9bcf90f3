//! `relievo scene`: frames, reports and dumps.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::harness::{Run, relievo};
use crate::scene_mistakes::with;
use crate::{assert_documented, assert_refused};

/// A folder with files that scenes name, and where a run writes to.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        let truth = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files");
        for name in ["rig.glb", "still.glb"] {
            std::fs::copy(truth.join(name), folder.path(name)).expect("copied");
        }
        folder.write("cut.glb", b"glTF\x02\0\0\0\xff\xff\0\0");
        folder.write("cycle.gltf", CYCLE.as_bytes());
        folder.write("points.gltf", br#"{"asset": {"version": "2.0"}, "nodes": [{}]}"#);
        folder.write("broken.png", b"no picture");
        image::RgbImage::new(4, 4).save(folder.path("rgb.png")).expect("written");
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        self.path(name).to_str().expect("UTF-8").to_owned()
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.path(name), bytes).expect("written");
    }

    /// Draws a scene.
    pub fn run(&self, scene: &str, arguments: &[&str]) -> Run {
        self.write("scene.json", scene.as_bytes());
        let (scene, out) = (self.text("scene.json"), self.text("out"));
        relievo(&[&["scene", &scene, "--out", &out][..], arguments].concat())
    }

    fn report(&self) -> Value {
        serde_json::from_slice(&std::fs::read(self.path("out/report.json")).expect("a report")).expect("JSON")
    }

    fn frame(&self, number: u32) -> image::DynamicImage {
        image::open(self.path(&format!("out/frame_{number:04}.png"))).expect("a frame")
    }
}

/// Nodes that are each other's children.
const CYCLE: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"children": [1]}, {"children": [0]}]}"#;

/// A scene in which a mistake can be made.
pub fn good() -> Value {
    json!({
        "terrain": {
            "config": {"patchSize": 17, "scaleFactor": 2, "seed": "cli"},
            "patches": [[0, 0], [1, 0]],
        },
        "meshes": [
            {"file": "still.glb", "instances": [{"on": [4, 5], "turn": 1, "scale": [1, 2, -1]}, {"at": [1, 2, 3]}]},
            {
                "file": "builtin:wall",
                "material": {"relief": "builtin:bricks", "scale": 0.05},
                "scatter": {"count": 2, "seed": "walls"},
            },
        ],
        "characters": [{
            "file": "rig.glb",
            "clip": 0,
            "instances": [{"on": [8, 8], "clip": 1}, {"on": [18, 8]}],
            "scatter": {"count": 2, "seed": "crowd", "area": [[2, 2], [20, 12]], "scale": [1, 2]},
        }],
        "light": {"direction": [1, 2, 1], "ambient": 0.3, "shadow": {"size": 512, "range": 60}},
        "camera": {"path": [
            {"time": 0, "at": [10, 8, 30], "look": [10, 0, 8]},
            {"time": 0.1, "at": [14, 9, 28], "look": [10, 0, 8], "fov": 1},
        ]},
        "quality": {"pixels": 1},
    })
}

#[test]
fn arguments_are_checked_before_anything_is_loaded() {
    let folder = Folder::new();
    for (arguments, words) in [
        (&["--frames", "0"][..], "frames"),
        (&["--size", "0x5"], "size = 0x5"),
        (&["--size", "9000x5"], "8192"),
        (&["--pixels", "-1"], "quality.pixels"),
        (&["--pixels", "1", "--full"], "--full"),
        (&["--compare", "--full"], "--full"),
        (&["--samples", "2"], "samples = 2"),
        (&["--layer", "depth", "--samples", "4"], "samples = 4"),
        (&["--layer", "depth", "--compare"], "layer = depth"),
        (&["--layer", "smell"], "smell"),
        (&["--depth", "sideways"], "sideways"),
        (&["--rate", "0"], "rate = 0"),
        (&["--split", "--size", "1x5"], "2x1"),
    ] {
        let run = folder.run("no scene at all", arguments);
        assert_refused(&run, arguments, &[words]);
    }
    let missing = relievo(&["scene", &folder.text("gone.json"), "--out", &folder.text("out")]);
    assert_refused(&missing, &["gone.json"], &["gone.json"]);
    assert!(!folder.path("out").exists());
}

#[test]
fn frames_are_drawn_and_counted() {
    let folder = Folder::new();
    let run = folder.run(&good().to_string(), &["--frames", "3", "--rate", "20", "--size", "96x64"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let report = folder.report();
    assert_documented(&report);
    let frames = report["frames"].as_array().expect("a list");
    assert_eq!(frames.len(), 3);
    assert_eq!((&frames[2]["frame"], &frames[2]["pixels"]), (&json!(2), &json!(1.0)));
    assert!((frames[2]["seconds"].as_f64().expect("a number") - 0.1).abs() < 1e-6);
    let names: Vec<_> = (report["objects"].as_array().expect("a list").iter())
        .map(|object| (object["kind"].as_str(), object["instances"].as_u64()))
        .collect();
    let expected = [("terrain", 2), ("mesh", 2), ("relief", 2), ("character", 4)];
    assert_eq!(names, expected.map(|(kind, count)| (Some(kind), Some(count))));
    let drawn = |frame: usize, object: usize, of: &str| -> u64 {
        let levels = frames[frame]["objects"][object]["levels"].as_array().expect("a list").iter();
        levels.map(|level| level[of].as_u64().expect("a count")).sum()
    };
    assert_eq!((drawn(0, 0, "instances"), drawn(0, 0, "triangles")), (2, 2 * 2 * 16 * 16));
    assert!(drawn(0, 3, "instances") > 1 && drawn(0, 3, "triangles") > 10);
    // Nothing stands still: neither camera nor characters.
    let [first, last] = [0, 2].map(|number| folder.frame(number).into_rgba8());
    assert!(first.dimensions() == (96, 64) && first != last);
    // What an earlier run wrote and this one does not is gone, and the first frame is the same in every run.
    let again = folder.run(&good().to_string(), &["--size", "96x64"]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);
    assert!(!folder.path("out/frame_0001.png").exists());
    assert!(folder.frame(0).into_rgba8() == first);
}

/// Two views of one submission draw what one view draws, and so does reversed depth.
#[test]
fn split_and_reversed_pictures_are_the_same() {
    let folder = Folder::new();
    let picture = |arguments: &[&str]| {
        let size = ["--size", "90x60", "--samples", "1", "--full"];
        let run = folder.run(&good().to_string(), &[&size[..], arguments].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        folder.frame(0).into_rgba8()
    };
    let whole = picture(&[]);
    for arguments in [&["--split"][..], &["--depth", "reversed"], &["--split", "--depth", "reversed"]] {
        let other = picture(arguments);
        let off = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
            a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 3)
        };
        // Pixels on edges may change hands.
        let wrong = whole.pixels().zip(other.pixels()).filter(|pair| off(*pair)).count();
        assert!(100 * wrong < 90 * 60, "{arguments:?}: {wrong} pixels");
    }
}

#[test]
fn depth_is_the_distance_ahead() {
    let folder = Folder::new();
    let scene = json!({
        "meshes": [{"file": "builtin:wall", "instances": [{"at": [0, -5, 0], "scale": [9, 9, 2]}]}],
        "camera": {"at": [0, 1, 5.5], "look": [0, 1, 0], "near": 0.25},
    });
    for depth in ["forward", "reversed"] {
        let arguments = ["--layer", "depth", "--depth", depth, "--size", "32x32"];
        let run = folder.run(&scene.to_string(), &arguments);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let report = folder.report();
        assert_documented(&report);
        // The wall's face is half a unit before its middle.
        for name in ["nearest", "farthest"] {
            let distance = report["frames"][0][name].as_f64().expect("a number");
            assert!((distance - 5.0).abs() < 1e-3, "{depth}: {name} {distance}");
        }
        assert!(folder.frame(0).into_luma16().pixels().all(|pixel| pixel.0[0] > 1000));
    }
}

#[test]
fn frames_are_compared_with_full_detail() {
    let folder = Folder::new();
    let far = json!([{"time": 0, "at": [10, 8, 90], "look": [10, 0, 8]}, {"time": 1, "at": [10, 9, 60], "look": [10, 0, 8]}]);
    let arguments = ["--frames", "3", "--rate", "3", "--size", "96x64", "--compare", "--pixels", "2"];
    let rocks: Value = serde_json::from_str(&with("/camera/path", far)).expect("JSON");
    let rocks = rocks.to_string().replace("still.glb", "builtin:rock");
    let run = folder.run(&rocks, &arguments);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("largest displacement"), "{}", run.stdout);
    let report = folder.report();
    assert_documented(&report);
    let summary = |name: &str| report["summary"][name].as_f64().unwrap_or_else(|| panic!("no {name}"));
    assert!(summary("largest") > 0.0 && summary("largest") <= 2.0, "{}", report["summary"]);
    assert!(summary("jump") > 0.0 && summary("jump") <= 4.0, "{}", report["summary"]);
    assert!(summary("mean_flip") > 0.0 && summary("largest_flip") < 0.1, "{}", report["summary"]);
    assert!(summary("triangle_fraction") < 0.9 && summary("missing") == 0.0, "{}", report["summary"]);
    assert!(report["frames"][1]["compared"]["full_milliseconds"]["draw"].as_f64() > Some(0.0));
}

/// A list of numbers.
fn floats(of: &Value, name: &str) -> Vec<f32> {
    let list = of[name].as_array().expect("a list").iter();
    list.map(|value| value.as_f64().expect("a number") as f32).collect()
}

/// The bones that are drawn at full detail are where the CPU reference puts them.
#[test]
fn dumps_hold_the_bones_that_were_drawn() {
    use relievo::animation::Pose;
    use relievo::asset::Model;
    use relievo::glam::{Mat4, Quat, Vec3, Vec4};
    let folder = Folder::new();
    let arguments = ["--frames", "2", "--rate", "7", "--size", "64x64", "--full", "--dump"];
    let run = folder.run(&good().to_string(), &arguments);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let read = |name: &str| std::fs::read(folder.path(&format!("out/{name}"))).expect("written");
    let dump: Value = serde_json::from_slice(&read("characters.json")).expect("JSON");
    let numbers: Vec<f32> = (read("characters.f32").chunks_exact(4))
        .map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four")))
        .collect();
    assert_documented(&dump);
    let model = Model::from_file(&folder.path("rig.glb")).expect("valid");
    let bones = model.skeleton.len();
    assert_eq!(numbers.len(), 2 * 4 * bones * 12);
    let mut matrices = numbers.chunks_exact(12);
    let mut seen = 0;
    for frame in dump["frames"].as_array().expect("a list") {
        for instance in frame["instances"].as_array().expect("a list") {
            let own: Vec<&[f32]> = matrices.by_ref().take(bones).collect();
            if instance["drawn"] != json!(true) {
                continue;
            }
            seen += 1;
            let (at, scale) =
                (Vec3::from_slice(&floats(instance, "at")), Vec3::from_slice(&floats(instance, "scale")));
            let world =
                Mat4::from_scale_rotation_translation(scale, Quat::from_slice(&floats(instance, "turn")), at);
            assert_eq!(instance["cell"], json!([0, 0, 0]));
            let clip = &model.clips[instance["clip"].as_u64().expect("an index") as usize];
            let seconds = instance["clip_seconds"].as_f64().expect("seconds") as f32;
            let pose = Pose::on_host(&model.skeleton, clip, seconds);
            for (bone, found) in own.iter().enumerate() {
                let [x, y, z] = pose.model_matrices[bone].map(Vec4::from);
                let expected = world * Mat4::from_cols(x, y, z, Vec4::W).transpose();
                let off =
                    (0..12).map(|at| (expected.row(at / 4)[at % 4] - found[at]).abs()).fold(0.0, f32::max);
                assert!(off < 2e-4, "bone {bone} is {off} off");
            }
        }
    }
    assert!(seen > 3, "{seen} instances were drawn");
    assert!(matrices.next().is_none());
}
