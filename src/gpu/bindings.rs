//! Override constants and bind groups of every shader, by name and type. `build.rs` writes them from the
//! composed WGSL: a missing buffer, or one of another element type, does not compile.
#![allow(dead_code, clippy::derivable_impls, reason = "generated for every shader alike")]

include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
