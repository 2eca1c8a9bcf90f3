//! The other commands.

use serde_json::{Value, json};

use crate::harness::{all_adapters, gpu, relievo};

fn read_json(path: &std::path::Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("written")).expect("JSON")
}

#[test]
fn info_names_the_adapter_and_every_pass() {
    let run = relievo(&["info"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stdout.contains(&format!("chosen: {}", gpu().adapter())),
        "{}\n{}",
        run.stdout,
        all_adapters()
    );
    for shader in relievo::gpu::shaders::ALL {
        assert!(run.stdout.contains(shader.name), "{} is missing", shader.name);
    }
}

#[test]
fn verify_writes_every_case() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("verify.json");
    let run = relievo(&["verify", "--only", "terrain/thermal", "--json", path.to_str().expect("UTF-8")]);
    assert_eq!(run.code, Some(0), "{}\n{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("holds") && run.stdout.contains("all "), "{}", run.stdout);
    let report = read_json(&path);
    assert_eq!(report["holds"], true);
    let cases = report["cases"].as_array().expect("cases");
    // Thirteen pairs of a width and iterations, three angles, two buffers each.
    assert_eq!(cases.len(), 13 * 3 * 2);
    assert!(cases.iter().all(|case| case["stem"] == "terrain/thermal"));
    assert!(cases.iter().all(|case| case["values"].as_u64().is_some_and(|values| values > 0)));
}

#[test]
fn bench_writes_the_documented_summary() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("deep/summary.json");
    let run = relievo(&["bench", "--only", "baseline/words", "--json", path.to_str().expect("UTF-8")]);
    assert_eq!(run.code, Some(0), "{}\n{}", run.stdout, run.stderr);
    let summary = read_json(&path);
    assert!(["device", "driver", "commit"].iter().all(|field| summary[field].is_string()));
    assert!(summary["threads"].as_u64().is_some_and(|threads| threads > 0));
    let rows = summary["rows"].as_array().expect("rows");
    let backends: Vec<_> = rows.iter().map(|row| row["backend"].as_str().expect("a backend")).collect();
    assert_eq!(backends, ["gpu", "copy", "reference"]);
    for row in rows {
        assert!(["name", "case", "item", "timed_by"].iter().all(|field| row[field].is_string()), "{row}");
        let figure = |field: &str| row[field].as_f64().expect("a figure");
        assert!(figure("min") > 0.0 && figure("min") <= figure("nanoseconds"));
        assert!(figure("nanoseconds") <= figure("max") && figure("items") > 0.0 && figure("bytes") > 0.0);
    }
}

#[test]
fn shaders_are_flat_and_described() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = relievo(&["shaders", "--out", folder.path().join("wgsl").to_str().expect("UTF-8")]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let manifest = read_json(&folder.path().join("wgsl/manifest.json"));
    let entries = manifest["shaders"].as_array().expect("a list");
    assert_eq!(entries.len(), relievo::gpu::shaders::ALL.len());
    for entry in entries {
        let file = folder.path().join("wgsl").join(entry["file"].as_str().expect("a name"));
        let source = std::fs::read_to_string(file).expect("written");
        assert!(!source.contains("import ") && !source.contains("package::"), "{}", entry["name"]);
        let points = entry["entry_points"].as_array().expect("entry points");
        assert!(points.iter().all(|point| source.contains(point["name"].as_str().expect("a name"))));
        assert!(!entry["bindings"].as_array().expect("bindings").is_empty());
        let compute = points.iter().filter(|point| point["stage"] == "compute");
        compute.for_each(|point| {
            let size = point["workgroup_size"].as_array().expect("three");
            let threads = size.iter().filter_map(serde_json::Value::as_u64).product::<u64>();
            assert!(threads.is_power_of_two() && threads <= 256, "{}: {threads}", entry["name"]);
        });
    }
    let modules = manifest["modules"].as_array().expect("a list");
    assert_eq!(modules.len(), relievo::gpu::shaders::MODULES.len());
    for (module, functions) in modules.iter().zip([
        &["slerp", "inside_clip"][..],
        &["camera_allows", "instance_axes"],
        &["rows_of_dual", "placed_normal"],
        &["surface_trace", "surface_soft_shadow"],
        &["zone_blended", "slope_normal", "threefry2x32"],
    ]) {
        let file = folder.path().join("wgsl").join(module["file"].as_str().expect("a name"));
        let source = std::fs::read_to_string(file).expect("written");
        for function in functions {
            assert!(source.contains(&format!("fn {function}(")), "{module} has no {function}");
        }
        assert!(!source.contains("@binding") && !source.contains("@compute"), "{module}");
        assert!(!source.contains("\nimport "), "{module}");
    }
}

/// The manifest has what an engine without wgpu needs for layouts, buffers and pipelines.
#[test]
fn the_manifest_tells_types_defaults_offsets_and_limits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = relievo(&["shaders", "--out", folder.path().join("wgsl").to_str().expect("UTF-8")]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let manifest = read_json(&folder.path().join("wgsl/manifest.json"));
    let shader = |name: &str| {
        let shaders = manifest["shaders"].as_array().expect("a list");
        shaders.iter().find(|shader| shader["name"] == name).expect("there").clone()
    };
    let sample = shader("animation/sample");
    let splines = json!({ "name": "SPLINES", "type": "bool", "default": 1.0 });
    assert!(sample["overrides"].as_array().expect("a list").contains(&splines), "{}", sample["overrides"]);
    let params = json!({
        "group": 0, "binding": 0, "name": "params", "kind": "uniform", "type": "SampleParams", "stages": ["compute"],
    });
    assert_eq!(sample["bindings"][0], params);
    assert_eq!(sample["bindings"][3]["type"], "array<vec4<f32>>");
    let structs = sample["structs"].as_array().expect("a list");
    let layout =
        structs.iter().find(|layout| layout["name"] == "SampleParams").expect("a structure of parameters");
    assert_eq!(layout["members"][4], json!({ "name": "layers", "offset": 16, "type": "u32" }));
    let vertex = &shader("render/scene_terrain")["entry_points"][0];
    assert_eq!(vertex["inputs"][0], json!({ "location": 0, "name": "entry", "type": "u32" }));
}

#[test]
fn help_teaches() {
    for (arguments, words) in [
        (&["--help"][..], &["demo", "verify", "bench", "terrain", "shaders", "RELIEVO_ADAPTER"][..]),
        (&["pose", "--help"], &["builtin", "walk", "column by column", "--wrap"]),
        (
            &["terrain", "--help"],
            &["patchSize", "precomputedHeights", "--thermal", "--hydraulic", "map.png", "report.json"],
        ),
    ] {
        let run = relievo(arguments);
        assert_eq!(run.code, Some(0));
        assert!(words.iter().all(|word| run.stdout.contains(word)), "{}", run.stdout);
    }
}

/// `relievo info | true`
#[test]
fn a_closed_pipe_is_nothing_to_shout_about() {
    for arguments in [&["info"][..], &["--help"], &["terrain", "--help"], &["verify", "--only", "baseline"]] {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_relievo"))
            .args(arguments)
            .stdout(writer)
            .output()
            .expect("the program starts");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(output.stderr.is_empty(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
}
