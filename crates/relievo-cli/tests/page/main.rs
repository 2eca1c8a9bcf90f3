//! The viewer's page in headless Chromium: its picture beside the native one on the same software adapter, what its console says,
//! keys, every control, mistakes, and two pages at once.

mod controls;
mod images;
mod verify;

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use base64::Engine as _;
use image::RgbaImage;
use image::imageops::crop_imm;
use relievo_testing::wasm::Program;
use relievo_testing::{Difference, browser, wasm};
use serde_json::{Value, json};

/// A folder with a page that `make web` has built. Without the variable, the tests build one that is larger and slower.
const BUILT: &str = "RELIEVO_PAGE";

/// The largest mean FLIP between the picture of the page and the native one.
const MOST_FLIP: f32 = 0.02;

/// A scene with what a page can show without a server's help: generated terrain, a rock, and a wall with a relief.
const SCENE: &str = r#"{
  "terrain": { "config": { "patchSize": 33, "scaleFactor": 6, "seed": "page" } },
  "meshes": [
    { "file": "rock.rlv", "instances": [{ "on": [12, 14], "scale": 1.5, "lift": 0.3 }, { "on": [20, 16], "turn": 1 }] },
    { "file": "builtin:wall", "material": { "relief": "builtin:bricks" }, "instances": [{ "on": [16, 11], "scale": 2 }] }
  ],
  "camera": { "at": [16, 8, 32], "look": [16, 1, 14] },
  "quality": { "pixels": 2 }
}"#;

/// A configuration of terrain, and a scene of one triangle in a file beside it.
const LAND: &str = r#"{ "patchSize": 33, "scaleFactor": 6, "seed": "meadow" }"#;
const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const DROPPED: &str = r#"{
  "meshes": [{ "file": "corner.obj", "instances": [{ "at": [0, 0, 0] }] }],
  "camera": { "at": [1.5, 1.2, 2], "look": [0.2, 0.2, 0.2] }
}"#;

/// glTF with a number where a name has to be.
const TYPED: &str = r#"{ "asset": { "version": "2.0" }, "nodes": [{ "name": 7 }] }"#;

/// One browser at a time: each uses all processors.
static ALONE: Mutex<()> = Mutex::new(());

/// Sizes of the frames in CSS pixels.
const SIZES: [[u32; 2]; 2] = [[480, 360], [301, 223]];

/// A scene of a server, whose packages come level by level.
const STREAMED: &str = r#"{
  "meshes": [{ "file": "rock.rlv", "instances": [{ "at": [2, 0, 0] }, { "at": [-2, 0, -1] }] }],
  "characters": [{ "file": "creature.rlv", "instances": [{ "at": [0, 0, 0] }] }],
  "camera": { "at": [0, 2, 6], "look": [0, 0.8, 0] },
  "quality": { "pixels": 0.05 }
}"#;

struct Page {
    /// The results of the page, one for each case.
    said: Value,
    /// The folder of the scene and its files.
    folder: tempfile::TempDir,
}

/// `relievo serve` with the streamed scene, which ends with the value.
struct Server(Child);

