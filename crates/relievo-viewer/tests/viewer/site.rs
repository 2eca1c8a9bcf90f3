//! Scenes of a server (`relievo serve`): they appear coarsest first, and go on when the server dies and returns.

use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use relievo_delivery::client::get;
use relievo_delivery::server::{Limits, ServeOptions};
use relievo_viewer::{Memory, Request, Settings};

use crate::driver::{Driver, creature, different, gpu, settings};
use crate::host::{Host, options};
use crate::inputs::SCENE as SCENE_OF_ROCKS;

const SCENE: &str = r#"{
  "meshes": [{ "file": "rock.rlv", "instances": [{ "at": [2, 0, 0] }, { "at": [-2, 0, -1] }] }],
  "characters": [{ "file": "creature.rlv", "clip": "walk", "gate": "off", "instances": [{ "at": [0, 0, 0] }] }],
  "light": { "direction": [0.4, 0.8, 0.6] },
  "camera": { "at": [0, 2, 6], "look": [0, 0.8, 0] },
  "quality": { "pixels": 0.05 },
  "background": [0.2, 0.22, 0.25]
}"#;

/// Bits a second of thesis B's slower connection.
const SLOW: f64 = 2e6;

/// A folder with the scene and its packages.
fn folder() -> &'static tempfile::TempDir {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let rock = relievo_samples::rock().expect("built in").into();
        let rock = relievo::ops::skinning::cook(&rock, &mut |_| std::ops::ControlFlow::Continue(()));
        let rock = rock.expect("cooked").expect("not broken off");
        for (name, bytes) in
            [("walk.json", SCENE.as_bytes()), ("rock.rlv", rock.as_slice()), ("creature.rlv", &*creature())]
        {
            std::fs::write(folder.path().join(name), bytes).expect("written");
        }
        folder
    })
}

/// A server of the folder.
fn serve(listen: &str) -> Host {
    let folder = folder().path();
    Host::start(ServeOptions {
        scenes: vec![folder.join("walk.json")],
        listen: listen.to_owned(),
        // Connections that are kept do not keep a server alive for long that ends.
        limits: Limits { idle_seconds: 0.5, ..Limits::default() },
        ..options(folder)
    })
}

/// The address of the scene.
fn scene(host: &Host) -> String {
    format!("{}/scenes/walk.json", host.base())
}

fn viewer(throttle: Option<f64>) -> Driver {
    Driver::with(gpu(), [640, 700], 1.0, Settings { throttle, ..settings() })
}

