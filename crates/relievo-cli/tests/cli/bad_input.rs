//! Bad input: exit code 2, one clear line, nothing written.

use std::path::Path;

use crate::harness::relievo;
use crate::terrain::Bench;

const GOOD: &str = r#"{"patchSize": 33, "scaleFactor": 40.0, "seed": "any text"}"#;

/// Runs `terrain` and checks that it is refused with one line that contains all of `words`.
fn refused(config: &str, arguments: &[&str], words: &[&str]) {
    let bench = Bench::new(config);
    std::fs::write(bench.path("f.json"), FEATURES).expect("writable");
    std::fs::write(bench.path("twice.json"), TWICE).expect("writable");
    std::fs::write(bench.path("outside.json"), OUTSIDE).expect("writable");
    std::fs::write(bench.path("odd.json"), ODD).expect("writable");
    image::RgbImage::new(4, 4).save(bench.path("rgb.png")).expect("writable");
    let (config, out) = (bench.path("config.json"), bench.path("out"));
    let mut all: Vec<String> = ["terrain", "--config", &config, "--out", &out].map(str::to_owned).to_vec();
    // `@name` stands for a file of the folder.
    all.extend(
        arguments.iter().map(|word| word.strip_prefix('@').map_or(word.to_string(), |name| bench.path(name))),
    );
    let run = relievo(&all.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(run.code, Some(2), "{all:?}: {}", run.stderr);
    assert_eq!(run.stderr.trim().lines().count(), 1, "{all:?}: {}", run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "{all:?}: `{word}` is not in: {}", run.stderr);
    }
    assert!(!Path::new(&out).exists(), "{all:?} wrote something");
    assert!(run.stdout.is_empty(), "{}", run.stdout);
}

const FEATURES: &str = r#"{"patchCoordinates": [0, 0], "precomputedHeights": [1, 2, 3]}"#;
const TWICE: &str = r#"{"patchCoordinates": [0, 0], "precomputedHeights": [1, 2, 3, 1, 2, 4]}"#;
const OUTSIDE: &str = r#"{"patchCoordinates": [0, 0], "precomputedHeights": [33, 0, 1]}"#;
const ODD: &str = r#"{"patchCoordinates": [0, 0], "precomputedHeights": [1, 0]}"#;