impl Server {
    fn start(folder: &Path, port: u16) -> Self {
        let child = Command::new(env!("CARGO_BIN_EXE_relievo"))
            .current_dir(folder)
            .args([
                "serve",
                "--models",
                "served",
                "--scene",
                "served/walk.json",
                "--scene",
                "served/crowd.json",
                "--scene",
                "served/photos.json",
                "--listen",
            ])
            .arg(format!("127.0.0.1:{port}"))
            .stdout(Stdio::null())
            .spawn();
        let server = Self(child.expect("started"));
        let start = Instant::now();
        while std::net::TcpStream::connect(("127.0.0.1", port)).is_err() {
            assert!(start.elapsed() < Duration::from_secs(60), "the server does not listen");
            std::thread::sleep(Duration::from_millis(20));
        }
        server
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The built-in rock and creature as packages.
fn packages() -> &'static [Vec<u8>; 2] {
    static PACKAGES: OnceLock<[Vec<u8>; 2]> = OnceLock::new();
    PACKAGES.get_or_init(|| {
        ["rock", "creature"].map(|name| {
            let model = relievo_samples::model(name).expect("built in").into();
            let package = relievo::ops::skinning::cook(&model, &mut |_| std::ops::ControlFlow::Continue(()));
            package.expect("cooked").expect("not broken off")
        })
    })
}

/// The cases at a pixel ratio of 1. The folder has the files of the scenes.
fn plan(folder: &Path, port: u16) -> Vec<Value> {
    let case =
        |name: &str, query: &str, size: [u32; 2]| json!({ "name": name, "query": query, "size": size });
    let site = format!("scene=http://127.0.0.1:{port}/scenes/walk.json&time=0");
    let photos = site.replace("walk", "photos");
    let mut plan = vec![
        case("large", "scene=/scene.json&time=0", SIZES[0]),
        case("small", "scene=/scene.json&time=0", SIZES[1]),
        case("own", "", [320, 240]),
        case("mistake", "scene=/mistake.json", [320, 240]),
        case("gone", "scene=/there/is/no.glb", [320, 240]),
        case("streamed", &site, [320, 240]),
        case("dies", &site, [320, 240]),
        case("experiment", "scene=/rock.rlv", controls::SMALL),
        case("rock.glb", "scene=/rock.glb", [320, 240]),
        case("corner.obj", "scene=/corner.obj", [320, 240]),
        case("land.json", "scene=/land.json", [320, 240]),
        case("typed", "scene=/typed.gltf", [320, 240]),
        case("panel", "scene=/corner.obj", [640, 480]),
        case("photos", "scene=/photos.json&time=0", SIZES[0]),
        case("photos of a server", &photos, SIZES[0]),
    ];
    plan[0]["key"] = json!(["KeyL", "l"]);
    plan[0]["stays"] = json!(true);
    plan[1]["stays"] = json!(true);
    plan[1]["loses"] = json!(true);
    // Its detail takes long on a software adapter.
    plan[2]["partial"] = json!(true);
    plan[3]["fails"] = json!(true);
    plan[4]["fails"] = json!(true);
    plan[5]["streams"] = json!(true);
    plan[6]["streams"] = json!(true);
    plan[6]["dies"] = json!(true);
    plan[7]["experiment"] = controls::experiment(folder).into();
    plan[8]["resizes"] = json!([250, 330]);
    plan[9]["drops"] = json!(["dropped.json", "corner.obj"]);
    plan[11]["fails"] = json!(true);
    plan[12]["slides"] = json!(true);
    plan[14]["streams"] = json!(true);
    plan
}

/// A folder with what the servers serve, and a free port.
fn served() -> (tempfile::TempDir, u16) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [rock, creature] = packages();
    let (walk, crowd) = (STREAMED.as_bytes(), controls::CROWD.as_bytes());
    std::fs::create_dir(folder.path().join("served")).expect("made");
    for (name, bytes) in [
        ("rock.rlv", rock.as_slice()),
        ("creature.rlv", creature),
        ("walk.json", walk),
        ("crowd.json", crowd),
        ("photos.json", images::STREAMED.as_bytes()),
        ("photos.rlv", &images::package()),
    ] {
        std::fs::write(folder.path().join("served").join(name), bytes).expect("written");
    }
    std::fs::write(folder.path().join("rock.rlv"), rock).expect("written");
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    (folder, listener.local_addr().expect("known").port())
}

/// The cases at a pixel ratio of 1.
fn page() -> &'static Page {
    static PAGE: OnceLock<Page> = OnceLock::new();
    PAGE.get_or_init(|| {
        let _alone = ALONE.lock();
        let (folder, port) = served();
        let mut server = Some(Server::start(folder.path(), port));
        let said = visit(folder.path(), &[], &plan(folder.path(), port), &mut |note| match note {
            "server stop" => server = None,
            "server start" => server = Some(Server::start(folder.path(), port)),
            note => println!("{note}"),
        });
        Page { said, folder }
    })
}

