//! `relievo serve`, `relievo export` and `relievo fetch`, as a user runs them.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use relievo::asset::Model;
use relievo::asset::package::PackageHeader;
use serde_json::Value;

use crate::harness::{relievo, relievo_with};

/// A running server.
struct Server {
    child: Child,
    url: String,
}

impl Server {
    fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_relievo"))
            .args(["serve", "--listen", "127.0.0.1:0", "--log", "error"])
            .args(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut lines = BufReader::new(child.stdout.take().expect("piped")).lines();
        let url = lines.next().expect("a line").expect("text");
        // The server says what it has once everything is ready. Reading on keeps the pipe open.
        let (ready, wait) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                let _ = ready.send(line);
            }
        });
        let line = wait.recv_timeout(std::time::Duration::from_secs(120)).expect("a model becomes ready");
        assert!(line.contains(": ") || line.starts_with("scenes/"), "{line}");
        Self { child, url }
    }

    /// Asks the server to end. Its exit status.
    fn end(mut self) -> Option<i32> {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").args(["-TERM", &pid]).status().expect("kill runs").success());
        self.child.wait().expect("it ends").code()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
    }
}

/// A folder with a rock, and a scene that shows it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("models")).expect("a folder");
    let rock = relievo_samples::model("rock").expect("built in").to_glb().expect("a file");
    std::fs::write(folder.path().join("models/rock.glb"), rock).expect("written");
    let scene = r#"{ "meshes": [{ "file": "models/rock.glb", "instances": [{ "at": [0, 0, 0] }] }],
        "camera": { "at": [0, 2, 6], "look": [0, 0, 0] } }"#;
    std::fs::write(folder.path().join("walk.json"), scene).expect("written");
    folder
}

