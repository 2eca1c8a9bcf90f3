//! `relievo crowd`

use serde_json::Value;

use crate::assert_refused;
use crate::harness::{Run, relievo};

const SMALL: [&str; 10] = [
    "--model",
    "builtin",
    "--clip",
    "walk",
    "--instances",
    "6",
    "--frames",
    "12",
    "--distance",
    "200,900,2000",
];

/// The instances and frames of these arguments.
const INSTANCES: f64 = 6.0;
const FRAMES: f64 = 12.0;

/// Runs `crowd` into the folder `out` of a folder of its own.
fn run(arguments: &[&str]) -> (Run, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out");
    (relievo(&[&["crowd", "--out", out.to_str().expect("UTF-8")], arguments].concat()), folder)
}

fn made(arguments: &[&str]) -> (Run, tempfile::TempDir) {
    let (run, folder) = run(arguments);
    assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
    (run, folder)
}

fn read(folder: &tempfile::TempDir, name: &str) -> Value {
    let text = std::fs::read(folder.path().join("out").join(name)).expect("written");
    let report = serde_json::from_slice(&text).expect("JSON");
    crate::assert_documented(&report);
    report
}

fn report(arguments: &[&str]) -> Value {
    read(&made(&[&SMALL[..], arguments].concat()).1, "report.json")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn rows(report: &Value) -> &[Value] {
    report["distances"].as_array().expect("a list")
}

const GATES: [&[&str]; 6] = [
    &["--gate", "off"],
    &["--gate", "skip-period", "--period", "0.3", "--weights", "analyze"],
    &["--gate", "uniform"],
    &["--gate", "random", "--layout", "random", "--seed", "7"],
    &["--gate", "budget", "--budget", "300"],
    &["--gate", "bounded", "--pixels", "2"],
];

/// The device decides as the references do; its other results differ only by rounding.
#[test]
fn backends_decide_alike_and_reports_add_up() {
    for gate in GATES {
        let [gpu, cpu] = ["gpu", "cpu"].map(|backend| report(&[gate, &["--backend", backend]].concat()));
        assert!(gpu["adapter"].is_string() && cpu["adapter"].is_null(), "{gate:?}");
        assert_eq!((&gpu["gate"], gpu["gate"]["mode"].as_str()), (&cpu["gate"], Some(gate[1])));
        assert_eq!((&gpu["bones"], rows(&gpu).len(), rows(&cpu).len()), (&Value::from(153), 3, 3));
        let moving = number(&gpu["animated_bones"]) * INSTANCES * FRAMES;
        for (row, reference) in rows(&gpu).iter().zip(rows(&cpu)) {
            for field in ["interpolated", "concatenated", "mean_omega", "skipped"] {
                assert_eq!(row[field], reference[field], "{gate:?} {field} at {}", row["distance"]);
            }
            let done = number(&row["interpolated"]);
            assert_eq!(done + number(&row["skipped"]), moving, "{gate:?}");
            assert!((number(&row["fraction"]) - done / moving).abs() < 1e-12);
            let [a, b] = [row, reference].map(|row| &row["error"]);
            let [rms, p99, max] = ["rms_pixels", "p99_pixels", "max_pixels"]
                .map(|field| (number(&a[field]), number(&b[field])));
            for (gpu, cpu) in [rms, p99, max] {
                assert!((gpu - cpu).abs() <= 0.02 * cpu + 1e-3, "{gate:?}: {gpu} and {cpu} pixels");
            }
            assert!(rms.0 <= max.0 && p99.0 <= max.0);
            assert_eq!((number(&a["points"]), number(&a["unseen"])), (INSTANCES * FRAMES * 153.0 * 6.0, 0.0));
            for stage in ["gate", "sample", "local_to_model", "total"] {
                assert!(number(&row["nanoseconds_per_bone"][stage]) > 0.0, "{gate:?} {stage}");
            }
            assert!(number(&reference["full_nanoseconds_per_bone"]["total"]) > 0.0);
        }
    }
}

/// Near the camera everything is interpolated, and beyond the range nothing; `bounded` keeps its error bound.
#[test]
fn gates_save_and_err_as_they_say() {
    let cpu = |gate: &[&str]| report(&[gate, &["--backend", "cpu"]].concat());
    let off = cpu(GATES[0]);
    for row in rows(&off) {
        assert_eq!((number(&row["fraction"]), number(&row["error"]["max_metres"])), (1.0, 0.0));
        assert_eq!(number(&row["jump"]["max_pixels"]), 0.0);
    }
    let uniform = cpu(GATES[2]);
    let [near, middle, far] = rows(&uniform) else { panic!("three distances") };
    assert!(number(&near["fraction"]) > number(&middle["fraction"]) && number(&middle["fraction"]) > 0.2);
    assert_eq!((number(&far["fraction"]), number(&far["concatenated"])), (0.0, 0.0));
    assert!(number(&far["error"]["max_metres"]) > 0.1 && number(&far["jump"]["max_metres"]) > 0.01);
    let budget = cpu(GATES[4]);
    assert!(rows(&budget).iter().all(|row| number(&row["interpolated"]) == 300.0 * FRAMES));
    let bounded = cpu(GATES[5]);
    for row in rows(&bounded) {
        let worst = number(&row["error"]["max_pixels"]);
        assert!(worst <= 2.01 && number(&row["fraction"]) < 1.0, "{row}");
    }
    assert!(number(&rows(&bounded)[2]["error"]["max_pixels"]) > 0.3, "far too careful");
}

#[test]
fn plots_and_a_table_come_with_it() {
    let (run, folder) = made(&[&SMALL[..], GATES[5], &["--backend", "cpu"]].concat());
    for plot in ["cost.png", "interpolations.png", "error.png"] {
        assert!(relievo_testing::picture(folder.path().join("out").join(plot)).width() >= 600, "{plot}");
    }
    assert_eq!(run.stdout.lines().filter(|line| line.starts_with("| ")).count(), 4, "{}", run.stdout);
}

#[test]
fn pareto_compares_every_gate() {
    let small = ["--model", "builtin", "--clip", "1", "--instances", "2", "--frames", "12", "--pareto"];
    let (run, folder) = made(&small);
    let json = read(&folder, "pareto.json");
    let points = json["points"].as_array().expect("a list");
    for gate in ["bounded", "budget", "uniform", "random", "skip-period"] {
        let own: Vec<_> = points.iter().filter(|point| point["gate"] == gate).collect();
        assert!(own.len() > 10 && run.stdout.contains(&format!("| {gate} |")), "{gate}");
        for field in ["parameter", "cost", "rms_pixels", "p99_pixels", "max_pixels", "max_metres"] {
            assert!(own.iter().all(|point| number(&point[field]) >= 0.0), "{gate} {field}");
        }
        let costs = || own.iter().map(|point| number(&point["cost"]));
        assert!(costs().fold(1.0, f64::min) < 0.3 && costs().fold(0.0, f64::max) > 0.6, "{gate}");
    }
    for list in ["bounded_max_pixels", "budget_rms_pixels", "bounded_cost"] {
        assert!(!json["comparisons"][list].as_array().expect("a list").is_empty(), "{list}");
    }
    for plot in ["pareto_max.png", "pareto_rms.png"] {
        assert!(relievo_testing::picture(folder.path().join("out").join(plot)).width() >= 600, "{plot}");
    }
    assert!(run.stdout.contains("At equal cost"), "{}", run.stdout);
}

#[test]
fn bad_input_is_refused_and_nothing_written() {
    let model = ["--model", "builtin", "--clip", "walk"];
    for (arguments, words) in [
        (&[][..], &["--gate"][..]),
        (&["--gate", "magic"], &["magic", "bounded"]),
        (&["--gate", "budget"], &["budget", "must be"]),
        (&["--gate", "uniform", "--budget", "9"], &["budget", "must come with --gate budget"]),
        (&["--gate", "off", "--range", "1700,200"], &["range.max", "200", "above range.min, 1700"]),
        (&["--gate", "off", "--range", "5,5"], &["range.max", "5"]),
        (&["--gate", "off", "--range", "-1,5"], &["range.min", "-1"]),
        (&["--gate", "off", "--range", "5"], &["range", "5", "two"]),
        (&["--gate", "off", "--distance", "200,-3"], &["distance", "-3", "1..="]),
        (&["--gate", "off", "--distance", "near"], &["distance", "near", "numbers"]),
        (&["--gate", "off", "--distance", "nan"], &["distance", "NaN"]),
        (&["--gate", "off", "--instances", "0"], &["instances", "0", "1..="]),
        (&["--gate", "off", "--frames", "0"], &["frames", "0"]),
        (&["--gate", "off", "--rate", "0"], &["rate", "0"]),
        (&["--gate", "off", "--size", "inf"], &["size", "inf"]),
        (&["--gate", "off", "--spacing", "-1"], &["spacing", "-1"]),
        (&["--gate", "bounded", "--pixels", "-1"], &["pixels", "-1"]),
        (&["--gate", "skip-period", "--period", "-1"], &["period", "-1"]),
        (&["--gate", "skip-period", "--weights", "1,2"], &["weights", "1,2"]),
        (&["--gate", "off", "--layout", "ring"], &["ring", "grid"]),
        (&["--pareto", "--gate", "off"], &["--pareto", "--gate"]),
        (&["--pareto", "--tall", "0"], &["tall", "0"]),
    ] {
        let (run, folder) = run(&[&model[..], arguments].concat());
        assert_refused(&run, arguments, words);
        assert!(
            !folder.path().join("out").exists() && run.stdout.is_empty(),
            "{arguments:?} wrote something"
        );
    }
    let (run, _folder) = run(&["--model", "builtin", "--clip", "run", "--gate", "off"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("clip = run"), "{}", run.stderr);
}
