//! The files in `generated/` are those that the generator writes.

use std::collections::BTreeSet;
use std::path::Path;

/// After a change of the generator, run `make shaders`.
#[test]
fn generated_files_are_those_of_the_generator() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let generated = relievo_shaders::generated(root);
    let stored: BTreeSet<String> = std::fs::read_dir(root.join("generated"))
        .expect("there")
        .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
        .collect();
    assert!(generated.len() > 50 && stored.iter().eq(generated.keys()), "{stored:?}");
    for (name, text) in generated {
        let stored = std::fs::read_to_string(root.join("generated").join(&name)).expect("there");
        assert!(stored == text, "generated/{name} is not what relievo-shaders writes");
    }
}
