//! Override constants and bind groups of every kernel, by name and type. Written by `build.rs` from the composed WGSL:
//! a buffer that is forgotten, or of another element type, does not compile.
#![allow(dead_code, clippy::derivable_impls, reason = "generated for every kernel alike")]

include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
