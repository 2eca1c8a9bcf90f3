//! The generator of shader entry points. `relievo-shaders` uses the same files for the crate's own kinds.

// `relievo-shaders` and the crate each use only some of the items.
#[allow(dead_code)]
pub(crate) mod entries;
#[allow(dead_code)]
pub(crate) mod prefix;
