//! The viewer's page in headless Chromium: its picture beside the native one on the same software adapter, what its console says,
//! keys, mistakes, and two pages at once.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use base64::Engine as _;
use image::RgbaImage;
use image::imageops::crop_imm;
use relievo_testing::wasm::Program;
use relievo_testing::{Difference, browser};
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

/// Sizes of the frames in CSS pixels.
const SIZES: [[u32; 2]; 2] = [[480, 360], [301, 223]];

struct Page {
    /// What the page said of each case.
    said: Value,
    /// The folder of the scene and its files.
    folder: tempfile::TempDir,
}

fn page() -> &'static Page {
    static PAGE: OnceLock<Page> = OnceLock::new();
    PAGE.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let built = built(&folder.path().join("page"));
        let read = |path: PathBuf| std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        // The console's errors are kept from the first script on.
        let hook = "<script>window.said = []; for (const kind of ['error', 'warn']) { const own = console[kind]; \
            console[kind] = (...all) => { window.said.push(kind + ': ' + all.join(' ')); own(...all); }; } \
            window.addEventListener('error', (event) => window.said.push(event.message));</script>\n";
        let index = include_str!("../../../relievo-viewer/web/index.html");
        let index = index.replacen("<script type=\"module\">", &format!("{hook}<script type=\"module\">"), 1);
        let rock = relievo_samples::rock().expect("built in").into();
        let rock = relievo::ops::skinning::cook(&rock, &mut |_| std::ops::ControlFlow::Continue(()));
        let rock = rock.expect("cooked").expect("not broken off");
        std::fs::write(folder.path().join("rock.rlv"), &rock).expect("written");
        std::fs::write(folder.path().join("scene.json"), SCENE).expect("written");
        let case = |name: &str, query: &str, size: [u32; 2]| json!({ "name": name, "query": query, "size": size });
        let mut plan = vec![
            case("large", "scene=/scene.json&time=0", SIZES[0]),
            case("small", "scene=/scene.json&time=0", SIZES[1]),
            case("own", "", [320, 240]),
            case("mistake", "scene=/mistake.json", [320, 240]),
            case("gone", "scene=/there/is/no.glb", [320, 240]),
        ];
        plan[0]["key"] = json!(["KeyL", "l"]);
        plan[0]["stays"] = json!(true);
        plan[1]["stays"] = json!(true);
        // Its detail takes long on a software adapter.
        plan[2]["partial"] = json!(true);
        plan[3]["fails"] = json!(true);
        plan[4]["fails"] = json!(true);
        let plan = serde_json::to_vec(&plan).expect("JSON");
        let (script, program) = (read(built.join("viewer.js")), read(built.join("viewer_bg.wasm")));
        let mistake = SCENE.replace("\"seed\": \"page\"", "\"seed\": 7");
        let files = [
            ("/", include_bytes!("page.html").as_slice()),
            ("/plan.json", plan.as_slice()),
            ("/viewer/index.html", index.as_bytes()),
            ("/viewer/viewer.js", script.as_slice()),
            ("/viewer/viewer_bg.wasm", program.as_slice()),
            ("/scene.json", SCENE.as_bytes()),
            ("/mistake.json", mistake.as_bytes()),
            ("/rock.rlv", rock.as_slice()),
        ];
        let browser = browser::program().expect("the suite needs a browser");
        let start = Instant::now();
        let said = browser::visit(&browser, &files, Duration::from_secs(400)).expect("a result");
        println!("{} bytes of WebAssembly; the page took {:.1} s", program.len(), start.elapsed().as_secs_f32());
        Page { said, folder }
    })
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
    let said = &page().said;
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

/// The same scene, drawn natively on Chromium's software adapter.
fn native(size: [u32; 2]) -> RgbaImage {
    let folder = page().folder.path();
    let out = folder.join(format!("native-{}.png", size[0]));
    let output = Command::new(env!("CARGO_BIN_EXE_relievo"))
        .current_dir(folder)
        .args([
            "view",
            "scene.json",
            "--time",
            "0",
            "--size",
            &format!("{}x{}", size[0], size[1]),
            "--picture",
        ])
        .arg(&out)
        .env("VK_ICD_FILENAMES", "/usr/lib/chromium/vk_swiftshader_icd.json")
        .env("RELIEVO_ADAPTER", "swiftshader")
        .output()
        .expect("started");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    image::open(out).expect("a picture").into_rgba8()
}

#[test]
fn the_picture_of_the_page_is_the_native_one() {
    for name in ["large", "small"] {
        let case = case(name);
        let shown = picture(&case["picture"], &case["done"]["picture"]);
        let drawn = native([shown.width(), shown.height()]);
        let difference = Difference::of(&shown, &drawn, 3);
        println!("{name}: first picture after {} s; {difference:?}", case["first"]);
        assert!(difference.flip <= MOST_FLIP, "{name}: {difference:?}");
        // A comparison that cannot fail is worse than none.
        let mirrored = image::imageops::flip_horizontal(&shown);
        assert!(Difference::of(&mirrored, &drawn, 3).flip > MOST_FLIP);
    }
}

#[test]
fn the_console_has_no_errors() {
    for name in ["large", "small", "own"] {
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
    assert_eq!(case["state"]["scene"], "mountains.json");
    assert!(case["state"]["bytes"].as_u64().is_some_and(|bytes| bytes < 100), "{}", case["state"]);
    assert!(case["state"]["frames"].as_u64().is_some_and(|frames| frames > 0), "{}", case["state"]);
    println!("first picture of the page's own scene after {} s", case["first"]);
}

#[test]
fn mistakes_and_missing_files_are_told() {
    let notice = |name: &str| case(name)["state"]["notice"].as_str().unwrap_or_default().to_owned();
    assert!(notice("mistake").contains("mistake.json: terrain.config.seed"), "{}", notice("mistake"));
    assert!(notice("gone").contains("404"), "{}", notice("gone"));
}
