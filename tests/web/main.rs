//! Every flat shader and every module in the compiler of a browser, with WebGPU's default limits: what
//! `relievo shaders` writes, in headless Chromium.
#![cfg(all(feature = "gpu", feature = "cli"))]

#[path = "../harness/mod.rs"]
mod harness;

mod driver;
mod plan;
mod shaders;
