//! Headless Chromium compiles every flat shader and every module that `relievo shaders` writes, with WebGPU's default
//! limits.
#![cfg(all(feature = "gpu", feature = "cli"))]

#[path = "../harness/mod.rs"]
mod harness;

mod driver;
mod plan;
mod shaders;
