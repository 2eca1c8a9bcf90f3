//! `relievo terrain` with good input.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::harness::{relievo, relievo_with};

/// A temporary folder with a configuration in it.
pub struct Bench {
    pub folder: tempfile::TempDir,
}

impl Bench {
    pub fn new(config: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("config.json"), config).expect("writable");
        Self { folder }
    }

    pub fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().expect("UTF-8").to_owned()
    }

    /// Runs `terrain` into the folder `out`, and returns its report.
    pub fn terrain(&self, out: &str, arguments: &[&str]) -> Value {
        let (config, out) = (self.path("config.json"), self.path(out));
        let mut all = vec!["terrain", "--config", &config, "--out", &out, "--size", "64x48"];
        all.extend(arguments);
        let run = relievo(&all);
        assert_eq!(run.code, Some(0), "{all:?}: {}", run.stderr);
        report(Path::new(&out))
    }
}

fn report(out: &Path) -> Value {
    let text = std::fs::read_to_string(out.join("report.json")).expect("a report");
    serde_json::from_str(&text).expect("JSON")
}

fn hashes(report: &Value) -> Vec<&str> {
    let patches = report["patches"].as_array().expect("a list of patches");
    patches.iter().map(|patch| patch["sha256"].as_str().expect("a hash")).collect()
}

