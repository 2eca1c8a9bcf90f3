//! `relievo scene`: how levels of detail change.

use serde_json::json;

use crate::assert_refused;
use crate::scene_file::Folder;

/// Levels of detail change as the scene says, as an object says, or as the command line says for all; and a frame on the
/// way is about as far off as is allowed.
#[test]
fn levels_move_into_each_other_where_that_is_asked_for() {
    let folder = Folder::new();
    let scene = |of_quality: &str, of_mesh: Option<&str>| {
        let mut mesh = json!({
            "file": "builtin:rock",
            "scatter": {"count": 12, "seed": "rocks", "area": [[-8, -12], [8, 2]], "scale": [1, 2]},
        });
        if let Some(transition) = of_mesh {
            mesh["transition"] = json!(transition);
        }
        let camera = json!({"at": [0, 3, 12], "look": [0, 1, -4]});
        let quality = json!({"pixels": 4, "transition": of_quality});
        json!({"meshes": [mesh], "camera": camera, "quality": quality}).to_string()
    };
    let picture = |scene: String, arguments: &[&str]| {
        let run = folder.run(&scene, &[&["--size", "160x100", "--samples", "1"], arguments].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        folder.frame(0).into_rgb8()
    };
    let hard = picture(scene("hard", None), &[]);
    let soft = picture(scene("geomorph", None), &[]);
    assert!(hard != soft, "nothing is on its way");
    let asked: [(&str, Option<&str>, &[&str]); 2] =
        [("hard", Some("geomorph"), &[]), ("hard", Some("hard"), &["--transition", "geomorph"])];
    for (of_quality, of_mesh, arguments) in asked {
        assert!(picture(scene(of_quality, of_mesh), arguments) == soft, "{of_mesh:?} {arguments:?}");
    }
    for arguments in [&[][..], &["--transition", "hard"]] {
        let of_mesh = arguments.is_empty().then_some("hard");
        assert!(picture(scene("geomorph", of_mesh), arguments) == hard, "{arguments:?}");
    }
    picture(scene("geomorph", None), &["--compare"]);
    let displacement = &folder.report()["frames"][0]["compared"]["displacement"];
    let largest = displacement["largest"].as_f64().expect("a number");
    assert!((0.1..=4.0).contains(&largest), "{displacement}");
    let refused = folder.run(&scene("hard", None), &["--transition", "soft"]);
    assert_refused(&refused, &["--transition"], &["geomorph"]);
    // One triangle has no coarser level.
    folder.write("one.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let one = json!({"file": "one.obj", "transition": "geomorph", "instances": [{"at": [0, 0, 0]}]});
    let alone = json!({"meshes": [one], "camera": {"at": [0, 3, 12], "look": [0, 1, -4]}}).to_string();
    assert_refused(&folder.run(&alone, &[]), &["one.obj"], &["meshes[0].transition = geomorph", "levels"]);
}

/// Levels are chosen as the file says: a forced level, distances, a budget; and they are what the layer of levels shows.
#[test]
fn levels_are_chosen_as_the_file_says() {
    let folder = Folder::new();
    let report = |lod: serde_json::Value, quality: serde_json::Value, arguments: &[&str]| {
        let mesh = json!({
            "file": "builtin:rock",
            "lod": lod,
            "transition": {"kind": "dither", "band": 0.05},
            "instances": [{"at": [0, 0, 0]}, {"at": [1, 0, -20]}, {"at": [2, 0, -40]}],
        });
        let camera = json!({"at": [0, 3, 12], "look": [0, 1, -4]});
        let scene = json!({"meshes": [mesh], "camera": camera, "quality": quality}).to_string();
        let run = folder.run(&scene, &[&["--size", "160x100", "--samples", "1"], arguments].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        folder.report()["frames"][0]["objects"][0]["levels"].clone()
    };
    let instances = |levels: serde_json::Value| {
        let of_level = |level: &serde_json::Value| level["instances"].as_u64().expect("a number");
        levels.as_array().expect("a list").iter().map(of_level).collect::<Vec<_>>()
    };
    assert_eq!(instances(report(json!({"level": 2}), json!({}), &[]))[2], 3);
    let distances = json!({"criterion": "distance", "from": [20, 40], "hysteresis": 0});
    assert_eq!(instances(report(distances.clone(), json!({}), &[]))[..3], [1, 1, 1]);
    // All pixels of an instance have the colour of its level.
    let forced = report(json!({"level": 0}), json!({}), &["--layer", "levels"]);
    assert_eq!(instances(forced)[0], 3);
    let red = |picture: &image::RgbImage| {
        picture.pixels().filter(|pixel| pixel[0] / 2 > pixel[1] && pixel[0] > 60).count()
    };
    let picture = folder.frame(0).into_rgb8();
    assert!(red(&picture) > 200, "level 0 is red: {} pixels", red(&picture));
    report(json!({"level": 4}), json!({}), &["--layer", "levels"]);
    assert_eq!(red(&folder.frame(0).into_rgb8()), 0, "level 4 is not");
    // A budget, of the file and of the command line.
    let sum = |levels: serde_json::Value| {
        let of_level = |level: &serde_json::Value| level["triangles"].as_u64().expect("a number");
        levels.as_array().expect("a list").iter().map(of_level).sum::<u64>()
    };
    let full = sum(report(json!({}), json!({"pixels": 0}), &[]));
    let limit = full / 6;
    for (quality, arguments) in [
        (json!({"pixels": 0.01, "triangles": limit}), vec![]),
        (json!({"pixels": 0.01}), vec!["--triangles".to_owned(), limit.to_string()]),
    ] {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let drawn = sum(report(json!({}), quality, &arguments));
        assert!(drawn <= limit && drawn > limit / 3, "{drawn} of {limit}, {full} in all");
    }
}
