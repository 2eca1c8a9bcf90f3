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
