//! `relievo crowd --image` and `--scene`

use std::path::PathBuf;

use serde_json::Value;

use serde_json::json;

use crate::harness::{Run, relievo};
use crate::scene::Scene;
use crate::{assert_refused, push_raised_and_morphed};

const SMALL: [&str; 8] = ["--model", "builtin", "--clip", "walk", "--instances", "4", "--frames", "11"];

/// Runs `crowd` into the folder `out` of a folder of its own.
fn run(arguments: &[&str]) -> (Run, PathBuf, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out");
    let run = relievo(&[&["crowd", "--out", out.to_str().expect("UTF-8")], &SMALL[..], arguments].concat());
    (run, out, folder)
}

/// The rows of a report at 300 and 2000 units.
fn rows(name: &str, arguments: &[&str]) -> ([Value; 2], PathBuf, tempfile::TempDir) {
    let (run, out, folder) = run(&[&["--distance", "300,2000"], arguments].concat());
    assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
    let text = std::fs::read(out.join(name)).expect("written");
    let report: Value = serde_json::from_slice(&text).expect("JSON");
    crate::assert_documented(&report);
    let [near, far] = &report["distances"].as_array().expect("a list")[..] else { panic!("two distances") };
    ([near.clone(), far.clone()], out, folder)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Number of pixels that differ from the first one.
fn covered(picture: &image::RgbaImage) -> usize {
    picture.pixels().filter(|pixel| *pixel != picture.get_pixel(0, 0)).count()
}

#[test]
fn crowds_are_drawn_and_timed() {
    let ([near, far], out, _folder) = rows("report.json", &["--gate", "uniform", "--image"]);
    for row in [&near, &far] {
        for field in
            ["nanoseconds_per_vertex", "frame_nanoseconds", "compute_nanoseconds", "draw_nanoseconds"]
        {
            assert!(number(&row[field]) > 0.0, "{field}");
            assert!(number(&row[format!("full_{field}")]) > 0.0, "full_{field}");
        }
        let error = &row["vertex_error"];
        assert_eq!((number(&error["points"]), number(&error["unseen"])), (4.0 * 5284.0 * 11.0, 0.0));
    }
    // Beyond the range nothing moves, so that nothing is skinned and the first frame is drawn.
    assert_eq!(number(&far["skinned_fraction"]), 0.0);
    assert!(number(&near["skinned_fraction"]) > 0.4);
    assert!(number(&far["vertex_error"]["max_metres"]) > 0.02);
    let [near, far] = ["crowd_300.png", "crowd_2000.png"].map(|name| {
        let picture = image::open(out.join(name)).expect("a PNG").into_rgba8();
        assert_eq!(picture.dimensions(), (1920, 1080));
        covered(&picture)
    });
    assert!(near > 10 * far && far > 500, "{near} and {far} pixels");
}

/// Without level of detail a gate changes nothing but the time.
#[test]
fn the_gate_off_is_exact() {
    let ([near, far], ..) = rows("report.json", &["--gate", "off", "--image"]);
    for row in [near, far] {
        assert_eq!(number(&row["vertex_error"]["max_metres"]), 0.0);
        assert!(number(&row["skinned_fraction"]) > 0.9);
    }
}

#[test]
fn scenes_compare_five_ways() {
    let gate = ["--gate", "bounded", "--pixels", "0.5", "--scene"];
    let fade = ["--skinning", "fade"];
    let ([near, far], out, _folder) = rows("scene.json", &[&gate[..], &fade].concat());
    let worst = |row: &Value, way: &str| number(&row[way]["vertex_error"]["max_pixels"]);
    for row in [&near, &far] {
        assert_eq!(worst(row, "off"), 0.0);
        let bound = 0.5 * 1.001;
        assert!(worst(row, "animation") > 0.0 && worst(row, "animation") <= bound, "{row}");
        // Stale bones add no more than their bound to the error of a vertex, whichever bone it follows.
        assert!(worst(row, "both") <= worst(row, "skinning") + bound, "{row}");
        for way in ["off", "animation", "skinning", "both", "all"] {
            assert!(number(&row[way]["frame_nanoseconds"]) > 0.0, "{way}");
            assert!(way == "all" || number(&row[way]["triangle_fraction"]) == 1.0, "{way}");
        }
        for (way, field) in [("both", "cheaper"), ("all", "all_cheaper")] {
            let cheaper = number(&row["off"]["frame_nanoseconds"]) / number(&row[way]["frame_nanoseconds"]);
            assert!((number(&row[field]["frame"]) - cheaper).abs() < 1e-9);
        }
    }
    assert!(number(&far["tall_pixels"]) < 100.0 && number(&far["mean_omega"]) == 0.0);
    assert!(image::open(out.join("scene.png")).expect("a PNG").width() >= 600);
    assert!(out.join("crowd_300.png").is_file());
    // The end of a fade leaves only the strongest bone.
    let ([truncated_near, truncated], ..) =
        rows("scene.json", &[&gate[..], &["--skinning", "truncate:1", "--mesh", "full"]].concat());
    assert_eq!((&truncated["all"], &truncated["all_cheaper"]), (&Value::Null, &Value::Null));
    let metres = |row: &Value| number(&row["skinning"]["vertex_error"]["max_metres"]);
    assert!((metres(&truncated) - metres(&far)).abs() < 1e-5 && metres(&far) > 1e-3);
    assert!(metres(&truncated_near) > metres(&near));
}

/// Half a pixel each for the gate, the fade and the meshes: one and a half in all, at any distance of the
/// crowd.
#[test]
fn levels_of_detail_keep_their_pixels() {
    let gate = ["--gate", "bounded", "--pixels", "0.5", "--scene"];
    let ([near, far], out, _folder) = rows("scene.json", &gate);
    let text = std::fs::read(out.join("scene.json")).expect("written");
    let report: Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!((&report["skinning"], &report["mesh"]), (&json!("bounded:0.5"), &json!("bounded:0.5")));
    let levels = report["levels"][0].as_array().expect("one mesh");
    for pair in levels.windows(2) {
        let fields =
            |level: &Value| ["triangles", "vertices", "error_metres", "from"].map(|f| number(&level[f]));
        let ([t, v, e, f], [fewer_t, fewer_v, more_e, more_f]) = (fields(&pair[0]), fields(&pair[1]));
        assert!(fewer_t < t && fewer_v < v && more_e >= e && more_f >= f, "{pair:?}");
    }
    let [begin, end] = [0, 1].map(|end| number(&report["fade"][0][end]));
    assert!(begin > 50.0 && begin < 300.0 && end > 2000.0, "{begin} to {end}");
    assert!((0.001..0.1).contains(&number(&report["stray_metres"][0])));
    for row in [&near, &far] {
        let worst = |way: &str| number(&row[way]["vertex_error"]["max_pixels"]);
        // Each bound has a slack of 0.001 pixels for the rounding of positions in the picture.
        assert!(worst("animation") <= 0.501 && worst("skinning") <= 0.501 && worst("both") <= 1.002, "{row}");
        assert!(worst("all") <= 1.503 && worst("skinning") > 0.03 && worst("both") >= 0.03, "{row}");
    }
    assert!(number(&far["all"]["triangle_fraction"]) < 0.5 * number(&near["all"]["triangle_fraction"]));
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
    // The pictures are a quarter of the clip apart; Ω is 0, so no bone moves.
    let drawn = |quarter: u32| {
        let frames = (30 * quarter).to_string();
        let run =
            relievo(
                &[
                    &[
                        "crowd", "--model", &model, "--clip", "0", "--gate", "uniform", "--image", "--out",
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
        assert_eq!((number(&row["interpolated"]), number(&row["skinned_fraction"])), (0.0, 1.0));
        assert_eq!(number(&row["vertex_error"]["max_metres"]), 0.0);
        covered(&image::open(folder.path().join("out/crowd_2000.png")).expect("a PNG").into_rgba8()) as f64
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
        (&["--image", "--frames", "4"][..], &["frames", "4", "5"][..]),
        (&["--scene", "--frames", "10"], &["frames", "10", "11"]),
        (&["--image", "--backend", "cpu"], &["backend", "gpu"]),
        (&["--skinning", "fade"], &["skinning", "--image"]),
        (&["--image", "--skinning", "half"], &["skinning", "half", "truncate:K"]),
        (&["--image", "--skinning", "truncate:0"], &["skinning", "truncate:0"]),
        (&["--image", "--skinning", "bounded:-1"], &["skinning", "bounded:-1", "1e6"]),
        (&["--mesh", "full"], &["mesh", "--image"]),
        (&["--image", "--mesh", "half"], &["mesh", "half", "bounded:PIXELS"]),
        (&["--scene", "--mesh", "bounded:-1"], &["mesh", "bounded:-1", "1e6"]),
        (&["--image", "--scene"], &["--image", "--scene"]),
        (&["--scene", "--pareto"], &["--pareto", "--scene"]),
    ] {
        let gate: &[&str] = if arguments.contains(&"--pareto") { &[] } else { &["--gate", "off"] };
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("out");
        let to = ["crowd", "--model", "builtin", "--clip", "walk", "--out", out.to_str().expect("UTF-8")];
        let run = relievo(&[&to[..], gate, arguments].concat());
        assert_refused(&run, arguments, words);
        assert!(!out.exists() && run.stdout.is_empty(), "{arguments:?} wrote something");
    }
}