/// Shows rocks from memory.
fn rocks(driver: &mut Driver) {
    let scene = SCENE_OF_ROCKS.replace(r#", "path": null"#, "").into_bytes();
    driver.viewer.open("rocks.json", Arc::new(Memory::default().with("rocks.json", scene)));
    driver.settle();
}

/// Draws frames until a condition holds.
fn until(driver: &mut Driver, what: &str, holds: impl Fn(&Driver) -> bool) {
    let start = Instant::now();
    while !holds(driver) {
        assert!(start.elapsed() < Duration::from_secs(60), "no {what}: {:?}", driver.viewer.notice());
        driver.frame();
    }
}

fn is_whole(driver: &Driver) -> bool {
    driver.viewer.step().is_none() && driver.viewer.shown().is_some_and(|shown| !shown.is_streaming())
}

/// Number of levels that are there, and number of all that are known.
fn levels(driver: &Driver) -> [usize; 2] {
    let packages = driver.viewer.shown().map(relievo_viewer::Shown::packages).unwrap_or_default();
    [0, 1].map(|at| packages.iter().map(|package| package.levels[at]).sum())
}

/// The picture of a scene whose time stands still at 0.
fn still(driver: &mut Driver) -> image::RgbaImage {
    driver.frames(8);
    driver.picture()
}

/// Opens the scene of a site, with its time at 0.
fn begin(driver: &mut Driver, url: String) {
    driver.viewer.begin(relievo_viewer::Start { scene: Some(url), time: Some(0.0), ..Default::default() });
}

/// The picture of the scene of whole files, as the server has them.
fn whole(host: &Host) -> image::RgbaImage {
    let text = get(&scene(host), None).expect("the scene");
    let scene: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scenes/walk.json");
    for list in ["meshes", "characters"] {
        let name = scene[list][0]["file"].as_str().expect("a name").trim_start_matches("../").to_owned();
        let own = folder.path().join(&name);
        std::fs::create_dir_all(own.parent().expect("a folder")).expect("made");
        std::fs::write(own, get(&format!("http://{}/{name}", host.address), None).expect("a package"))
            .expect("written");
    }
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    std::fs::write(&path, text).expect("written");
    let mut driver = viewer(None);
    begin(&mut driver, path.display().to_string());
    driver.settle();
    assert_eq!(driver.viewer.notice(), None);
    still(&mut driver)
}

#[test]
fn a_scene_of_a_site_appears_coarsest_first_and_becomes_that_of_the_whole_files() {
    let host = serve("127.0.0.1:0");
    let expected = whole(&host);
    let mut driver = viewer(Some(SLOW));
    begin(&mut driver, scene(&host));
    until(&mut driver, "first picture", |driver| driver.viewer.first_picture().is_some());
    let (bytes, _) = driver.viewer.first_picture().expect("drawn");
    let mut seen = Vec::new();
    while !is_whole(&driver) {
        driver.frame();
        let now = levels(&driver)[0];
        if seen.last() != Some(&now) {
            seen.push(now);
        }
    }
    driver.save("site");
    assert_eq!(driver.viewer.notice(), None);
    assert!(seen.len() >= 4 && seen.is_sorted(), "levels one after the other: {seen:?}");
    let total = driver.viewer.bytes();
    println!("first picture after {bytes} of {total} bytes");
    assert!(4 * bytes < total, "first picture after {bytes} of {total} bytes");
    assert_eq!(different(&still(&mut driver), &expected), 0);
    let [here, all] = levels(&driver);
    assert!(here == all, "{here} of {all} levels");
    // By the names of their files, though their addresses are hashes.
    let shown = driver.shown();
    let mut names: Vec<_> = shown.packages().into_iter().map(|package| package.name).collect();
    names.sort();
    assert_eq!(names, ["creature.rlv", "rock.rlv"]);
    let listed: Vec<_> = shown.stage.world.objects.iter().map(|object| object.name.as_str()).collect();
    assert!(names.iter().all(|name| listed.contains(&name.as_str())), "{listed:?}");
    let arrived: Vec<_> = driver.viewer.arrivals().iter().map(|arrival| arrival.name.as_str()).collect();
    assert!(arrived.iter().any(|name| name.starts_with("rock.rlv from")), "{arrived:?}");
}

#[test]
fn throttles_hold_their_rate_and_can_be_taken_off() {
    let host = serve("127.0.0.1:0");
    for (rate, name) in [(SLOW, "2 Mbit/s"), (15.91e6, "15.91 Mbit/s")] {
        let mut driver = viewer(None);
        rocks(&mut driver);
        driver.click("Network");
        driver.choose("throttle", name);
        assert_eq!(driver.viewer.settings().throttle, Some(rate));
        let (start, before) = (Instant::now(), driver.viewer.bytes());
        begin(&mut driver, scene(&host));
        until(&mut driver, "scene", |driver| driver.shown().name == "walk.json" && is_whole(driver));
        let measured = 8.0 * (driver.viewer.bytes() - before) as f64 / start.elapsed().as_secs_f64();
        assert!(measured < 1.05 * rate, "{measured} of {rate} bits a second");
    }
    let mut driver = viewer(Some(1000.0));
    begin(&mut driver, scene(&host).replace("walk.json", "none.json"));
    driver.settle();
    assert!(driver.viewer.notice().expect("told").contains("404"), "{:?}", driver.viewer.notice());
    rocks(&mut driver);
    driver.click("Network");
    driver.choose("throttle", "no limit");
    begin(&mut driver, scene(&host));
    until(&mut driver, "scene", |driver| driver.shown().name == "walk.json" && is_whole(driver));
}

#[test]
fn a_package_of_a_site_is_framed_by_its_coarsest_level() {
    let host = serve("127.0.0.1:0");
    let mut driver = viewer(Some(SLOW));
    driver.viewer.open_address(&format!("{}/models/creature.rlv", host.base()));
    driver.settle();
    assert_eq!(driver.viewer.notice(), None);
    let first = levels(&driver);
    until(&mut driver, "package", is_whole);
    assert!(first[0] < levels(&driver)[0], "{first:?} {:?}", levels(&driver));
    let picture = still(&mut driver);
    let background = *picture.get_pixel(2, 2);
    let covered = picture.pixels().filter(|pixel| **pixel != background).count();
    assert!(covered > picture.pixels().len() / 25, "{covered} pixels");
}

#[test]
fn a_server_that_dies_is_told_and_its_return_goes_on() {
    let host = serve("127.0.0.1:0");
    let expected = whole(&host);
    let address = host.address.to_string();
    let mut driver = viewer(Some(SLOW));
    begin(&mut driver, scene(&host));
    until(&mut driver, "level", |driver| levels(driver)[0] >= 3);
    assert!(!is_whole(&driver));
    drop(host);
    until(&mut driver, "message", |driver| driver.shown().waits().is_some());
    let there = levels(&driver)[0];
    let picture = still(&mut driver);
    let background = *picture.get_pixel(2, 2);
    assert!(picture.pixels().any(|pixel| *pixel != background), "what is there stays");
    driver.save("waits");

    // Nobody is there for longer than it takes to rest: the server is still asked again, without drawing all the time.
    driver.frame_after(61.0).expect("painted");
    driver.frames(10);
    assert!(!driver.viewer.is_resting());
    assert!(driver.wait.is_some_and(|wait| wait >= Duration::from_millis(20)), "{:?}", driver.wait);

    let received = driver.viewer.bytes();
    let _host = serve(&address);
    until(&mut driver, "scene", is_whole);
    assert!(levels(&driver)[0] > there && driver.shown().waits().is_none());
    assert_eq!((different(&still(&mut driver), &expected), driver.viewer.notice()), (0, None));
    assert!(driver.viewer.bytes() > received);
    // A server that was never there is told at once.
    drop(_host);
    driver.viewer.open_address(&format!("http://{address}/scenes/other.json"));
    driver.settle();
    let notice = driver.viewer.notice().expect("told");
    assert!(notice.contains(&address) || notice.contains("other.json"), "{notice}");
    assert_eq!(driver.shown().name, "walk.json");
}

#[test]
fn a_scene_of_a_site_is_built_anew_and_compared_without_fetching_again() {
    let host = serve("127.0.0.1:0");
    let mut driver = viewer(Some(SLOW));
    begin(&mut driver, scene(&host));
    // The section of bones is there with the first level of the character.
    until(&mut driver, "character", |driver| driver.find("Bones").is_some() && levels(driver)[0] >= 3);
    let before = levels(&driver);
    driver.click("Detail");
    driver.click("Time and camera");
    driver.click("Bones");
    driver.choose("gate", "bounded");
    driver.settle();
    assert!(driver.viewer.scene_text().is_some_and(|text| text.contains("bounded")));
    assert!(levels(&driver)[0] >= before[0], "{:?} {before:?}", levels(&driver));
    // The comparison fetches the missing levels, and nothing twice.
    driver.key(egui::Key::C);
    until(&mut driver, "comparison", |driver| driver.viewer.compares());
    let total = driver.viewer.bytes();
    assert!(is_whole(&driver), "{:?}", levels(&driver));
    let size = ["rock.rlv", "creature.rlv"]
        .map(|name| std::fs::metadata(folder().path().join(name)).expect("there").len());
    let all: u64 = size.iter().sum();
    assert!((total as u64) < all + 40_000, "{total} bytes for packages of {all}");
    // A saved scene finds its packages from anywhere.
    driver.click("Save scene");
    let saved = driver.requests.iter().find_map(|request| match request {
        Request::Save { name, bytes } => Some((name.clone(), bytes.clone())),
        _ => None,
    });
    let (name, bytes) = saved.expect("saved");
    let mut other = viewer(None);
    other.viewer.open(&name, Arc::new(Memory::default().with(&name, bytes)));
    other.settle();
    assert_eq!(other.viewer.notice(), None);
    assert_eq!(other.shown().stage.world.objects.len(), driver.shown().stage.world.objects.len());
    // The numbers are those of the scene that was opened last.
    let (_, seconds) = driver.viewer.first_picture().expect("drawn");
    driver.viewer.open_address(&scene(&host));
    driver.settle();
    until(&mut driver, "scene again", is_whole);
    let again = driver.viewer.bytes();
    assert!(again > 0 && (again as u64) < all + 40_000, "{again} bytes for packages of {all}");
    let (_, later) = driver.viewer.first_picture().expect("drawn");
    assert!(later != seconds, "{later} s");
}
