//! `relievo crowd --image` and `--scene`

use std::path::PathBuf;

use serde_json::Value;

use serde_json::json;

use crate::harness::{Run, relievo};
use crate::scene::Scene;
use crate::{assert_refused, push_raised_and_morphed};

const SMALL: [&str; 6] = ["--model", "builtin", "--clip", "walk", "--instances", "4"];

/// Runs `crowd` into the folder `out` of a folder of its own, with 5 frames unless the arguments give their number.
fn run(arguments: &[&str]) -> (Run, PathBuf, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out");
    let frames: &[&str] = if arguments.contains(&"--frames") { &[] } else { &["--frames", "5"] };
    let out_at = ["crowd", "--out", out.to_str().expect("UTF-8")];
    let run = relievo(&[&out_at[..], &SMALL, frames, arguments].concat());
    (run, out, folder)
}

/// The report of a run at some distances.
fn report(name: &str, distances: &str, arguments: &[&str]) -> (Value, PathBuf, tempfile::TempDir) {
    let (run, out, folder) = run(&[&["--distance", distances], arguments].concat());
    assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
    let text = std::fs::read(out.join(name)).expect("written");
    let report: Value = serde_json::from_slice(&text).expect("JSON");
    crate::assert_documented(&report);
    (report, out, folder)
}

/// The rows of a report at 300 and 2000 units.
fn rows(name: &str, arguments: &[&str]) -> ([Value; 2], PathBuf, tempfile::TempDir) {
    let (report, out, folder) = report(name, "300,2000", arguments);
    let [near, far] = &report["distances"].as_array().expect("a list")[..] else { panic!("two distances") };
    ([near.clone(), far.clone()], out, folder)
}