/// The case whose controls are moved. It has the browser for itself: each step waits for frames.
fn moved() -> &'static Page {
    static PAGE: OnceLock<Page> = OnceLock::new();
    PAGE.get_or_init(|| {
        let _alone = ALONE.lock();
        let (folder, port) = served();
        let _server = Server::start(folder.path(), port);
        let scene = format!("http://127.0.0.1:{port}/scenes/crowd.json");
        let query = format!("scene={scene}&time=0");
        let steps = controls::recorded(&scene);
        let plan = [json!({ "name": "controls", "query": query, "size": controls::SIZE, "moves": steps })];
        Page { said: visit(folder.path(), &[], &plan, &mut |note| println!("{note}")), folder }
    })
}

/// The case at a pixel ratio of 2.
fn double() -> &'static Page {
    static PAGE: OnceLock<Page> = OnceLock::new();
    PAGE.get_or_init(|| {
        let _alone = ALONE.lock();
        let folder = tempfile::tempdir().expect("a temporary folder");
        let plan = [json!({ "name": "double", "query": "scene=/scene.json&time=0", "size": SIZES[1] })];
        let flags = ["--force-device-scale-factor=2"];
        Page { said: visit(folder.path(), &flags, &plan, &mut |note| println!("{note}")), folder }
    })
}

/// Runs the cases of a plan in the page, and returns their results. Writes the files of the scene to `folder`.
fn visit(folder: &Path, flags: &[&str], plan: &[Value], heard: &mut dyn FnMut(&str)) -> Value {
    static BUILT: OnceLock<(tempfile::TempDir, PathBuf)> = OnceLock::new();
    let (_, built) = BUILT.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let built = built(&folder.path().join("page"));
        (folder, built)
    });
    let read =
        |path: PathBuf| std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    // The console's errors are kept from the first script on, and devices, so that they can be lost. Whoever reads the canvas is
    // told of commands.
    let hook = "<script>window.said = []; window.devices = []; for (const kind of ['error', 'warn']) { const own = console[kind]; \
        console[kind] = (...all) => { window.said.push(kind + ': ' + all.join(' ')); own(...all); }; } \
        window.addEventListener('error', (event) => window.said.push('error: ' + event.message)); \
        const own = GPUAdapter.prototype.requestDevice; GPUAdapter.prototype.requestDevice = async function (...all) { \
        const device = await own.apply(this, all); window.devices.push(device); return device; }; \
        const submit = GPUQueue.prototype.submit; GPUQueue.prototype.submit = function (...all) { \
        submit.apply(this, all); if (window.submitted) window.submitted(); }; \
        window.saved = []; HTMLAnchorElement.prototype.click = function () { window.saved.push(this.download); }; \
        navigator.clipboard.writeText = async (text) => { window.saved.push(text); };</script>\n";
    let index = include_str!("../../../relievo-viewer/web/index.html");
    let index = index.replacen("<script type=\"module\">", &format!("{hook}<script type=\"module\">"), 1);
    let [rock, creature] = packages();
    std::fs::write(folder.join("rock.rlv"), rock).expect("written");
    std::fs::write(folder.join("scene.json"), SCENE).expect("written");
    let (script, program) = (read(built.join("viewer.js")), read(built.join("viewer_bg.wasm")));
    let mistake = SCENE.replace("\"seed\": \"page\"", "\"seed\": 7");
    let plan = serde_json::to_vec(plan).expect("JSON");
    let rock_file = relievo_samples::rock().expect("built in").to_glb().expect("written");
    let images = images::files();
    for (name, bytes) in &images {
        std::fs::write(folder.join(name), bytes).expect("written");
    }
    let addresses = images.iter().map(|(name, bytes)| (format!("/{name}"), bytes.as_slice()));
    let addresses: Vec<_> = addresses.collect();
    let mut files = vec![
        ("/", include_bytes!("page.html").as_slice()),
        ("/plan.json", plan.as_slice()),
        ("/viewer/index.html", index.as_bytes()),
        ("/viewer/viewer.js", script.as_slice()),
        ("/viewer/viewer_bg.wasm", program.as_slice()),
        ("/viewer/creature.rlv", creature.as_slice()),
        ("/scene.json", SCENE.as_bytes()),
        ("/mistake.json", mistake.as_bytes()),
        ("/rock.rlv", rock.as_slice()),
        ("/rock.glb", rock_file.as_slice()),
        ("/corner.obj", CORNER.as_bytes()),
        ("/land.json", LAND.as_bytes()),
        ("/dropped.json", DROPPED.as_bytes()),
        ("/typed.gltf", TYPED.as_bytes()),
    ];
    files.extend(addresses.iter().map(|(address, bytes)| (address.as_str(), *bytes)));
    let browser = browser::program().expect("the suite needs a browser");
    let start = Instant::now();
    let said = browser::visit_heard(&browser, flags, &files, Duration::from_secs(1200), heard);
    println!("the page took {:.1} s", start.elapsed().as_secs_f32());
    said.expect("a result")
}

