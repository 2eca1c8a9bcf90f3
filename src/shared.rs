//! Structs and constants that kernels and host share. `build.rs` writes them from the composed WGSL, one module
//! per file.
#![allow(dead_code, reason = "generated for every kernel alike")]

include!(concat!(env!("OUT_DIR"), "/shared.rs"));
