//! Terrain and scene files of a server.

use std::collections::BTreeSet;
use std::path::Path;

use relievo::ops::terrain::export::sha256 as hash_of;
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::recipe::Recipe;
use relievo_delivery::server::{ServeOptions, Site};
use relievo_scene_file::SceneFile;

use super::host::{Host, built_ins, runtime};

fn serve(folder: &Path) -> ServeOptions {
    ServeOptions {
        terrain: Some(folder.to_owned()),
        listen: "127.0.0.1:0".to_owned(),
        ..ServeOptions::default()
    }
}

fn heights(config: &[u8]) -> String {
    let recipe = Recipe::from_json(&String::from_utf8_lossy(config)).expect("a configuration");
    hash_of(&field(&recipe, &[[0, 0]], 0).expect("heights")[0])
}

#[test]
fn a_configuration_without_a_seed_gets_one_for_all_clients() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("config.json"), r#"{ "patchSize": 129, "scaleFactor": 14 }"#)
        .expect("written");
    let hosts = [Host::start(serve(folder.path())), Host::start(serve(folder.path()))];
    let answers = [0, 0, 1]
        .map(|host: usize| hosts[host].get("/terrain/config.json", &[("accept-encoding", "gzip, br, zstd")]));
    assert!(answers.iter().all(|answer| answer.body == answers[0].body));
    assert_eq!(answers[0].header("content-encoding"), None, "thesis B, §4.1");
    let length = answers[0].body.len();
    assert!((60..=100).contains(&length), "{length} bytes; thesis B has about 80");
    let seed = answers[0].json()["seed"].as_str().expect("a text").to_owned();
    assert_eq!(seed.len(), 32);
    assert_eq!(heights(&answers[0].body), heights(&answers[2].body));
    // Another folder has another seed, and other heights.
    let other = tempfile::tempdir().expect("a folder");
    std::fs::write(other.path().join("config.json"), r#"{ "patchSize": 129, "scaleFactor": 14 }"#)
        .expect("written");
    let host = Host::start(serve(other.path()));
    assert_ne!(heights(&host.get("/terrain/config.json", &[]).body), heights(&answers[0].body));
}

#[test]
fn injected_heights_are_given_by_patch() {
    let folder = tempfile::tempdir().expect("a folder");
    let config = r#"{ "patchSize": 129, "scaleFactor": 14, "seed": "valley" }"#;
    std::fs::write(folder.path().join("config.json"), config).expect("written");
    std::fs::create_dir(folder.path().join("features")).expect("a folder");
    for (name, text) in [
        ("a.json", r#"{"patchCoordinates":[-1,2],"precomputedHeights":[3,4,5.5]}"#),
        ("b.json", r#"{"patchCoordinates":[-1,2],"precomputedHeights":[7,8,-2]}"#),
    ] {
        std::fs::write(folder.path().join("features").join(name), text).expect("written");
    }
    let host = Host::start(serve(folder.path()));
    let answer = host.get("/terrain/features/-1,2.json", &[]).json();
    assert_eq!(
        answer.to_string(),
        r#"{"patchCoordinates":[-1,2],"precomputedHeights":[3.0,4.0,5.5,7.0,8.0,-2.0]}"#
    );
    let none = host.get("/terrain/features/5,5.json", &[]);
    assert_eq!((none.status, none.json()["precomputedHeights"].to_string()), (200, "[]".to_owned()));
    assert_eq!(host.get("/terrain/features/5.json", &[]).status, 404);
    // Mistakes name the file.
    let bad = r#"{"patchCoordinates":[0,0],"precomputedHeights":[3,4]}"#;
    std::fs::write(folder.path().join("features/c.json"), bad).expect("written");
    let error =
        runtime().block_on(Site::open(serve(folder.path()), built_ins())).err().expect("refused").to_string();
    assert!(error.contains("c.json") && error.contains("multiple of 3"), "{error}");
}

#[test]
fn a_scene_names_packages_by_their_hashes() {
    let folder = tempfile::tempdir().expect("a folder");
    let rock = relievo_samples::model("rock").expect("built in").to_glb().expect("a file");
    std::fs::create_dir(folder.path().join("models")).expect("a folder");
    std::fs::write(folder.path().join("models/rock.glb"), rock).expect("written");
    let scene = r#"{
        "terrain": { "config": { "patchSize": 33, "scaleFactor": 6, "seed": "models/rock.glb" } },
        "meshes": [
            { "file": "models/rock.glb", "scatter": { "count": 4, "seed": "models/rock.glb" } },
            { "file": "builtin:wall", "instances": [{ "on": [3, 3] }], "material": { "relief": "builtin:bricks" } }
        ],
        "characters": [{ "file": "builtin:creature", "clip": "walk", "instances": [{ "on": [5, 5] }] }],
        "camera": { "at": [10, 8, 30], "look": [10, 2, 0] }
    }"#;
    let path = folder.path().join("walk.json");
    std::fs::write(&path, scene).expect("written");
    let options = ServeOptions {
        scenes: vec![path.clone()],
        listen: "127.0.0.1:0".to_owned(),
        ..ServeOptions::default()
    };
    let host = Host::start(options);
    let answer = host.get("/scenes/walk.json", &[]);
    let text = String::from_utf8(answer.body.clone()).expect("text");
    let served = SceneFile::from_json(&text).expect("a scene file");
    let files: BTreeSet<_> = served.files().into_iter().collect();
    assert_eq!(files.len(), 3, "{files:?}");
    for file in files {
        let name = file.to_string_lossy().into_owned();
        let name = name.strip_prefix("../").expect("beside the scenes");
        assert!(name.starts_with("objects/") && name.ends_with(".rlv"), "{name}");
        assert_eq!(host.get(&format!("/{name}"), &[]).status, 200);
    }
    // Only names of files have changed.
    let value = answer.json();
    assert_eq!(value["terrain"]["config"]["seed"], "models/rock.glb");
    assert_eq!(value["meshes"][0]["scatter"]["seed"], "models/rock.glb");
    assert_eq!(value["meshes"][1]["material"]["relief"], "builtin:bricks");
    assert_eq!(host.site.catalog().scenes, ["scenes/walk.json"]);
    std::fs::write(&path, r#"{ "camera": 3 }"#).expect("written");
    let options =
        ServeOptions { scenes: vec![path], listen: "127.0.0.1:0".to_owned(), ..ServeOptions::default() };
    let error = runtime().block_on(Site::open(options, built_ins())).err().expect("refused").to_string();
    assert!(error.contains("walk.json") && error.contains("camera"), "{error}");
}
