//! `relievo scene`: frames, reports and dumps; and every mistake in a scene file is refused with its path.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::harness::{Run, relievo};
use crate::{assert_documented, assert_refused};

/// A folder with files that scenes name, and where a run writes to.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
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

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        self.path(name).to_str().expect("UTF-8").to_owned()
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.path(name), bytes).expect("written");
    }

    /// Draws a scene.
    fn run(&self, scene: &str, arguments: &[&str]) -> Run {
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
fn good() -> Value {
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
            "file": "builtin:creature",
            "clip": "walk",
            "instances": [{"on": [8, 8], "clip": 1}, {"on": [18, 8]}],
            "scatter": {"count": 2, "seed": "crowd", "area": [[2, 2], [20, 12]], "scale": [1, 2]},
        }],
        "light": {"direction": [1, 2, 1], "ambient": 0.3, "shadow": false},
        "camera": {"path": [
            {"time": 0, "at": [10, 8, 30], "look": [10, 0, 8]},
            {"time": 0.1, "at": [14, 9, 28], "look": [10, 0, 8], "fov": 1},
        ]},
        "quality": {"pixels": 1},
    })
}

/// The good scene with a value in another place; `null` removes what is there.
fn with(pointer: &str, value: Value) -> String {
    let mut scene = good();
    let (parent, name) = pointer.rsplit_once('/').expect("a pointer");
    match scene.pointer_mut(parent).unwrap_or_else(|| panic!("no {parent}")) {
        Value::Object(fields) if value.is_null() => {
            fields.remove(name);
        }
        Value::Object(fields) => {
            fields.insert(name.to_owned(), value);
        }
        Value::Array(list) => list[name.parse::<usize>().expect("an index")] = value,
        _ => panic!("{parent} holds nothing"),
    }
    scene.to_string()
}

