//! Pictures against `goldens/`. Those of the demo are compared in `crates/relievo-cli/tests/demo.rs`.

use relievo_testing as harness;

mod characters;
mod cracks;
mod culled;
mod curved;
mod endless;
mod faults;
mod figure;
mod generators;
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

use harness::Tolerance;

/// Erosion that is missing is missed: the picture before it is none that passes for the one after it.
#[test]
fn missing_erosion_is_seen() {
    let golden = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens").join(name);
        relievo_testing::picture(path).into_rgba8()
    };
    let [before, after] = ["uneroded.png", "eroded.png"].map(golden);
    let found = harness::Difference::of(&before, &after, Tolerance::IMAGE.levels);
    println!("{found:?}");
    assert!(!found.within(Tolerance::IMAGE), "{found:?}");
}