/// The folder of a page that is built.
fn built(folder: &Path) -> PathBuf {
    if let Some(built) = std::env::var_os(BUILT) {
        return built.into();
    }
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("web");
    let program = Program { package: "relievo-page", library: "viewer", profile: "dev", target: &target };
    std::fs::create_dir_all(folder).expect("writable");
    program.build(folder).expect("the page compiles for browsers");
    folder.to_owned()
}

fn case(name: &str) -> &'static Value {
    let said = match name {
        "double" => &double().said,
        "controls" => &moved().said,
        _ => &page().said,
    };
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let all = said.as_array().expect("cases");
    all.iter().find(|case| case["name"] == name).unwrap_or_else(|| panic!("no case {name}"))
}

/// The picture of the scene, cut out of what the canvas shows.
fn picture(shown: &Value, size: &Value) -> RgbaImage {
    let data = shown["data"].as_str().expect("pixels");
    let bytes = base64::prelude::BASE64_STANDARD.decode(data).expect("base64");
    let [width, height] = ["width", "height"].map(|edge| shown[edge].as_u64().expect("a number") as u32);
    let canvas = RgbaImage::from_raw(width, height, bytes).expect("whole");
    let [width, height] = [0, 1].map(|edge| size[edge].as_u64().expect("a number") as u32);
    crop_imm(&canvas, 0, 0, width, height).to_image()
}

/// The program in a folder, on Chromium's software adapter.
fn swiftshader(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_relievo"));
    command
        .current_dir(folder)
        .env("VK_ICD_FILENAMES", "/usr/lib/chromium/vk_swiftshader_icd.json")
        .env("RELIEVO_ADAPTER", "swiftshader");
    command
}

/// A scene, drawn natively on Chromium's software adapter.
fn native(folder: &Path, scene: &str, size: [u32; 2]) -> RgbaImage {
    let out = folder.join(format!("native-{}-{}.png", scene.replace('/', "-"), size[0]));
    let size = format!("{}x{}", size[0], size[1]);
    let output = swiftshader(folder)
        .args(["view", scene, "--time", "0", "--size", &size, "--picture"])
        .arg(&out)
        .output()
        .expect("started");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    relievo_testing::picture(out).into_rgba8()
}

/// Compares a case's picture of a scene with the native one. Both are kept in the folder of the suite.
fn is_native(name: &str, scene: &str, page: &Page, ratio: f64) {
    let case = case(name);
    assert_eq!(case["ratio"], ratio, "{name}");
    let shown = picture(&case["picture"], &case["done"]["picture"]);
    let drawn = native(page.folder.path(), scene, [shown.width(), shown.height()]);
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (whose, picture) in [("page", &shown), ("native", &drawn)] {
        picture.save(kept.join(format!("{whose}-{name}.png"))).expect("written");
    }
    let difference = Difference::of(&shown, &drawn, 3);
    println!(
        "{name}: first picture after {} s; read after {} tries; {difference:?}",
        case["first"], case["picture"]["tries"]
    );
    assert!(difference.flip <= MOST_FLIP, "{name}: {difference:?}");
    // A comparison that cannot fail is worse than none.
    let mirrored = image::imageops::flip_horizontal(&shown);
    assert!(Difference::of(&mirrored, &drawn, 3).flip > MOST_FLIP);
}

#[test]
fn the_picture_of_the_page_is_the_native_one() {
    for name in ["large", "small"] {
        is_native(name, "scene.json", page(), 1.0);
    }
}

#[test]
fn the_picture_of_the_page_is_the_native_one_at_a_pixel_ratio_of_two() {
    is_native("double", "scene.json", double(), 2.0);
}