/// Mistakes: where, what is there, and the path and the words of the message.
fn mistakes() -> Vec<(&'static str, Value, &'static str, &'static str)> {
    let long = vec![0; 4097];
    vec![
        // Fields.
        ("/typo", json!(1), "typo = 1", "terrain, meshes, characters"),
        ("/meshes/0/instance", json!([]), "meshes[0].instance = []", "is no field here"),
        ("/meshes/0/clip", json!("walk"), "meshes[0].clip = walk", "is no field here"),
        ("/meshes/0/instances/0/clip", json!(0), "meshes[0].instances[0].clip = 0", "is no field here"),
        ("/characters/0/scatter/seeds", json!(""), "characters[0].scatter.seeds", "count, seed, area"),
        ("/camera/path/1/fovy", json!(1), "camera.path[1].fovy = 1", "time, at, look, fov"),
        // What is missing.
        ("/camera", json!(null), "camera = missing", "where the scene is seen from"),
        ("/meshes/0/file", json!(null), "meshes[0].file = missing", ".glb or .gltf"),
        ("/meshes/0/instances", json!(null), "meshes[0].instances = missing", "or scatter"),
        ("/meshes/0/instances/1/at", json!(null), "meshes[0].instances[1].at = missing", "or on"),
        ("/characters/0/scatter/seed", json!(null), "characters[0].scatter.seed = missing", "any text"),
        ("/terrain/config", json!(null), "terrain.config = missing", "relievo terrain"),
        ("/camera/path/0/look", json!(null), "camera.path[0].look = missing", "where it looks"),
        ("/meshes/1/material/relief", json!(null), "meshes[1].material.relief = missing", "heights"),
        // Types.
        ("/terrain", json!([]), "terrain = []", "must be an object"),
        ("/terrain/config", json!("file.json"), "terrain.config = file.json", "must be an object"),
        ("/meshes", json!({}), "meshes = {}", "must be a list"),
        ("/meshes/0", json!("still.glb"), "meshes[0] = still.glb", "must be an object"),
        ("/meshes/0/file", json!(7), "meshes[0].file = 7", "must be a text"),
        ("/characters/0/scatter/count", json!("2"), "characters[0].scatter.count = 2", "whole number"),
        ("/characters/0/scatter/count", json!(2.5), "characters[0].scatter.count = 2.5", "whole number"),
        ("/light/shadow", json!(1), "light.shadow = 1", "true or false"),
        ("/light/shadow", json!(true), "light.shadow = true", "no shadows yet"),
        ("/camera/path/0/at", json!([1, 2]), "camera.path[0].at = [1,2]", "3 numbers"),
        ("/camera/path/0/at", json!([1, "2", 3]), "camera.path[0].at[1] = 2", "must be a number"),
        ("/terrain/patches/1", json!([0, 0.5]), "terrain.patches[1][1] = 0.5", "whole number"),
        // Ranges.
        ("/terrain/config/patchSize", json!(18), "terrain.config.patchSize = 18", "2^n + 1"),
        ("/terrain/config/zones", json!([]), "terrain.config.zones", "1 to 32"),
        ("/terrain/patches", json!([]), "terrain.patches.len = 0", "1..=4096"),
        ("/terrain/patches", json!(long), "terrain.patches.len = 4097", "1..=4096"),
        ("/terrain/patches/1", json!([0, 0]), "terrain.patches[1] = [0, 0]", "listed before"),
        ("/terrain/patches/1", json!([600_000, 0]), "terrain.patches[1] = 600000", "i32"),
        ("/meshes/0/instances/0/scale", json!(0), "meshes[0].instances[0].scale = 0", "1e-6"),
        ("/meshes/0/instances/0/scale", json!([1, 2, 1e9]), "meshes[0].instances[0].scale[2]", "1000000"),
        ("/meshes/0/instances/0/turn", json!([0, 0, 0, 0]), "meshes[0].instances[0].turn", "not be 0"),
        ("/meshes/0/instances/1/at", json!([1, 2e9, 3]), "meshes[0].instances[1].at[1]", "1000000000"),
        ("/meshes/1/material/scale", json!(1.5), "meshes[1].material.scale = 1.5", "0..=1"),
        ("/meshes/1/material/method", json!("best"), "meshes[1].material.method = best", "quadtree"),
        ("/meshes/1/material/shadow", json!("long"), "meshes[1].material.shadow = long", "soft"),
        ("/characters/0/rate", json!(1e6), "characters[0].rate = 1000000", "100"),
        ("/characters/0/wrap", json!("bounce"), "characters[0].wrap = bounce", "clamp"),
        ("/characters/0/scatter/scale", json!([2, 1]), "characters[0].scatter.scale", "smaller scale first"),
        ("/characters/0/scatter/area", json!([[5, 5], [1, 9]]), "characters[0].scatter.area", "smaller x"),
        ("/light/direction", json!([0, 0, 0]), "light.direction = [0,0,0]", "towards the light"),
        ("/light/ambient", json!(1.5), "light.ambient = 1.5", "0..=1"),
        ("/quality/pixels", json!(-1), "quality.pixels = -1", "0..="),
        ("/background", json!([0, 0, 2]), "background[2] = 2", "0..=1"),
        ("/camera/fov", json!(3.2), "camera.fov = 3.2", "3.1"),
        ("/camera/near", json!(0), "camera.near = 0", "0.0001"),
        ("/camera/far", json!(0.05), "camera.far = 0.05", "beyond near"),
        ("/camera/at", json!([0, 0, 0]), "camera.at", "beside path"),
        ("/camera/path", json!([]), "camera.path.len = 0", "1..=4096"),
        ("/camera/path/1/time", json!(0), "camera.path[1].time = 0", "later than 0"),
        ("/camera/path/0/look", json!([10, 8, 30]), "camera.path[0].look", "apart from at"),
        // Absurd counts.
        ("/meshes/1/scatter/count", json!(0), "meshes[1].scatter.count = 0", "1..=1048576"),
        ("/meshes/1/scatter/count", json!(1e12), "meshes[1].scatter.count", "1..=1048576"),
        ("/characters/0/scatter/count", json!(70_000), "characters[0].scatter.count = 70000", "65536"),
        ("/characters", json!(vec![1; 257]), "characters.len = 257", "0..=256"),
        ("/terrain/config/patchSize", json!(4097), "terrain.patches.len", ""),
        // What cannot be together.
        ("/meshes/0/instances/1/on", json!([1, 1]), "meshes[0].instances[1].on = [1,1]", "beside at"),
        ("/meshes/0/instances/1/lift", json!(1), "meshes[0].instances[1].lift = 1", "beside at"),
        ("/terrain", json!(null), "meshes[0].instances[0].on = [4, 5]", "no terrain"),
        // Files.
        ("/meshes/0/file", json!("gone.glb"), "meshes[0].file = gone.glb", "cannot be read"),
        ("/meshes/0/file", json!("cut.glb"), "meshes[0].file = cut.glb", "GLB"),
        ("/meshes/0/file", json!("cycle.gltf"), "meshes[0].file = cycle.gltf", "nodes"),
        ("/meshes/0/file", json!("scene.json"), "meshes[0].file = scene.json", ".glb or .gltf"),
        ("/meshes/0/file", json!("cow.obj"), "meshes[0].file = cow.obj", "not read yet"),
        ("/meshes/0/file", json!("builtin:cow"), "meshes[0].file = builtin:cow", "builtin:rock"),
        ("/meshes/0/file", json!("points.gltf"), "meshes[0].file = points.gltf", "triangles"),
        ("/characters/0/file", json!("builtin:rock"), "characters[0].file = builtin:rock", "creature"),
        ("/characters/0/file", json!("still.glb"), "characters[0].file = still.glb", "must have clips"),
        ("/characters/0/clip", json!("fly"), "characters[0].clip = fly", "walk"),
        ("/characters/0/instances/0/clip", json!(3), "characters[0].instances[0].clip = 3", "below 3"),
        (
            "/meshes/1/material/relief",
            json!("gone.png"),
            "meshes[1].material.relief = gone.png",
            "cannot be read",
        ),
        ("/meshes/1/material/relief", json!("broken.png"), "meshes[1].material.relief = broken.png", "PNG"),
        (
            "/meshes/1/material/albedo",
            json!("wall.bmp"),
            "meshes[1].material.albedo = wall.bmp",
            ".png or .jpg",
        ),
        (
            "/terrain/config/zones",
            json!([{"min": 0, "max": 1, "texture": "gone.png"}]),
            "terrain.config.zones[0].texture = gone.png",
            "cannot be read",
        ),
        // What only the device's heights tell.
        ("/meshes/0/instances/0/on", json!([4, 50]), "meshes[0].instances[0].on = [4, 50]", "on a patch"),
        (
            "/characters/0/scatter/area",
            json!([[50, 50], [60, 60]]),
            "characters[0].scatter.area",
            "on the terrain",
        ),
    ]
}

