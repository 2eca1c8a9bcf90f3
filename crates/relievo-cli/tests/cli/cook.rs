//! `relievo cook`

use relievo::asset::Model;
use serde_json::{Value, json};

use super::{assert_documented, assert_refused};
use crate::harness::relievo;
use crate::scene_file::Folder;

#[test]
fn a_package_is_read_like_any_other_model() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let [package, again, report] = ["creature.rlv", "again.rlv", "report.json"].map(path);
    let run = relievo(&["cook", "builtin:creature", "--out", &package, "--json", &report]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let report: Value = serde_json::from_slice(&std::fs::read(report).expect("written")).expect("JSON");
    assert_documented(&report);
    let levels = report["levels"].as_array().expect("a list");
    // A heading, a line a level, and a sum.
    assert_eq!(run.stdout.lines().count(), levels.len() + 2);
    assert!(levels.len() > 9 && report["quantization"].as_f64().is_some_and(|error| error > 0.0));
    let bytes = std::fs::read(&package).expect("written");
    assert_eq!(report["bytes"].as_u64(), Some(bytes.len() as u64));
    let model = Model::from_file(package.as_ref()).expect("read");
    assert_eq!(
        model.meshes[0].indices.len() / 3,
        levels[levels.len() - 1]["triangles"].as_u64().expect("a number") as usize
    );
    // A package is not cooked again: it has the same levels.
    let run = relievo(&["cook", &package, "--out", &again]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let facts = |bytes: &[u8]| {
        let (header, _) = relievo::asset::package::PackageHeader::read(bytes).expect("a header");
        let level =
            |level: &relievo::asset::package::PackageLevel| (level.triangles, level.vertices, level.error);
        (header.quantization, header.levels.iter().map(level).collect::<Vec<_>>())
    };
    assert_eq!(facts(&std::fs::read(again).expect("written")), facts(&bytes));
    let run = relievo(&["priorities", "--model", &package, "--clip", "walk"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

/// A scene draws the package with the levels that it has, the same picture at every start, and hardly another picture than that
/// of the source.
#[test]
fn scenes_draw_packages_as_they_are() {
    let folder = Folder::new();
    let source = relievo_samples::creature().expect("valid").to_glb().expect("written");
    folder.write("creature.glb", &source);
    let [source, package] =
        ["creature.glb", "creature.rlv"].map(|name| folder.path(name).display().to_string());
    let run = relievo(&["cook", &source, "--out", &package]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let bytes = std::fs::read(folder.path("creature.rlv")).expect("written");
    let (header, _) = relievo::asset::package::PackageHeader::read(&bytes).expect("a header");
    let picture = |file: &str, pixels: f32| {
        let characters = json!([{"file": file, "clip": "walk", "instances": [{"at": [0, 0, 0]}]}]);
        let meshes = json!([{"file": file, "instances": [{"at": [2, 0, 0]}]}]);
        let camera = json!({"at": [0, 2, 8], "look": [0, 1, 0]});
        let scene = json!({"meshes": meshes, "characters": characters, "camera": camera, "quality": {"pixels": pixels}});
        let run = folder.run(&scene.to_string(), &["--size", "160x100", "--samples", "1"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        (folder.frame(0).into_rgb8(), folder.report()["objects"].clone())
    };
    let (first, objects) = picture("creature.rlv", 2.0);
    assert!(picture("creature.rlv", 2.0).0 == first);
    // Each of the object's levels is one of the package's.
    for object in objects.as_array().expect("a list") {
        for error in &object["errors"].as_array().expect("a list")[1..] {
            let error = error.as_f64().expect("a number");
            let is_known =
                header.levels.iter().any(|level| (f64::from(level.error) - error).abs() <= 1e-6 * error);
            assert!(is_known, "{error} of {object}");
        }
    }
    let [cooked, source] = ["creature.rlv", "creature.glb"].map(|file| picture(file, 0.0).0);
    let differ = cooked
        .pixels()
        .zip(source.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 8));
    let differ = differ.count();
    assert!(differ < 30, "{differ} of 16,000 pixels");
}

#[test]
fn mistakes_are_told_before_the_work() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let out = path("out.rlv");
    let refused = |arguments: &[&str], words: &[&str]| assert_refused(&relievo(arguments), arguments, words);
    refused(&["cook", "builtin:dragon", "--out", &out], &["dragon"]);
    refused(&["cook", &path("none.glb"), "--out", &out], &["none.glb"]);
    std::fs::write(path("damaged.rlv"), b"RLV\n1234").expect("writable");
    refused(&["cook", &path("damaged.rlv"), "--out", &out], &["damaged.rlv", "package.len"]);
    refused(&["cook", "builtin:wall"], &["--out"]);
    assert!(!folder.path().join("out.rlv").exists());
}
