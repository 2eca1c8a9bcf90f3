//! Override constants and bind groups of every shader, by name and type. `relievo-shaders` generates them from the composed WGSL. A
//! program that omits a buffer, or binds a buffer of another element type, does not compile.
#![allow(dead_code, clippy::derivable_impls, reason = "generated for every shader alike")]

include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
