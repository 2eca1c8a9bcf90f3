//! Pictures against `goldens/`: everything that `relievo demo` draws, made by the program itself.
#![cfg(all(feature = "gpu", feature = "cli"))]

#[path = "../harness/mod.rs"]
mod harness;

mod characters;
mod cracks;
mod culled;
mod curved;
mod faults;
mod figure;
#[allow(dead_code, reason = "only some of it is needed here")]
#[path = "../animation/scene.rs"]
mod gltf;
mod ground;
mod materials;
mod scene_file;
mod shadows;
mod skinned;
mod stage;
mod tiling;

use harness::{Tolerance, check_golden, relievo};

/// The pictures of B's figures, of seamless grids, of both weight modes, and of every kind of relief.
const VIEWS: &[&str] = &[
    "textured",
    "grid",
    "mountains",
    "wireframe",
    "step_1",
    "step_2",
    "step_5",
    "valley_1",
    "valley_2",
    "valley_3",
    "additive",
    "thermal",
    "uneroded",
    "eroded",
    "blend",
    "relief_bricks",
    "relief_close_plain",
    "relief_close_parallax",
    "relief_close_relief",
    "relief_text",
    "relief_posts_lost",
    "relief_posts_cone",
    "relief_cobbles",
    "relief_grazing",
    "relief_clamp",
];

/// Maps have one pixel per sample; these are the maps that fit the size of a golden.
const MAPS: &[&str] = &["step_5_map", "valley_1_map"];

#[test]
fn the_demo_equals_its_goldens() {
    harness::gpu();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().to_str().expect("UTF-8");
    let run = relievo(&["demo", "--out", out, "--size", "176x112"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let wrong: Vec<_> = (VIEWS.iter().chain(MAPS))
        .filter_map(|name| {
            let actual = image::open(folder.path().join(format!("{name}.png")))
                .expect("the demo drew it")
                .into_rgba8();
            match check_golden(name, &actual, Tolerance::IMAGE) {
                Ok(difference) => {
                    println!("{name}: {difference:?}");
                    None
                }
                Err(error) => Some(error),
            }
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let page = std::fs::read_to_string(folder.path().join("index.html")).expect("the demo wrote it");
    assert!(VIEWS.iter().all(|name| page.contains(&format!("{name}.png"))), "index.html lacks a picture");
}

/// Erosion that is missing is missed: the picture before it is none that passes for the one after it.
#[test]
fn missing_erosion_is_seen() {
    let golden = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens").join(name);
        image::open(path).expect("a golden").into_rgba8()
    };
    let [before, after] = ["uneroded.png", "eroded.png"].map(golden);
    let found = harness::Difference::of(&before, &after, Tolerance::IMAGE.levels);
    println!("{found:?}");
    assert!(!found.within(Tolerance::IMAGE), "{found:?}");
}