/// The row of a report at one distance.
fn row(name: &str, distance: &str, arguments: &[&str]) -> Value {
    let (report, ..) = report(name, distance, arguments);
    report["distances"][0].clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Number of pixels that differ from the first one.
fn covered(picture: &image::RgbaImage) -> usize {
    picture.pixels().filter(|pixel| *pixel != picture.get_pixel(0, 0)).count()
}

/// What a way to draw a crowd shows: its largest displacement, and the change of it from one frame to the next.
fn off(way: &Value) -> [f64; 2] {
    ["largest", "jump"].map(|field| number(&way["displacement"][field]))
}

/// The instances that a way draws, level by level.
fn instances(way: &Value) -> Vec<f64> {
    let levels = way["levels"].as_array().expect("a list");
    levels.iter().map(|level| number(&level["instances"])).collect()
}

/// The gate's pixel and half a pixel each for influences and triangles are two in all, at any distance.
#[test]
fn crowds_are_drawn_and_timed() {
    let all = ["--gate", "bounded", "--image", "--skinning", "bounded:0.5", "--mesh", "bounded:0.5"];
    let ([near, far], out, _folder) = rows("report.json", &all);
    for row in [&near, &far] {
        for field in ["frame_nanoseconds", "compute_nanoseconds", "draw_nanoseconds"] {
            assert!(number(&row[field]) > 0.0 && number(&row[format!("full_{field}")]) > 0.0, "{field}");
        }
        let [largest, jump] = off(row);
        assert!(largest > 0.05 && largest <= 2.0 && jump > 0.0 && jump <= 4.0, "{row}");
        let displacement = &row["displacement"];
        assert!(number(&displacement["samples"]) > 10_000.0, "{displacement}");
        assert_eq!((number(&displacement["missing"]), number(&displacement["pixels"])), (0.0, 2.0));
        assert_eq!((number(&row["pixels"]), instances(row).iter().sum::<f64>()), (2.0, 4.0));
        // The bones of the gate alone, which `error` tells, are within its own pixels.
        assert!(number(&row["error"]["max_pixels"]) <= 1.0, "{row}");
        assert!(number(&row["bones"]) > 0.0 && number(&row["clusters"]) > 0.0, "{row}");
    }
    assert!(number(&far["triangle_fraction"]) < 0.5 * number(&near["triangle_fraction"]));
    let [near, far] = ["crowd_300.png", "crowd_2000.png"].map(|name| {
        let picture = relievo_testing::picture(out.join(name)).into_rgba8();
        assert_eq!(picture.dimensions(), (1920, 1080));
        covered(&picture)
    });
    assert!(near > 10 * far && far > 500, "{near} and {far} pixels");
}

/// The rounding of positions on the screen, in pixels.
const ROUNDING: f64 = 2e-3;

/// Without level of detail, every bone, influence and triangle is drawn where it belongs.
#[test]
fn the_gate_off_is_exact() {
    let ([near, far], ..) = rows("report.json", &["--gate", "off", "--image"]);
    for row in [near, far] {
        assert!(off(&row)[0] <= ROUNDING, "{row}");
        assert!(number(&row["skinned_fraction"]) > 0.9 && number(&row["triangle_fraction"]) == 1.0, "{row}");
    }
}

/// A quarter of a pixel each for the gate and the influences, and one for the meshes: a part that a way lacks takes none of the others'.
#[test]
fn scenes_compare_six_ways() {
    let gate = ["--gate", "bounded", "--pixels", "0.25", "--scene"];
    let parts = ["--skinning", "bounded:0.25", "--mesh", "bounded:1"];
    let ([near, far], out, _folder) = rows("scene.json", &[&gate[..], &parts].concat());
    let text = std::fs::read(out.join("scene.json")).expect("written");
    let report: Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!((&report["skinning"], &report["mesh"]), (&json!("bounded:0.25"), &json!("bounded:1")));
    let levels = report["levels"].as_array().expect("a list");
    let fields = |level: &Value| ["triangles", "error_metres"].map(|field| number(&level[field]));
    assert!(levels.len() > 3 && fields(&levels[0])[1] == 0.0, "{levels:?}");
    for pair in levels.windows(2) {
        let ([triangles, error], [fewer, more]) = (fields(&pair[0]), fields(&pair[1]));
        assert!(fewer < triangles && more > error, "{pair:?}");
    }
    for row in [&near, &far] {
        let bones = number(&row["off"]["bones"]);
        for (way, pixels) in [
            ("off", 0.0),
            ("animation", 0.25),
            ("skinning", 0.25),
            ("mesh", 1.0),
            ("both", 0.5),
            ("all", 1.5),
        ] {
            let found = &row[way];
            let [largest, jump] = off(found);
            assert_eq!(number(&found["pixels"]), pixels, "{way}");
            assert!(largest <= pixels + ROUNDING && jump <= 2.0 * pixels + ROUNDING, "{way}: {found}");
            assert!(number(&found["frame_nanoseconds"]) > 0.0, "{way}");
            let has = |part: &str| way == part || way == "all" || part != "mesh" && way == "both";
            assert_eq!(number(&found["triangle_fraction"]) < 1.0, has("mesh"), "{way}: {found}");
            assert_eq!(number(&found["bones"]) < 0.95 * bones, has("animation"), "{way}: {found}");
        }
        let most = |way: &str| off(&row[way])[0];
        assert!(most("animation") > 0.02 && most("skinning") > ROUNDING && most("all") > 0.1, "{row}");
        for (way, field) in [("both", "cheaper"), ("all", "all_cheaper")] {
            let cheaper = number(&row["off"]["frame_nanoseconds"]) / number(&row[way]["frame_nanoseconds"]);
            assert!((number(&row[field]["frame"]) - cheaper).abs() < 1e-9);
        }
    }
    assert!(number(&far["tall_pixels"]) < 100.0);
    assert!(instances(&far["all"])[0] == 0.0 && instances(&far["both"])[0] == 4.0, "{far}");
    assert!(relievo_testing::picture(out.join("scene.png")).width() >= 600);
    assert!(out.join("crowd_300.png").is_file());
    let near = row("scene.json", "300", &[&gate[..], &["--mesh", "full"]].concat());
    for missing in ["mesh", "all", "all_cheaper"] {
        assert_eq!(near[missing], Value::Null, "{missing}");
    }
}

/// Without the option a hand far away is not sampled; with it, it is, in the ways that have the gate. Reduced skeletons sample fewer
/// bones where all are.
#[test]
fn priorities_and_skeletons_of_a_crowd() {
    let gate = ["--gate", "uniform", "--scene", "--mesh", "full", "--skinning", "full"];
    let plain = row("scene.json", "2000", &gate);
    let (prior, ..) = report("scene.json", "2000", &[&gate[..], &["--priority", "hand_left=1"]].concat());
    let kept = &prior["distances"][0];
    let bones = |row: &Value, way: &str| number(&row[way]["bones"]);
    assert_eq!((bones(&plain, "animation"), bones(kept, "animation")), (0.0, 4.0), "{kept}");
    assert_eq!((bones(&plain, "off"), bones(kept, "both")), (bones(kept, "off"), 4.0));
    assert_eq!(prior["priorities"], json!({"hand_left": 1.0}));
    let full =
        ["--gate", "bounded", "--pixels", "8", "--image", "--frames", "11", "--tiers", "0.5,rigid:0.125"];
    let (reduced, ..) = report("report.json", "2000", &full);
    let (tiers, whole) = (&reduced["distances"][0], row("report.json", "2000", &full[..7]));
    assert!(number(&tiers["bones"]) < number(&whole["bones"]), "{tiers} {whole}");
    assert!(off(tiers)[0] <= 8.0, "{tiers}");
    assert_eq!(reduced["tiers"], json!([{"bones": 0.5, "rigid": false}, {"bones": 0.125, "rigid": true}]));
}

/// A triangle that a morph target makes ten times as high in two seconds; the one bone that moves has no vertices.
fn growing() -> Vec<u8> {
    let mut scene = Scene::of_two_bones();
    let positions = scene.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.2, 0.0]);
    scene.json["accessors"][positions]["min"] = json!([0, 0, 0]);
    scene.json["accessors"][positions]["max"] = json!([1, 0.2, 0]);
    let target = scene.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.8, 0.0]);
    let weights = scene.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let joints = scene.integers("VEC4", 1, &[0; 12]);
    scene.json["meshes"] = json!([{"primitives": [{
        "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "targets": [{"POSITION": target}],
    }]}]);
    scene.push("nodes", json!({"skin": 0, "mesh": 0}));
    push_raised_and_morphed(&mut scene, 1.5);
    scene.gltf()
}

