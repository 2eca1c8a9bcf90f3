//! `relievo sweep`

use serde_json::Value;

use crate::harness::{Run, relievo};
use crate::{assert_documented, assert_refused};

const SMALL: [&str; 14] = [
    "--model",
    "builtin",
    "--clip",
    "walk",
    "--instances",
    "4",
    "--distance",
    "150,2400",
    "--frames",
    "3",
    "--error-frames",
    "2",
    "--drawn-frames",
    "1",
];

/// Runs `sweep` into the folder `out` of a folder of its own.
fn run(arguments: &[&str]) -> (Run, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out");
    (relievo(&[&["sweep", "--out", out.to_str().expect("UTF-8")], arguments].concat()), folder)
}

fn names(folder: &tempfile::TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path().join("out")).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn the_report_is_documented_and_plotted() {
    let (run, folder) = run(&SMALL);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let all = ["error.png", "frame_rate.png", "interpolations.png", "report.json", "whole_frame_rate.png"];
    assert_eq!(names(&folder), all);
    let text = std::fs::read(folder.path().join("out/report.json")).expect("written");
    let report: Value = serde_json::from_slice(&text).expect("JSON");
    assert_documented(&report);
    let layouts = report["layouts"].as_array().expect("a list");
    assert_eq!(layouts.iter().map(|own| &own["layout"]).collect::<Vec<_>>(), ["grid", "cube"]);
    for layout in layouts {
        let rows = layout["rows"].as_array().expect("a list");
        let of = |field: &'static str| rows.iter().map(move |row| &row[field]);
        let modes = ["off", "uniform", "skip-period", "bounded"];
        assert_eq!(of("mode").collect::<Vec<_>>(), modes.repeat(2));
        let [near, far] = [150.0, 2400.0].map(|distance| [distance; 4]);
        assert_eq!(of("distance").collect::<Vec<_>>(), [near, far].concat());
        // Beyond the range nothing is interpolated.
        assert_eq!([&rows[5]["interpolated"], &rows[6]["interpolated"]], [0.0, 0.0]);
    }
    assert!(run.stdout.contains("| grid | 2400 | skip-period | 4 | 0 |"), "{}", run.stdout);
    assert!(run.stdout.contains("cube at 2400 units, bounded: "), "{}", run.stdout);
}

#[test]
fn mistakes_are_named_before_anything_is_measured() {
    for (arguments, words) in [
        (&["--spacing", "-1"][..], &["spacing", "-1", "0..=1000000"][..]),
        (&["--edge", "NaN"], &["edge", "NaN"]),
        (&["--range", "900,200"], &["range.max", "200", "above range.min"]),
        (&["--period", "0"], &["period"]),
        (&["--distance", "100,-5"], &["distances[1]", "-5"]),
        (&["--distance", "near"], &["distance", "near"]),
        (&["--weights", "1,2"], &["weights", "six numbers"]),
        (&["--clip", "fly"], &["fly", "walk"]),
        (&["--frames", "0"], &["frames", "1..=10000"]),
    ] {
        let usual = ["--model", "builtin", "--clip", "walk"];
        let kept = if arguments[0] == "--clip" { &usual[..2] } else { &usual[..] };
        let (run, folder) = run(&[kept, arguments].concat());
        assert_refused(&run, arguments, words);
        assert!(!folder.path().join("out").exists(), "{arguments:?}");
    }
}
