//! Structs and constants that kernels and host share. `relievo-shaders` generates them from the composed WGSL, one Rust module
//! per WGSL file.
#![allow(dead_code, reason = "generated for every kernel alike")]

include!(concat!(env!("OUT_DIR"), "/shared.rs"));
