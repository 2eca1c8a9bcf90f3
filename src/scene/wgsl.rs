//! The generator of entry points, which `build.rs` uses for the crate's own kinds.

// Both users leave out some of the items.
#[allow(dead_code)]
#[path = "../../build/entries.rs"]
pub(crate) mod entries;
#[allow(dead_code)]
#[path = "../../build/prefix.rs"]
pub(crate) mod prefix;
