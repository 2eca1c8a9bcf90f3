//! The command line as a user runs it.

#[path = "../program/mod.rs"]
mod harness;

mod bad_input;
mod collapse;
mod commands;
mod cook;
mod crowd;
mod crowd_drawn;
mod pose;
mod priorities;
mod relief;
mod rest;
#[allow(dead_code, reason = "only the tests of the import write GLBs")]
#[path = "../../../../tests/animation/scene.rs"]
mod scene;
mod scene_file;
mod scene_levels;
mod scene_mistakes;
mod serve;
mod simplify;
mod skin;
mod sweep;
mod terrain;

use serde_json::json;

/// Checks that the input was refused: exit code 2, one line that contains these words, and nothing on
/// standard output.
fn assert_refused(run: &harness::Run, arguments: &[&str], words: &[&str]) {
    let found = (run.code, run.stderr.trim().lines().count());
    assert_eq!(found, (Some(2), 1), "{arguments:?}: {}", run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "{arguments:?}: `{word}` is not in: {}", run.stderr);
    }
    assert!(run.stdout.is_empty(), "{arguments:?}: {}", run.stdout);
}

/// Checks that `docs/reports.md` names every field of a report of `relievo crowd` or `relievo sweep`.
fn assert_documented(report: &serde_json::Value) {
    match report {
        serde_json::Value::Object(fields) => {
            for (name, value) in fields {
                let own = name.strip_prefix("full_").unwrap_or(name);
                let is_named = [name, own]
                    .iter()
                    .any(|name| include_str!("../../../../docs/reports.md").contains(&format!("`{name}`")));
                assert!(is_named, "docs/reports.md lacks `{name}`");
                assert_documented(value);
            }
        }
        serde_json::Value::Array(entries) => entries.iter().for_each(assert_documented),
        _ => {}
    }
}

#[test]
#[should_panic(expected = "lacks `steps`")]
fn a_field_that_is_not_documented_is_found() {
    assert_documented(
        &json!({"distances": [{"distance": 1.0, "full_frame_nanoseconds": 2.0}, {"steps": 3}]}),
    );
}

/// A clip of two seconds that raises node 1 from 1 to `height`, and morphs the mesh of node 2 from its shape to its target.
fn push_raised_and_morphed(scene: &mut scene::Scene, height: f32) {
    let times = scene.floats("SCALAR", &[0.0, 2.0]);
    let heights = scene.floats("VEC3", &[0.0, 1.0, 0.0, 0.0, height, 0.0]);
    let weights = scene.floats("SCALAR", &[0.0, 1.0]);
    scene.push(
        "animations",
        json!({
            "samplers": [{"input": times, "output": heights}, {"input": times, "output": weights}],
            "channels": [
                {"sampler": 0, "target": {"node": 1, "path": "translation"}},
                {"sampler": 1, "target": {"node": 2, "path": "weights"}},
            ],
        }),
    );
}
