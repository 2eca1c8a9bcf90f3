//! The generator of shader entry points. `build.rs` uses the same files for the crate's own kinds.

// `build.rs` and the crate each use only some of the items.
#[allow(dead_code)]
#[path = "../../build/entries.rs"]
pub(crate) mod entries;
#[allow(dead_code)]
#[path = "../../build/prefix.rs"]
pub(crate) mod prefix;
