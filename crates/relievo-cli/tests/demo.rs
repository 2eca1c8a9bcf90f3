//! Pictures against `goldens/`: everything that `relievo demo` draws, made by the program itself.

#[path = "program/mod.rs"]
mod program;

use program::relievo;
use relievo_testing::{DEMO_MAPS, DEMO_VIEWS, Tolerance, check_golden};

#[test]
fn the_demo_equals_its_goldens() {
    relievo_testing::gpu();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().to_str().expect("UTF-8");
    let run = relievo(&["demo", "--out", out, "--size", "176x112"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let wrong: Vec<_> = (DEMO_VIEWS.iter().chain(DEMO_MAPS))
        .filter_map(|name| {
            let actual = relievo_testing::picture(folder.path().join(format!("{name}.png"))).into_rgba8();
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
    assert!(
        DEMO_VIEWS.iter().all(|name| page.contains(&format!("{name}.png"))),
        "index.html lacks a picture"
    );
    assert!(page.contains("relievo view ruins.json") && page.contains("?scene=scenes/ruins.json"));
}
