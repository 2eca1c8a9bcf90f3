//! `relievo scene`: frames, reports and dumps.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::harness::{Run, relievo};
use crate::scene_mistakes::with;
use crate::{assert_documented, assert_refused};

/// A folder with files that scenes name, and where a run writes to.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        let truth = relievo_testing::root().join("tests/truth/files");
        for name in ["rig.glb", "still.glb"] {
            std::fs::copy(truth.join(name), folder.path(name)).expect("copied");
        }
        folder.write("cut.glb", b"glTF\x02\0\0\0\xff\xff\0\0");
        folder.write("cow.obj", b"v 0 0 0\nf 1 2 3\n");
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

    pub fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.path(name), bytes).expect("written");
    }

    /// Draws a scene.
    pub fn run(&self, scene: &str, arguments: &[&str]) -> Run {
        self.write("scene.json", scene.as_bytes());
        let (scene, out) = (self.text("scene.json"), self.text("out"));
        relievo(&[&["scene", &scene, "--out", &out][..], arguments].concat())
    }

    pub fn report(&self) -> Value {
        serde_json::from_slice(&std::fs::read(self.path("out/report.json")).expect("a report")).expect("JSON")
    }

    pub fn frame(&self, number: u32) -> image::DynamicImage {
        relievo_testing::picture(self.path(&format!("out/frame_{number:04}.png")))
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
        (&["--layer", "velocity", "--compare"], "layer = velocity"),
        (&["--layer", "surface", "--samples", "4"], "samples = 4"),
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

/// Endless terrain tells how many nodes a frame made and draws: all of the first frame, none of the second, which stands still.
#[test]
fn nodes_of_endless_terrain_are_counted() {
    let folder = Folder::new();
    let scene = json!({
        "terrain": { "config": { "patchSize": 17, "coarseLevels": 5, "scaleFactor": 9, "seed": "nodes" }, "endless": true, "view": 200 },
        "camera": { "at": [0, 60, 0], "look": [50, 0, 50] }
    });
    let run = folder.run(&scene.to_string(), &["--frames", "2", "--size", "96x64"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let report = folder.report();
    assert_documented(&report);
    let nodes = |frame: usize, of: &str| {
        report["frames"][frame]["objects"][0]["nodes"][of].as_u64().expect("a number")
    };
    assert!(nodes(0, "drawn") > 4 && nodes(0, "made") >= nodes(0, "drawn"), "{report}");
    assert_eq!((nodes(1, "drawn"), nodes(1, "made")), (nodes(0, "drawn"), 0));
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
fn velocity_is_the_motion_on_the_screen() {
    let folder = Folder::new();
    let path = |time: u32, x: u32| json!({"time": time, "at": [x, 1, 5.5], "look": [x, 1, 0]});
    let scene = json!({
        "meshes": [{"file": "builtin:wall", "instances": [{"at": [0, -5, 0], "scale": [20, 20, 2]}]}],
        "camera": {"path": [path(0, 0), path(1, 1)], "fov": 0.8},
    });
    for split in [&[][..], &["--split"]] {
        let arguments = ["--layer", "velocity", "--frames", "2", "--rate", "2", "--size", "40x32"];
        let run = folder.run(&scene.to_string(), &[&arguments[..], split].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let report = folder.report();
        assert_documented(&report);
        // In half a second the camera has gone half of its way, half a unit, five units before the wall.
        let expected = 16.0 / f64::tan(0.4) * 0.5 / 5.0;
        let fastest = |frame: usize| report["frames"][frame]["fastest"].as_f64().expect("a number");
        assert_eq!(fastest(0), 0.0, "{split:?}");
        assert!((fastest(1) - expected).abs() < 1e-3, "{split:?}: {} pixels, not {expected}", fastest(1));
        // Everything moves to the left.
        let picture = folder.frame(1).into_rgb16();
        let is_left = |pixel: &image::Rgb<u16>| pixel.0[0] < 10 && pixel.0[1].abs_diff(32_768) < 10;
        assert!(picture.pixels().all(is_left), "{split:?}");
    }
}

#[test]
fn surfaces_have_normals_colors_and_numbers() {
    let folder = Folder::new();
    let wall = |x: i32| json!({"at": [x, -5, 0], "scale": [8, 20, 2]});
    let scene = json!({
        "meshes": [{"file": "builtin:wall", "instances": [wall(-16), wall(16)]}],
        "camera": {"at": [0, 1, 5.5], "look": [0, 1, 0]},
    });
    let run = folder.run(&scene.to_string(), &["--layer", "surface", "--size", "40x32"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let read = |name: &str| relievo_testing::picture(folder.path(&format!("out/frame_0000{name}.png")));
    let normals = read("").into_rgb8();
    let off = |pixel: &image::Rgb<u8>| pixel.0.iter().zip([128, 128, 255]).any(|(a, b)| a.abs_diff(b) > 1);
    let wrong = normals.pixels().find(|pixel| off(pixel));
    assert_eq!(wrong, None, "walls face the eye");
    let numbers = read("_id").into_rgb16();
    assert_eq!([numbers.get_pixel(2, 9).0, numbers.get_pixel(37, 9).0], [[1, 0, 0], [1, 1, 0]]);
    let albedo = read("_albedo").into_rgb8();
    assert!(albedo.pixels().any(|pixel| pixel.0.iter().all(|channel| *channel > 20)));
    // Another layer's run leaves none of these pictures behind.
    let run = folder.run(&scene.to_string(), &["--size", "40x32"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        !folder.path("out/frame_0000_id.png").exists() && !folder.path("out/frame_0000_albedo.png").exists()
    );
}

/// The same model in both formats, as this crate writes them.
#[test]
fn obj_is_drawn_as_glb_is() {
    let folder = Folder::new();
    let rock = relievo_samples::rock().expect("valid");
    folder.write("rock.glb", &rock.to_glb().expect("valid"));
    for (name, bytes) in rock.to_obj("rock").expect("valid") {
        folder.write(&name, &bytes);
    }
    let pictures = ["rock.glb", "rock.obj"].map(|file| {
        let scene = json!({
            "meshes": [{"file": file, "instances": [{"at": [0, 0, 0]}]}],
            "camera": {"at": [1, 2, 4], "look": [0, 0, 0]},
        });
        let run = folder.run(&scene.to_string(), &["--size", "96x96", "--full"]);
        assert_eq!(run.code, Some(0), "{file}: {}", run.stderr);
        folder.frame(0).to_rgb8()
    });
    let pairs = || pictures[0].as_raw().iter().zip(pictures[1].as_raw());
    assert!(pairs().all(|(a, b)| a.abs_diff(*b) <= 3), "the pictures differ");
    let corner = pictures[0].get_pixel(0, 0);
    assert!(pictures[0].pixels().filter(|pixel| *pixel != corner).count() > 500, "the rock is not drawn");
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
    use relievo::asset::Model;
    use relievo::glam::{Mat4, Quat, Vec3, Vec4};
    use relievo::ops::animation::Pose;
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

/// A character whose gate bounds no error has no bound in the report, and beyond the range only a bone of priority 1 is sampled.
#[test]
fn characters_have_the_gates_of_their_file() {
    use relievo::asset::Model;
    let folder = Folder::new();
    let bones = |priorities: Value| {
        let mut scene = good();
        scene["characters"][0]["gate"] = json!({"mode": "skip-period", "range": [1, 2]});
        scene["characters"][0]["influences"] = json!({"most": 1});
        scene["characters"][0]["priorities"] = priorities;
        let run = folder.run(&scene.to_string(), &["--frames", "3", "--rate", "20", "--size", "96x64"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let report = folder.report();
        let object = &report["frames"][2]["objects"][3];
        assert_eq!(
            (&object["pixels"], &report["frames"][2]["objects"][1]["pixels"]),
            (&Value::Null, &json!(1.0))
        );
        object["bones"].as_u64().expect("a count")
    };
    let names = Model::from_file(&folder.path("rig.glb")).expect("valid").skeleton;
    let all: Value =
        (0..names.len()).map(|bone| (bone.to_string(), json!(1))).collect::<serde_json::Map<_, _>>().into();
    assert_eq!(bones(json!({})), 0);
    assert!(bones(all) > 0);
}
