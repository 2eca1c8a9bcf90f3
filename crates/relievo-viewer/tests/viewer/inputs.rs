//! Everything that can be opened, and what cannot.

use std::path::Path;
use std::sync::Arc;

use relievo::asset::ModelFile;
use relievo_viewer::Memory;

use crate::driver::{Driver, different, gpu};

/// A small scene with a creature, whose model is simplified when it is opened.
pub const SCENE: &str = r#"{
  "meshes": [{ "file": "builtin:rock", "instances": [{ "at": [1.5, 0, 0] }, { "at": [-1.5, 0, -1] }] }],
  "camera": { "at": [0, 2, 7], "look": [0, 0.5, 0], "path": null },
  "background": [0.1, 0.2, 0.3]
}"#;

/// A folder with a file of each kind.
fn files() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).expect("written");
    let rock = relievo_samples::rock().expect("built in");
    write("scene.json", SCENE.replace(r#", "path": null"#, "").as_bytes());
    write("rock.glb", &rock.to_glb().expect("written"));
    let mut obj = Vec::new();
    write("land.json", br#"{"patchSize": 33, "scaleFactor": 6, "seed": "meadow"}"#);
    write("plane.json", br#"{"patchSize": 33, "coarseLevels": 4, "scaleFactor": 40, "seed": "plane"}"#);
    let file = ModelFile::from(rock);
    let package = relievo::ops::skinning::cook(&file, &mut |_| std::ops::ControlFlow::Continue(()));
    write("rock.rlv", &package.expect("cooked").expect("not broken off"));
    obj.extend(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    write("corner.obj", &obj);
    folder
}

/// The fraction of the picture that is not the background.
fn covered(driver: &mut Driver) -> f64 {
    let picture = driver.picture();
    let background = *picture.get_pixel(2, 2);
    let differs = picture.pixels().filter(|pixel| **pixel != background).count();
    differs as f64 / picture.pixels().len() as f64
}

#[test]
fn every_kind_of_file_opens_and_fills_the_picture() {
    let folder = files();
    for (name, triangles) in [
        ("scene.json", 100.0..20_000.0),
        ("rock.glb", 100.0..7_000.0),
        ("rock.rlv", 100.0..7_000.0),
        ("corner.obj", 3.0..5.0),
        ("land.json", 2_000.0..20_000.0),
        ("plane.json", 1_000.0..400_000.0),
    ] {
        let mut driver = Driver::new([640, 400]);
        driver.open(&folder.path().join(name));
        assert_eq!(driver.viewer.notice(), None, "{name}");
        assert_eq!(driver.shown().name, name);
        let seen = driver.triangles();
        assert!(triangles.contains(&seen), "{name}: {seen} triangles");
        let covered = covered(&mut driver);
        assert!((0.04..0.999).contains(&covered), "{name}: {covered} of the picture");
        assert_eq!(driver.viewer.settings().recent[0], folder.path().join(name).display().to_string());
    }
}

#[test]
fn a_scene_with_a_mistake_is_told_with_its_path_and_the_old_one_stays() {
    let folder = files();
    let mut driver = Driver::new([640, 400]);
    driver.open(&folder.path().join("rock.glb"));
    let before = driver.picture();
    for (text, why) in [
        (SCENE.replace("[1.5, 0, 0]", "[1.5, 0]"), "meshes[0].instances[0].at"),
        (SCENE.replace("builtin:rock", "no.glb").replace(r#", "path": null"#, ""), "meshes[0].file"),
        ("{ \"camera\": oops".to_owned(), "bad.json"),
        ("nothing".to_owned(), "must be a scene file, a model (.glb, .gltf, .obj, .rlv)"),
    ] {
        std::fs::write(folder.path().join("bad.json"), text).expect("written");
        driver.open(&folder.path().join("bad.json"));
        let notice = driver.viewer.notice().expect("a message").to_owned();
        assert!(notice.contains(why) && notice.contains("bad.json"), "{notice}");
        assert_eq!(driver.shown().name, "rock.glb");
        driver.click("Close");
        assert_eq!(driver.viewer.notice(), None);
        assert_eq!(different(&driver.picture(), &before), 0, "the old picture");
    }
    driver.viewer.open_address("there/is/no.glb");
    driver.settle();
    assert!(driver.viewer.notice().expect("a message").contains("no.glb: "));
    // What could not be opened is not offered again.
    assert_eq!(driver.viewer.settings().recent, [folder.path().join("rock.glb").display().to_string()]);
    driver.viewer.open_address("ftp://there.is/a.glb");
    assert!(driver.viewer.notice().expect("a message").contains("must be the path of a file"));
}

#[test]
fn dropped_files_open_with_those_beside_them() {
    let mut driver = Driver::new([640, 400]);
    let folder = files();
    let read = |name: &str| -> (String, Arc<[u8]>) {
        (name.to_owned(), std::fs::read(folder.path().join(name)).expect("there").into())
    };
    let scene = SCENE.replace("builtin:rock", "stones/rock.rlv").replace(r#", "path": null"#, "");
    driver.viewer.drop_files(vec![read("rock.rlv"), ("dropped.json".to_owned(), scene.into_bytes().into())]);
    driver.settle();
    assert_eq!((driver.viewer.notice(), driver.shown().name.as_str()), (None, "dropped.json"));
    assert!(driver.viewer.arrivals().iter().any(|arrival| arrival.name == "stones/rock.rlv"));
    assert!(driver.triangles() > 100.0);
    driver.viewer.drop_files(Vec::new());
    driver.viewer.drop_files(vec![("readme.txt".to_owned(), b"hello".to_vec().into())]);
    driver.settle();
    assert!(driver.viewer.notice().expect("a message").contains("readme.txt"));
    assert_eq!(driver.shown().name, "dropped.json");
}

#[test]
fn a_source_of_bytes_can_be_anything() {
    let mut driver = Driver::new([640, 400]);
    let scene = SCENE.replace(r#", "path": null"#, "");
    driver.viewer.open("a.json", Arc::new(Memory::default().with("a.json", scene.into_bytes())));
    driver.settle();
    assert_eq!(driver.shown().name, "a.json");
    let arrivals = driver.viewer.arrivals();
    assert!(arrivals.len() == 1 && arrivals[0].bytes > 100, "{arrivals:?}");
    let (bytes, seconds) = driver.viewer.first_picture().expect("drawn");
    assert!(bytes == arrivals[0].bytes && seconds > 0.0);
}

#[test]
fn a_picture_without_a_window_is_the_picture_in_it() {
    let folder = files();
    let path = folder.path().join("rock.glb");
    let mut driver = Driver::new([640, 400]);
    driver.open(&path);
    let shown = driver.picture();
    let size = [shown.width(), shown.height()];
    let start = relievo_viewer::Start { scene: Some(path.display().to_string()), ..Default::default() };
    let drawn = relievo_viewer::draw(&gpu(), &start, size).expect("drawn");
    assert_eq!(different(&drawn, &shown), 0);
    let bad = relievo_viewer::Start { scene: Some("no/such.glb".to_owned()), ..start };
    let error = relievo_viewer::draw(&gpu(), &bad, size).expect_err("it is not there").to_string();
    assert!(error.contains("such.glb"), "{error}");
    assert!(!Path::new("no").exists());
}
