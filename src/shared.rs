//! Structs and constants that kernels and host share. Written by `build.rs` from the composed WGSL, a module a file.
#![allow(dead_code, reason = "generated for every kernel alike")]

include!(concat!(env!("OUT_DIR"), "/shared.rs"));