#[test]
fn images_that_the_browser_decodes_are_the_native_ones() {
    is_native("photos", "photos.json", page(), 1.0);
    is_native("photos of a server", "served/photos.json", page(), 1.0);
}

#[test]
fn the_console_has_no_errors() {
    for name in ["large", "small", "own", "streamed", "experiment", "double"] {
        let said = case(name)["said"].as_array().expect("a list");
        let errors: Vec<_> =
            said.iter().filter_map(Value::as_str).filter(|line| line.starts_with("error")).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    }
}

#[test]
fn keys_reach_the_page() {
    let case = case("large");
    let [before, after] =
        [&case["picture"], &case["after"]["picture"]].map(|shown| picture(shown, &case["done"]["picture"]));
    let levels = Difference::of(&after, &before, 6);
    assert!(levels.outliers > 0.05, "the rocks in the colours of their levels: {levels:?}");
}

#[test]
fn a_page_without_an_address_shows_its_own_scene() {
    let case = case("own");
    assert_eq!(case["state"]["scene"], "start.json");
    assert!(case["state"]["frames"].as_u64().is_some_and(|frames| frames > 0), "{}", case["state"]);
    println!(
        "first picture of the page's own scene after {} s, {} bytes",
        case["first"], case["state"]["first_bytes"]
    );
}

#[test]
fn two_pages_at_once_do_not_change_each_other() {
    let [large, small] = ["large", "small"].map(case);
    let again = |case: &Value| picture(&case["last"]["picture"], &case["done"]["picture"]);
    let levels = picture(&large["after"]["picture"], &large["done"]["picture"]);
    let still = Difference::of(&again(large), &levels, 6);
    assert!(still.outliers < 0.001, "the larger one has the colours of levels: {still:?}");
    let still = Difference::of(&again(small), &picture(&small["picture"], &small["done"]["picture"]), 6);
    assert!(still.outliers < 0.001, "the smaller one has none: {still:?}");
}

#[test]
fn a_lost_device_is_replaced() {
    let case = case("small");
    assert_eq!(case["recovered"]["devices"], 2);
    let [before, after] = [&case["picture"], &case["recovered"]["picture"]]
        .map(|shown| picture(shown, &case["done"]["picture"]));
    let difference = Difference::of(&after, &before, 6);
    assert!(difference.outliers < 0.001, "{difference:?}");
    assert!(case["recovered"]["state"]["notice"].is_null(), "{}", case["recovered"]["state"]);
}

#[test]
fn a_scene_of_a_server_comes_coarsest_first_over_two_megabits() {
    let case = case("streamed");
    let seen = case["watched"]["seen"].as_array().expect("levels");
    let numbers: Vec<u64> = seen.iter().filter_map(|seen| seen[0].as_u64()).collect();
    assert!(numbers.len() >= 4 && numbers.is_sorted(), "{seen:?}");
    let [first, all] = ["first_bytes", "bytes"].map(|name| case["done"][name].as_f64().expect("a number"));
    println!("first picture after {first} of {all} bytes, {} s", case["first"]);
    assert!(4.0 * first < all, "first picture after {first} of {all} bytes");
    let covered = covered(&picture(&case["picture"], &case["done"]["picture"]));
    assert!(covered > 0.05, "{covered} of the picture");
}

/// The fraction of a picture that is not the background.
fn covered(picture: &RgbaImage) -> f64 {
    let differs = picture.pixels().filter(|pixel| *pixel != picture.get_pixel(2, 2)).count();
    differs as f64 / picture.pixels().len() as f64
}

#[test]
fn every_kind_of_file_opens_in_the_page() {
    // Scenes and packages are those of other tests.
    for name in ["rock.glb", "corner.obj", "land.json"] {
        let case = case(name);
        assert_eq!(case["done"]["scene"], name);
        assert!(case["done"]["notice"].is_null(), "{}", case["done"]);
        let covered = covered(&picture(&case["picture"], &case["done"]["picture"]));
        assert!((0.04..0.999).contains(&covered), "{name}: {covered} of the picture");
    }
}

#[test]
fn the_page_takes_any_size() {
    let resized = &case("rock.glb")["resized"];
    let shown = picture(&resized["picture"], &resized["state"]["picture"]);
    assert_eq!(shown.width(), 250);
    assert!(covered(&shown) > 0.04);
}