fn text(path: &Path) -> String {
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn levels_are_fetched_and_completed() {
    let folder = folder();
    let at = |name: &str| text(&folder.path().join(name));
    let server = Server::start(&["--models", &at("models"), "--scene", &at("walk.json")]);
    let fetch = |arguments: &[&str]| {
        let run = relievo(&[&["fetch", &server.url, "--model", "rock"], arguments].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    };
    let [rlv, glb, json, difference] = ["a.rlv", "a.glb", "a.json", "b.json"].map(at);
    fetch(&["--level", "5", "--out", &rlv]);
    let coarse = std::fs::read(&rlv).expect("written");
    let header = PackageHeader::read(&coarse).expect("a header").0;
    let level = &header.levels[header.levels.len() - 6];
    assert_eq!(coarse.len(), level.chunk.end);
    assert_eq!(Model::from_file(rlv.as_ref()).expect("a model").meshes[0].indices.len(), 3 * level.triangles);
    fetch(&["--from", "5", "--level", "0", "--out", &rlv]);
    let whole = std::fs::read(&rlv).expect("written");
    assert!(whole.starts_with(&coarse) && whole.len() == header.bytes());
    let left =
        std::fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    assert!(!left.collect::<Vec<_>>().contains(&"a.rlv.part".into()));
    fetch(&["--level", "5", "--out", &glb]);
    let model = Model::from_file(glb.as_ref()).expect("a model");
    assert!(model.meshes[0].indices.len() == 3 * level.triangles && model.meshes[0].levels.is_empty());
    fetch(&["--level", "5", "--out", &json]);
    fetch(&["--from", "5", "--level", "4", "--out", &difference]);
    let read = |path: &str| -> Value {
        serde_json::from_slice(&std::fs::read(path).expect("written")).expect("JSON")
    };
    assert_eq!(read(&json)["indices"].as_array().expect("a list").len(), 3 * level.triangles);
    assert!(read(&difference)["substituted"].is_array());
    // A transfer that was broken off goes on, and a damaged part of it is fetched again.
    let mut part = whole[..whole.len() / 2].to_vec();
    let last = part.len() - 1;
    part[last] ^= 1;
    std::fs::write(at("c.rlv.part"), part).expect("written");
    fetch(&["--out", &at("c.rlv")]);
    assert!(std::fs::read(at("c.rlv")).expect("written") == whole);
    // The same scene from the server and from the file.
    let pictures = [at("walk.json"), format!("{}scenes/walk.json", server.url)].map(|scene| {
        let out = tempfile::tempdir().expect("a folder");
        let folder = text(out.path());
        let run = relievo(&["scene", &scene, "--size", "64x48", "--out", &folder, "--depth", "forward"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        relievo_testing::picture(out.path().join("frame_0000.png")).into_rgba8()
    });
    let difference = crate::harness::Difference::of(&pictures[0], &pictures[1], 3);
    assert!(difference.flip < 0.02, "{difference:?}");
    assert_eq!(server.end(), Some(0));
}

#[test]
fn mistakes_in_requests_are_told() {
    let folder = folder();
    let at = |name: &str| text(&folder.path().join(name));
    let server = Server::start(&["--models", &at("models"), "--base", "/world", "--token", "sesame"]);
    let refused = |arguments: &[&str], environment: &[(&str, &str)], words: &str| {
        let run = relievo_with(&[&["fetch"], arguments].concat(), environment);
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    };
    let token = [("RELIEVO_TOKEN", "sesame")];
    let out = at("x.rlv");
    let url = &*server.url;
    assert!(url.ends_with("/world/"), "{url}");
    refused(&[url, "--model", "rock", "--out", &out], &[], "status 401");
    refused(&[url, "--model", "rock", "--out", &out], &[("RELIEVO_TOKEN", "wrong")], "status 401");
    refused(&[url, "--model", "none", "--out", &out], &token, "must be one of the server's models: rock");
    refused(&[url, "--model", "rock", "--level", "99", "--out", &out], &token, "--level = 99: must be below");
    refused(
        &[url, "--model", "rock", "--level", "3", "--from", "3", "--out", &out],
        &token,
        "--from = 3: must be above 3",
    );
    refused(&[url, "--model", "rock", "--out", &at("x.obj")], &token, "must end in .rlv, .glb or .json");
    refused(&[url, "--out", &at("x.json")], &token, "--model = none");
    refused(
        &[&url.replace("/world/", "/"), "--model", "rock", "--out", &out],
        &token,
        "everything is below /world/",
    );
    refused(&["http://127.0.0.1:9", "--model", "rock", "--out", &out], &token, "refused");
    refused(&[url, "--model", "rock", "--from", "3", "--out", &out], &token, "x.rlv");
    assert!(!Path::new(&out).exists());
    for (arguments, words) in [
        (vec!["serve"], "models = none: must be given"),
        (vec!["serve", "--models", &at("models"), "--base", "world"], "base = world"),
        (vec!["serve", "--models", &at("models"), "--listen", "nowhere"], "nowhere"),
        (vec!["serve", "--config", &at("walk.json")], "walk.json"),
        (vec!["export", "--scene", &at("none.json"), "--out", &at("site")], "none.json"),
    ] {
        let run = relievo(&arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
}

#[test]
fn an_export_is_a_folder_of_files() {
    let folder = folder();
    let at = |name: &str| text(&folder.path().join(name));
    let config = format!(r#"{{ "models": {:?}, "scenes": [{:?}] }}"#, at("models"), at("walk.json"));
    std::fs::write(at("serve.json"), config).expect("written");
    let run = relievo(&["export", "--config", &at("serve.json"), "--out", &at("site")]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(at("site/manifest.json")).expect("written")).expect("JSON");
    let files = manifest["files"].as_array().expect("a list");
    let has = |path: &str| files.iter().any(|file| file["path"] == path);
    assert!(
        ["catalog.json", "scenes/walk.json", "models/rock.rlv", "models/rock/0.json"].into_iter().all(has)
    );
    // The exported scene is a scene file like any other.
    let run = relievo(&["scene", &at("site/scenes/walk.json"), "--size", "32x24", "--out", &at("drawn")]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}