fn heights(path: PathBuf) -> Vec<i32> {
    let bytes = std::fs::read(path).expect("raw heights");
    bytes.chunks_exact(4).map(|four| i32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect()
}

const CONFIGS: &[(&str, &[&str])] = &[
    (
        r#"{"patchSize": 33, "scaleFactor": 40.0, "seed": "any text"}"#,
        &["--patches", "2x3", "--origin", "-1,5"],
    ),
    (r#"{"patchSize": 17, "scaleFactor": 9, "seed": "k", "coarseLevels": 3}"#, &["--patches", "3x2"]),
    (r#"{"patchSize": 33, "scaleFactor": 9, "seed": "p", "offset": "positive"}"#, &["--thermal", "7"]),
    (r#"{"patchSize": 33, "scaleFactor": 9, "seed": "g", "offset": "gaussian"}"#, &["--despike", "0.4"]),
    (
        r#"{"patchSize": 33, "scaleFactor": 9, "seed": "w", "border": "wrap", "corners": [1, 2, 3, 4]}"#,
        &["--patches", "2x2", "--thermal", "3", "--despike", "0.1"],
    ),
    (
        r#"{"patchSize": 33, "scaleFactor": 9, "seed": "b", "border": {"blend": 9}}"#,
        &["--patches", "3x3", "--thermal", "4", "--talus", "20"],
    ),
    (
        r#"{"patchSize": 33, "scaleFactor": 9, "seed": "h", "interpolation": "smooth",
            "hydraulic": {"rain": 0.01, "threshold": 1}, "thermal": {"iterations": 2}, "thermalAfter": {"iterations": 1}}"#,
        &["--patches", "2x2", "--origin", "-2,-1", "--hydraulic", "21", "--thermal-after", "3"],
    ),
    // An even number of cycles.
    (
        r#"{"patchSize": 33, "scaleFactor": 9, "seed": "e", "hydraulic": {"rain": 0.01}}"#,
        &["--hydraulic", "6"],
    ),
];

/// The beginning of a configuration with one zone.
const SNOW: &str = r#"{"zones": [{"min": 0, "max": 10, "texture": "snow"}], "#;

#[test]
fn both_backends_give_the_same_hashes_and_nearly_the_same_map() {
    for (at, (config, arguments)) in CONFIGS.iter().enumerate() {
        // One texture is made in less time than those of all default zones, which the first configuration has.
        let config = if at == 0 { (*config).to_owned() } else { config.replacen('{', SNOW, 1) };
        let bench = Bench::new(&config);
        let gpu = bench.terrain("gpu", arguments);
        let cpu = bench.terrain("cpu", &[arguments, ["--backend", "cpu"].as_slice()].concat());
        assert_eq!(hashes(&gpu), hashes(&cpu), "{config}");
        assert_eq!((&gpu["backend"], &cpu["backend"]), (&"gpu".into(), &"cpu".into()));
        let map = |out: &str| relievo_testing::picture(bench.path(out) + "/map.png").into_rgba8();
        let (gpu, cpu) = (map("gpu"), map("cpu"));
        let worst = gpu.iter().zip(cpu.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(gpu.dimensions() == cpu.dimensions() && worst <= Some(1), "{config}: {worst:?} levels");
    }
}

/// Arguments take the place of the configuration's fields, and the others stay.
#[test]
fn arguments_take_the_place_of_erosion_in_the_configuration() {
    let made = |erosion: &str, arguments: &[&str]| {
        let config = format!(r#"{SNOW}"patchSize": 17, "scaleFactor": 9, "seed": "h"{erosion}}}"#);
        let bench = Bench::new(&config);
        let report = bench.terrain("out", &[arguments, ["--backend", "cpu"].as_slice()].concat());
        hashes(&report).join(" ")
    };
    let rainy = r#", "hydraulic": {"iterations": 12, "rain": 0.02, "threshold": 0}"#;
    let other = r#", "hydraulic": {"iterations": 3, "rain": 0.5, "threshold": 0}"#;
    assert_eq!(made(rainy, &[]), made(other, &["--hydraulic", "12", "--rain", "0.02"]));
    assert_eq!(made(rainy, &["--hydraulic", "0"]), made("", &[]));
    assert!(made(rainy, &[]) != made(other, &["--hydraulic", "12"]));
    let slides = r#", "thermal": {"iterations": 4, "talus": 10}"#;
    assert_eq!(made(slides, &[]), made("", &["--thermal", "4", "--talus", "10"]));
    assert!(made(slides, &[]) != made(slides, &["--talus", "20"]));
    assert!(made("", &["--thermal", "4"]) != made("", &[]));
}

#[test]
fn the_report_describes_the_files() {
    use sha2::{Digest, Sha256};
    let bench = Bench::new(CONFIGS[0].0);
    let report = bench.terrain("out", &["--patches", "2x1", "--origin", "-1,4", "--obj"]);
    let low = report["height_png"]["low"].as_f64().expect("the mapping");
    let high = report["height_png"]["high"].as_f64().expect("the mapping");
    for patch in report["patches"].as_array().expect("patches") {
        let name = format!("out/heights_{}_{}", patch["px"], patch["py"]);
        let bytes = std::fs::read(bench.path(&format!("{name}.i32"))).expect("raw heights");
        assert_eq!(bytes.len(), 33 * 33 * 4);
        let hash: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(patch["sha256"], hash.as_str());
        let samples = relievo_testing::picture(bench.path(&format!("{name}.png"))).into_luma16();
        let heights = heights(bench.path(&format!("{name}.i32")).into());
        for (sample, height) in samples.pixels().zip(heights) {
            let expected = (f64::from(height) / 65_536.0 - low) / (high - low) * 65_535.0;
            assert!((f64::from(sample.0[0]) - expected).abs() <= 0.5 + 1e-6);
        }
    }
    let view = relievo_testing::picture(bench.path("out/terrain.png")).into_rgba8();
    assert_eq!(view.dimensions(), (64, 48));
    let map = relievo_testing::picture(bench.path("out/map.png"));
    assert_eq!((map.width(), map.height()), (65, 33));
    // The first column of one patch is the last of the other.
    let edge = |name: &str, x: &str| -> Vec<String> {
        let text = std::fs::read_to_string(bench.path(name)).expect("a mesh");
        text.lines().filter(|line| line.starts_with(&format!("v {x} "))).map(str::to_owned).collect()
    };
    let shared = edge("out/patch_-1_4.obj", "0");
    assert!(shared.len() == 33 && shared[0].ends_with(" 128") && shared[32].ends_with(" 160"), "{shared:?}");
    assert_eq!(shared, edge("out/patch_0_4.obj", "0"));
    assert_eq!(edge("out/patch_-1_4.obj", "-32").len(), 33);
    assert!(report["seconds"]["generate"].as_f64().is_some() && report["adapter"].is_string());
}

#[test]
fn heights_of_a_png_come_back() {
    // The second run injects every second sample that the first run exported, and keeps them to within a step
    // of the PNG.
    let bench = Bench::new(CONFIGS[0].0);
    let first = bench.terrain("first", &["--patches", "2x2"]);
    let span = first["height_png"]["high"].as_f64().expect("high")
        - first["height_png"]["low"].as_f64().expect("low");
    std::fs::write(bench.path("config.json"), r#"{"patchSize": 33, "scaleFactor": 1, "seed": "other"}"#)
        .expect("ok");
    let png = bench.path("first/heights_0_0.png");
    let second = bench.terrain("second", &["--heights-from", &png, "--every", "2"]);
    assert_eq!(second["features"], 17 * 17);
    let read = |out: &str| heights(bench.path(&format!("{out}/heights_0_0.i32")).into());
    let (first, second) = (read("first"), read("second"));
    for (y, x) in (0..33).step_by(2).flat_map(|y| (0..33).step_by(2).map(move |x| (y, x))) {
        let difference = f64::from(first[y * 33 + x] - second[y * 33 + x]).abs() / 65_536.0;
        assert!(difference <= span / 65_535.0, "({x}, {y}): {difference}");
    }
}

#[test]
fn features_are_kept_or_added() {
    let bench = Bench::new(CONFIGS[0].0);
    std::fs::write(
        bench.path("f.json"),
        r#"{"patchCoordinates": [0, 0], "precomputedHeights": [3, 4, 12.5, 32, 32, -3]}"#,
    )
    .expect("writable");
    let features = bench.path("f.json");
    bench.terrain("plain", &[]);
    bench.terrain("keep", &["--features", &features]);
    bench.terrain("add", &["--features", &features, "--feature-mode", "additive"]);
    let at = |out: &str| heights(bench.path(&format!("{out}/heights_0_0.i32")).into())[4 * 33 + 3];
    assert_eq!(at("keep"), 12 * 65_536 + 32_768);
    assert_ne!(at("add"), at("keep"));
    assert_ne!(at("plain"), at("keep"));
}

#[test]
fn the_cpu_needs_no_adapter_and_says_what_is_missing() {
    let bench = Bench::new(CONFIGS[0].0);
    let (config, out) = (bench.path("config.json"), bench.path("out"));
    let arguments = ["terrain", "--config", &config, "--backend", "cpu", "--out", &out];
    let run = relievo_with(&arguments, &[("RELIEVO_ADAPTER", "no such adapter")]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("terrain.png was not made"), "{}", run.stdout);
    let files = ["map.png", "report.json", "heights_0_0.png", "heights_0_0.i32"];
    assert!(files.iter().all(|file| Path::new(&out).join(file).exists()));
    assert!(!Path::new(&out).join("terrain.png").exists());
    let report = report(Path::new(&out));
    assert!(
        report["adapter"].is_null()
            && report["notes"][0].as_str().is_some_and(|note| note.contains("adapter"))
    );
}

#[test]
fn an_existing_folder_is_reused_and_nothing_is_left_beside_it() {
    let bench = Bench::new(CONFIGS[0].0);
    bench.terrain("out", &[]);
    bench.terrain("out", &["--patches", "1x3", "--origin", "-1,0", "--obj"]);
    let mine = ["mine.txt", "heights_0_2.png.bak", "heights_00_2.png", "heights_1.i32", "patch_x_1.obj"];
    for name in mine {
        std::fs::write(bench.path("out").to_owned() + "/" + name, "kept").expect("writable");
    }
    bench.terrain("out", &["--patches", "2x1"]);
    let mut left: Vec<_> = std::fs::read_dir(bench.path("out"))
        .expect("readable")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
        .filter(|name| !mine.contains(&name.as_str()))
        .collect();
    left.sort();
    let expected = ["heights_0_0.i32", "heights_0_0.png", "heights_1_0.i32", "heights_1_0.png"];
    assert_eq!(left[..4], expected, "heights of earlier patches are gone");
    assert_eq!(left[4..], ["map.png", "report.json", "terrain.png"]);
    for name in mine {
        let path = bench.path("out") + "/" + name;
        assert_eq!(std::fs::read_to_string(path).expect("kept"), "kept");
    }
    let names: Vec<_> = std::fs::read_dir(bench.folder.path())
        .expect("readable")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
        .collect();
    assert!(names.iter().all(|name| !name.starts_with(".relievo")), "{names:?}");
}

/// Heights between two configurations: those of either at the ends, and the same bits from both processors in between.
#[test]
fn heights_are_on_the_way_to_a_target() {
    let bench = Bench::new(CONFIGS[0].0);
    let other = r#"{"patchSize": 33, "scaleFactor": 10.0, "seed": "another", "roughness": 0.9}"#;
    std::fs::write(bench.path("target.json"), other).expect("writable");
    let target = bench.path("target.json");
    let with = |out: &str, more: &[&str]| {
        let all = [&["--patches", "2x1", "--thermal", "3"], more].concat();
        let report = bench.terrain(out, &all);
        hashes(&report).into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let from = with("from", &[]);
    assert_eq!(with("start", &["--target", &target, "--time", "0"]), from);
    let half = with("half", &["--target", &target]);
    assert_eq!(with("cpu", &["--target", &target, "--time", "0.5", "--backend", "cpu"]), half);
    let end = with("end", &["--target", &target, "--time", "1"]);
    std::fs::write(bench.path("config.json"), other).expect("writable");
    assert_eq!(with("to", &[]), end);
    let read = |out: &str| heights(bench.path(&format!("{out}/heights_1_0.i32")).into());
    let ends = read("from").into_iter().zip(read("to"));
    let middle = ends.map(|(from, to)| (i64::from(from) + i64::from(to)).div_euclid(2) as i32);
    assert!(middle.eq(read("half")), "the heights are not half way");
}

/// The pictures of the way begin with the heights of the configuration and end with those at the time that is asked for.
#[test]
fn frames_show_the_way_to_a_target() {
    let config = r#"{"patchSize": 33, "scaleFactor": 9, "seed": "a"}"#;
    let bench = Bench::new(config);
    std::fs::write(bench.path("target.json"), config.replace("\"a\"", "\"b\"")).expect("writable");
    let target = bench.path("target.json");
    let picture = |name: &str| relievo_testing::picture(bench.path(name)).into_rgba8();
    let same = |one: &str, other: &str| picture(one).as_raw() == picture(other).as_raw();
    let names = |out: &str| {
        let files = std::fs::read_dir(bench.path(out)).expect("a folder");
        let names = files.map(|file| file.expect("a file").file_name().into_string().expect("UTF-8"));
        names.filter(|name| name.starts_with("frame_") || name.starts_with("map_")).count()
    };
    let way = ["--target", target.as_str(), "--frames", "3"];
    let report = bench.terrain("way", &way);
    let times: Vec<_> = (report["frames"].as_array().expect("frames").iter())
        .map(|frame| (frame["frame"].as_u64(), frame["time"].as_f64()))
        .collect();
    assert_eq!(times, [(Some(0), Some(0.0)), (Some(1), Some(0.5)), (Some(2), Some(1.0))]);
    assert!(same("way/frame_0002.png", "way/terrain.png") && same("way/map_0002.png", "way/map.png"));
    assert!(
        !same("way/frame_0001.png", "way/terrain.png") && !same("way/frame_0001.png", "way/frame_0000.png")
    );
    bench.terrain("from", &[]);
    bench.terrain("half", &["--target", &target]);
    assert!(same("way/map_0000.png", "from/map.png") && same("way/map_0001.png", "half/map.png"));
    bench.terrain("cpu", &[&way[..], &["--time", "0.5", "--backend", "cpu"]].concat());
    let [gpu, cpu] = ["half/map.png", "cpu/map_0002.png"].map(picture);
    let worst = gpu.iter().zip(cpu.iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(1), "{worst:?} levels");
    // What an earlier run left is removed.
    assert_eq!(names("way"), 6);
    bench.terrain("way", &["--target", &target, "--frames", "2"]);
    assert_eq!(names("way"), 4);
    assert!(bench.terrain("way", &[])["frames"].as_array().is_some_and(Vec::is_empty));
    assert_eq!(names("way"), 0);
}