#[test]
fn every_mistake_is_refused_with_its_path_and_nothing_is_written() {
    let folder = Folder::new();
    let all = mistakes();
    assert!(all.len() > 60);
    for (pointer, value, start, words) in all {
        // Only the largest patches of all are too many.
        let scene = if start == "terrain.patches.len" {
            with(
                "/terrain",
                json!({
                    "config": {"patchSize": 4097, "scaleFactor": 2, "seed": "cli"},
                    "patches": [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0]],
                }),
            )
        } else {
            with(pointer, value)
        };
        refused(&folder, &scene, &[start, words]);
    }
    let twice = good().to_string().replace(r#""ambient":0.3"#, r#""ambient":0.3,"ambient":0.4"#);
    refused(&folder, &twice, &["light.ambient = line 1", "given twice"]);
    let deep = format!("{}{}", "[".repeat(400), "]".repeat(400));
    for (text, words) in
        [("", "scene = "), ("[]", "must be an object"), ("{} {}", "scene = "), (&deep, "scene")]
    {
        refused(&folder, text, &[words]);
    }
    refused(&folder, r#"{"camera": {"at": [0, 1, 5], "look": [0, 0, 0]}}"#, &["scene = empty", "must have"]);
    let ground = r#"{"meshes": [{"file": "still.glb", "scatter": {"count": 1, "seed": "s"}}],
        "camera": {"at": [0, 1, 5], "look": [0, 0, 0]}}"#;
    refused(&folder, ground, &["meshes[0].scatter.area = missing", "no terrain"]);
}

fn refused(folder: &Folder, scene: &str, words: &[&str]) {
    let run = folder.run(scene, &["--size", "16x16"]);
    let start = &scene[..scene.len().min(60)];
    assert_refused(&run, &[start], &[&["scene.json: "][..], words].concat());
    assert!(!folder.path("out").exists(), "{words:?}: something was written");
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
    assert!(drawn(0, 3, "instances") > 1 && drawn(0, 3, "triangles") > 1000);
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
        "meshes": [{"file": "builtin:wall", "instances": [{"at": [0, -1, 0], "scale": [9, 9, 2]}]}],
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
    let run = folder.run(&with("/camera/path", far), &arguments);
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

/// The bones that are drawn at full detail are where the CPU reference puts them.
#[test]
fn dumps_hold_the_bones_that_were_drawn() {
    use relievo::animation::Pose;
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
    let model = relievo::samples::creature().expect("built in");
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
            let floats = |name: &str| -> Vec<f32> {
                instance[name]
                    .as_array()
                    .expect("a list")
                    .iter()
                    .map(|value| value.as_f64().expect("a number") as f32)
                    .collect()
            };
            let (at, scale) = (Vec3::from_slice(&floats("at")), Vec3::from_slice(&floats("scale")));
            let world = Mat4::from_scale_rotation_translation(scale, Quat::from_slice(&floats("turn")), at);
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
