//! The command line as a user runs it.
#![cfg(all(feature = "gpu", feature = "cli"))]

#[path = "../harness/mod.rs"]
mod harness;

mod bad_input;
mod collapse;
mod commands;
mod crowd;
mod crowd_drawn;
mod pose;
mod priorities;
mod relief;
mod rest;
#[allow(dead_code, reason = "only the tests of the import write GLBs")]
#[path = "../animation/scene.rs"]
mod scene;
mod skin;
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