#[test]
fn files_that_are_dropped_onto_the_page_open_together() {
    let dropped = &case("corner.obj")["dropped"];
    assert!(dropped["state"]["notice"].is_null(), "{}", dropped["state"]);
    assert_eq!(dropped["state"]["triangles"], 4.0, "the model beside the scene: {}", dropped["state"]);
    let covered = covered(&picture(&dropped["picture"], &dropped["state"]["picture"]));
    assert!((0.02..0.9).contains(&covered), "{covered} of the picture");
}

#[test]
fn keys_alone_move_a_slider_of_the_page() {
    let slid = &case("panel")["slid"];
    println!("after {} keys: {slid}", slid["keys"]);
    assert!(slid["after"].as_f64() > slid["before"].as_f64(), "{slid}");
}

/// Each step changes what the controls of the page say as it changes those of a viewer without a window.
#[test]
fn every_control_of_the_page_does_what_it_does_natively() {
    let case = case("controls");
    let moved = case["moved"].as_array().expect("steps");
    let mut wrong = Vec::new();
    for (step, own) in moved.iter().zip(case["steps"].as_array().expect("steps")) {
        assert_eq!(step["name"], own["name"]);
        let name = step["name"].as_str().expect("a name");
        if own["opens"].is_null() {
            let found = controls::differences(name, &step["controls"], &own["controls"]);
            wrong.extend(found.into_iter().map(|what| format!("{name}: {what}")));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    println!("{} steps", moved.len());
    let saved = moved[moved.len() - 1]["saved"].as_array().expect("a list");
    let saved: Vec<_> = saved.iter().filter_map(Value::as_str).collect();
    let command = saved.iter().find(|text| text.starts_with("http")).expect("an address was copied");
    assert!(command.contains("/viewer/index.html?scene=") && command.contains("at="), "{command}");
    for name in ["crowd.png", "crowd-view.json"] {
        assert!(saved.contains(&name), "{name} in {saved:?}");
    }
}

#[test]
fn a_server_that_dies_is_told_and_its_return_goes_on() {
    let case = case("dies");
    let waits = case["watched"]["waits"].as_str().expect("told");
    assert!(waits.contains("127.0.0.1"), "{waits}");
    let seen = case["watched"]["seen"].as_array().expect("levels");
    let dead = seen.iter().position(|seen| seen == "dead").expect("it died");
    assert!(dead + 1 < seen.len(), "nothing came after its return: {seen:?}");
    let [one, other] =
        [case, self::case("streamed")].map(|case| picture(&case["picture"], &case["done"]["picture"]));
    let difference = Difference::of(&one, &other, 6);
    assert!(difference.outliers < 0.001, "the picture is that of a server that lives: {difference:?}");
}

#[test]
fn the_experiment_of_thesis_a_runs_in_the_page() {
    // Two groups, four gates, six distances.
    assert_eq!(case("experiment")["rows"], 2 * 4 * 6);
}

/// Only the page of `make web` is small: without `RELIEVO_PAGE`, it is one that compiles quickly.
#[test]
fn the_page_is_small() {
    let Some(built) = std::env::var_os(BUILT).map(PathBuf::from) else {
        println!("not measured: {BUILT} names no page of `make web`");
        return;
    };
    let packed = ["viewer.js", "viewer_bg.wasm"].map(|name| {
        let bytes = std::fs::read(built.join(name)).expect("built");
        wasm::packed(&bytes).expect("in memory")
    });
    let packed: usize = packed.iter().sum();
    assert!(packed <= wasm::LARGEST, "{packed} bytes with brotli are more than {}", wasm::LARGEST);
}

#[test]
fn mistakes_and_missing_files_are_told() {
    let notice = |name: &str| case(name)["state"]["notice"].as_str().unwrap_or_default().to_owned();
    assert!(notice("mistake").contains("mistake.json: terrain.config.seed"), "{}", notice("mistake"));
    assert!(notice("gone").contains("404"), "{}", notice("gone"));
    // The path of the value is told natively only; the file and what is wrong are told here too.
    let typed = notice("typed");
    assert!(typed.contains("typed.gltf") && typed.contains("expected a string"), "{typed}");
}