#[test]
fn configurations() {
    let with = |field: &str| GOOD.replace('}', &format!(", {field}}}"));
    refused(&GOOD.replace("33", "32"), &[], &["patchSize", "32", "2^n + 1"]);
    refused(&GOOD.replace("40.0", "-1"), &[], &["scaleFactor", "-1", "≥ 0"]);
    refused(&GOOD.replace("40.0", "1e999"), &[], &["config"]);
    refused(&GOOD.replace("40.0", "20000"), &[], &["scaleFactor", "20000", "16383.99998"]);
    refused(&with(r#""roughness": -0.5"#), &[], &["roughness", "-0.5"]);
    refused(&with(r#""coarseLevels": 9"#), &[], &["coarseLevels", "9", "0..=8"]);
    refused(&with(r#""border": "foo""#), &[], &["border"]);
    refused(&with(r#""border": {"blend": 99}"#), &[], &["border.blend", "99"]);
    refused(&with(r#""corners": [1, 2, 3, 4]"#), &[], &["corners", "wrap"]);
    refused(&with(r#""zones": [{"min": 3, "max": 1}]"#), &[], &["zones[0].max", "1", "above"]);
    refused(&with(r#""zones": []"#), &[], &["zones"]);
    refused(&with(r#""zones": [{"min": 0, "max": 1, "texture": "nowhere.png"}]"#), &[], &["nowhere.png"]);
    refused(&with(r#""typo": 1"#), &[], &["typo"]);
    refused("not JSON", &[], &["config"]);
    refused("", &[], &["config"]);
}

#[test]
fn targets() {
    let other = |from: &str, to: &str| GOOD.replace(from, to);
    let with = |target: &str, more: &[&str], words: &[&str]| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("target.json");
        std::fs::write(&path, target).expect("writable");
        let all = [&["--target", path.to_str().expect("UTF-8")], more].concat();
        refused(GOOD, &all, words);
    };
    with(&other("33", "65"), &[], &["target.json", "patchSize", "65", "must be 33"]);
    with(
        &GOOD.replace('}', r#", "terrainScale": 2}"#),
        &[],
        &["target.json", "terrainScale", "2", "must be 1"],
    );
    with(&other("40.0", "-1"), &[], &["target.json", "scaleFactor", "-1"]);
    with(GOOD, &["--time", "1.5"], &["time", "1.5", "0..=1"]);
    with(GOOD, &["--time", "-0.1"], &["time", "-0.1", "0..=1"]);
    with(GOOD, &["--time", "NaN"], &["time", "NaN", "0..=1"]);
    with(GOOD, &["--frames", "1"], &["--frames", "1", "2..=10000"]);
    with(GOOD, &["--frames", "10001"], &["--frames", "10001", "2..=10000"]);
    with(GOOD, &["--frames", "2", "--time", "1.5"], &["time", "1.5", "0..=1"]);
    refused(GOOD, &["--frames", "2"], &["--target"]);
    refused(GOOD, &["--target", "nowhere.json"], &["nowhere.json"]);
}

#[test]
fn files() {
    refused(GOOD, &["--features", "@missing.json"], &["missing.json"]);
    refused(GOOD, &["--features", "@twice.json"], &["twice.json", "precomputedHeights[5]", "already"]);
    refused(GOOD, &["--features", "@outside.json"], &["precomputedHeights[0]", "33"]);
    refused(GOOD, &["--features", "@odd.json"], &["multiple of 3"]);
    refused(GOOD, &["--heights-from", "@rgb.png", "--every", "2"], &["rgb.png", "16-bit"]);
    refused(GOOD, &["--heights-from", "@f.json", "--every", "2"], &["f.json"]);
}

#[test]
fn arguments() {
    refused(GOOD, &["--patches", "0x2"], &["patches", "0x2"]);
    refused(GOOD, &["--patches", "three"], &["patches", "three"]);
    refused(GOOD, &["--patches", "4000000x4000000"], &["patches", "memory"]);
    refused(GOOD, &["--patches", "100000x100000"], &["patches", "GiB"]);
    refused(GOOD, &["--origin", "1"], &["origin"]);
    refused(GOOD, &["--origin", "600000,0"], &["patchCoordinates[0]", "600000", "i32"]);
    refused(GOOD, &["--origin", "2147483647,0", "--patches", "2x1"], &["2147483647"]);
    refused(GOOD, &["--size", "0x5"], &["size", "0x5"]);
    refused(GOOD, &["--size", "9000x5"], &["size", "4096"]);
    refused(GOOD, &["--thermal", "5000"], &["thermal", "5000", "1024"]);
    refused(GOOD, &["--thermal", "5", "--talus", "95"], &["talus", "95"]);
    refused(GOOD, &["--talus", "20"], &["talus", "20", "--thermal"]);
    refused(GOOD, &["--thermal-after", "5000"], &["thermalAfter.iterations", "5000", "1024"]);
    refused(GOOD, &["--hydraulic", "5000"], &["hydraulic.iterations", "5000", "2048"]);
    refused(GOOD, &["--hydraulic", "5", "--rain", "-1"], &["hydraulic.rain", "-1", "0..=1"]);
    refused(GOOD, &["--rain", "0.02"], &["rain", "0.02", "--hydraulic"]);
    let eroded = GOOD.replace('}', r#", "hydraulic": {"iterations": 1}}"#);
    refused(&eroded, &["--rain", "1.5"], &["hydraulic.rain", "1.5", "0..=1"]);
    refused(GOOD, &["--hydraulic", "-1"], &["--hydraulic", "'-1'"]);
    let marble = GOOD.replace('}', r#", "zones": [{"min": 0, "max": 1, "texture": "marble"}]}"#);
    refused(&marble, &[], &["marble", "zones[0].texture", "sand, grass"]);
    for (field, value, bound) in [
        ("iterations", "2049", "0..=2048"),
        ("iterations", "1.5", "whole number"),
        ("rain", "1.5", "0..=1"),
        ("evaporation", "-0.1", "0..=1"),
        ("capacity", "1025", "0..=1024"),
        ("threshold", "65537", "0..=65536"),
        ("erosion", "2", "0..=1"),
        ("deposition", "2", "0..=1"),
        ("talus", "90", "0..=89"),
        ("creep", "0.1", "0..=0.0625"),
        ("snow", "1", "unknown field"),
    ] {
        let end = format!(r#", "hydraulic": {{"{field}": {value}}}}}"#);
        let config = GOOD.trim_end().strip_suffix('}').expect("an object").to_owned() + &end;
        refused(&config, &[], &[&format!("hydraulic.{field}"), bound]);
    }
    refused(GOOD, &["--despike", "-1"], &["despike", "-1"]);
    refused(GOOD, &["--despike", "NaN"], &["despike", "NaN"]);
}

#[test]
fn a_file_in_the_place_of_the_folder_is_left_alone() {
    let bench = Bench::new(GOOD);
    std::fs::write(bench.path("out"), "mine").expect("writable");
    let run = relievo(&["terrain", "--config", &bench.path("config.json"), "--out", &bench.path("out")]);
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert_eq!(std::fs::read_to_string(bench.path("out")).expect("kept"), "mine");
}

#[test]
fn unknown_words_are_refused_by_name() {
    for (arguments, words) in [
        (&["frobnicate"][..], &["'frobnicate'"][..]),
        (&["terrain", "--frobnicate"], &["'--frobnicate'"]),
        (&["terrain", "--patchs", "1x1"], &["'--patchs' found; a similar argument exists: '--patches'"]),
        (&["terrain"], &["--config <FILE>", "--out <DIR>"]),
        (&["verify", "--only"], &["--only <STEM>"]),
        (&["terrain", "--thermal", "many"], &["'many'", "--thermal"]),
        (&["terrain", "--weights", "odd"], &["'odd'", "normalized"]),
        (&[], &["--help"]),
    ] {
        let run = relievo(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.starts_with("relievo: ") && run.stdout.is_empty(), "{}", run.stderr);
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{arguments:?}: {}", run.stderr);
    }
    let run = relievo(&["verify", "--only", "nothing/like/it"]);
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert!(run.stderr.contains("terrain/height"), "the message lists what there is: {}", run.stderr);
}

#[test]
fn an_adapter_that_does_not_exist_is_named_with_those_that_do() {
    let run = relievo(&["--adapter", "no such adapter", "info"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(
        run.stderr.contains("no such adapter") && run.stderr.contains("RELIEVO_ADAPTER"),
        "{}",
        run.stderr
    );
}

/// If an output cannot be written, the machine is at fault and not the input.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_no_bad_input() {
    let bench = Bench::new(GOOD);
    let config = bench.path("config.json");
    for arguments in [
        &["terrain", "--config", &config, "--out", "/proc/relievo/out"][..],
        &["shaders", "--out", "/proc/relievo/out"],
        &["verify", "--only", "baseline/copy", "--json", "/dev/full"],
    ] {
        let run = relievo(arguments);
        assert_eq!(run.code, Some(1), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{arguments:?}: {}", run.stderr);
    }
    assert!(!Path::new("/dev/full").is_file(), "a device was replaced by a file");
}
