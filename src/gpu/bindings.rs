//! Override constants and bind groups of every kernel, by name and type. Written by `build.rs` from the composed WGSL:
//! a buffer that is forgotten, or of another element type, does not compile.
#![allow(dead_code)]

include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
