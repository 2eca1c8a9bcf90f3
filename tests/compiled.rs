//! Frames compile nothing on lavapipe, which inserts the values of uniforms into a shader and compiles it again in each submission
//! where they alone decide a branch that removes most of it (`docs/drivers.md`).

use relievo_testing as harness;

use std::collections::HashSet;
use std::ops::Range;
use std::path::Path;

use harness::gpu;
use relievo_lab::measure::{Player, Rendering};
use relievo_scene_file::SceneFile;
use serde_json::{Value, json};

/// Frames after which every shader of a scene is compiled, and frames that compile none.
const WARM: usize = 4;
const FRAMES: usize = 6;

/// Size of a page of memory, in bytes.
const PAGE: usize = 4096;

/// The pages of compiled shaders in this process: memory that holds programs and is of no file.
fn compiled() -> HashSet<usize> {
    let maps = std::fs::read_to_string("/proc/self/maps").expect("Linux");
    let pages = |line: &str| -> Option<Range<usize>> {
        let fields: Vec<&str> = line.split_whitespace().collect();
        let (from, to) = fields[0].split_once('-')?;
        let [from, to] = [from, to].map(|address| usize::from_str_radix(address, 16).ok());
        (fields[1] == "r-xp" && fields.len() == 5).then_some(from? / PAGE..to? / PAGE)
    };
    maps.lines().filter_map(pages).flatten().collect()
}

/// Bytes of shaders that a scene compiles in [`FRAMES`] frames after the first [`WARM`] ones, while its time goes on.
fn compiled_later(name: &str, change: &dyn Fn(&mut Value)) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let mut scene: Value =
        serde_json::from_slice(&std::fs::read(folder.join(name)).expect("there")).expect("JSON");
    change(&mut scene);
    let file = SceneFile::from_json(&scene.to_string()).expect("valid");
    let loaded =
        file.load(&|name| std::fs::read(folder.join(name)), &relievo_samples::Samples).expect("valid");
    let rendering = Rendering { size: [160, 90], quality: loaded.file().quality(), ..Rendering::default() };
    let mut player = Player::new(loaded.build(&gpu()).expect("built"), rendering).expect("prepared");
    let mut frames = |count: usize| {
        for _ in 0..count {
            player.frame(0.05).expect("drawn");
        }
        compiled()
    };
    let before = frames(WARM);
    let after = frames(FRAMES);
    // Shaders that only loading needs may still be freed in the meantime.
    let more = PAGE * after.difference(&before).count();
    println!("{name}: {} kB, {} more in {FRAMES} frames", PAGE * before.len() / 1024, more / 1024);
    more
}

/// Meshes, characters, patches, endless terrain of noise and its relief, with a shadow and a budget.
#[test]
fn frames_of_scenes_compile_nothing() {
    if !gpu().adapter().name.contains("llvmpipe") {
        println!("other drivers do not insert uniforms");
        return;
    }
    let as_it_is = |_: &mut Value| ();
    let noise = |scene: &mut Value| {
        let config = &mut scene["terrain"]["config"];
        config["generator"] = json!("fbm");
        config["interpolation"] = json!("linear");
    };
    let plain = ["ruins.json", "priorities.json", "scree.json"];
    let mut found = plain.map(|name| (name, compiled_later(name, &as_it_is))).to_vec();
    found.push(("horizon.json", compiled_later("horizon.json", &noise)));
    assert!(found.iter().all(|(_, bytes)| *bytes == 0), "{found:?}");
}