/// Morph targets move whatever the gate decides, and each instance has a clip time of its own.
#[test]
fn morph_targets_move_in_crowds() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("growing.gltf");
    std::fs::write(&path, growing()).expect("writable");
    let [model, out] = [path, folder.path().join("out")].map(|path| path.to_str().expect("UTF-8").to_owned());
    // The pictures are a quarter of the clip apart. A bone that no vertex follows may be off by any distance.
    let drawn = |quarter: u32| {
        let frames = (30 * quarter).to_string();
        let run =
            relievo(
                &[
                    &[
                        "crowd", "--model", &model, "--clip", "0", "--gate", "bounded", "--image", "--out",
                        &out,
                    ][..],
                    &["--instances", "1", "--distance", "2000", "--frames", &frames],
                ]
                .concat(),
            );
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let text = std::fs::read(folder.path().join("out/report.json")).expect("written");
        let report: Value = serde_json::from_slice(&text).expect("JSON");
        let row = &report["distances"][0];
        assert_eq!(number(&row["skinned_fraction"]), 1.0);
        assert!(off(row)[0] <= ROUNDING, "{row}");
        covered(&relievo_testing::picture(folder.path().join("out/crowd_2000.png")).into_rgba8()) as f64
    };
    // The instance starts anywhere in the clip and passes its end once: two of three steps are a quarter of
    // the way.
    let areas = [1, 2, 3, 4].map(drawn);
    let steps: Vec<f64> = areas.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let grown: Vec<f64> = steps.iter().copied().filter(|step| *step > 0.0).collect();
    assert!(grown.len() >= 2, "{areas:?}");
    let [least, most] = [f64::min, f64::max].map(|of| grown.iter().copied().reduce(of).expect("two"));
    assert!(most < 1.2 * least && least > 0.1 * areas.iter().copied().fold(0.0, f64::max), "{areas:?}");
}

#[test]
fn bad_input_is_refused_and_nothing_written() {
    for (arguments, words) in [
        (&["--image", "--frames", "3"][..], &["frames", "3", "4"][..]),
        (&["--scene", "--frames", "3"], &["frames", "3", "4"]),
        (&["--gate", "random", "--image"], &["gate", "random", "another gate", "--image"]),
        (&["--gate", "random", "--scene"], &["gate", "random", "another gate"]),
        (&["--image", "--backend", "cpu"], &["backend", "gpu"]),
        (&["--skinning", "fade"], &["skinning", "--image"]),
        (&["--image", "--skinning", "half"], &["skinning", "half", "bounded:PIXELS"]),
        (&["--image", "--skinning", "truncate:9"], &["skinning", "truncate:9", "1 to 8"]),
        (&["--scene", "--skinning", "fade:1"], &["skinning", "fade:1", "truncate:K or fade"]),
        (&["--image", "--skinning", "bounded:-1"], &["skinning", "bounded:-1", "1e6"]),
        (&["--mesh", "full"], &["mesh", "--image"]),
        (&["--tiers", "0.5"], &["tiers", "--image"]),
        (&["--image", "--tiers", "0.5,2"], &["tiers", "2", "between 0 and 1"]),
        (&["--image", "--tiers", "0.25,0.5"], &["tiers[1]", "0.5"]),
        (&["--priority", "hand_left"], &["priority", "hand_left", "0 to 1"]),
        (&["--priority", "hand_left=2"], &["priority", "hand_left=2", "0 to 1"]),
        (&["--priority", "wing=1"], &["priorities.wing", "wing", "must be one of"]),
        (&["--image", "--mesh", "half"], &["mesh", "half", "bounded:PIXELS"]),
        (&["--scene", "--mesh", "bounded:-1"], &["mesh", "bounded:-1", "1e6"]),
        (&["--image", "--scene"], &["--image", "--scene"]),
        (&["--scene", "--pareto"], &["--pareto", "--scene"]),
    ] {
        let has_own = ["--pareto", "--gate"].iter().any(|option| arguments.contains(option));
        let gate: &[&str] = if has_own { &[] } else { &["--gate", "off"] };
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("out");
        let to = ["crowd", "--model", "builtin", "--clip", "walk", "--out", out.to_str().expect("UTF-8")];
        let run = relievo(&[&to[..], gate, arguments].concat());
        assert_refused(&run, arguments, words);
        assert!(!out.exists() && run.stdout.is_empty(), "{arguments:?} wrote something");
    }
}
