//! Headless Chromium compiles every flat shader and every module that `relievo shaders` writes, with WebGPU's default
//! limits, and draws a scene.
#![cfg(all(feature = "gpu", feature = "cli"))]

#[path = "../harness/mod.rs"]
mod harness;

#[path = "../mesh/alike.rs"]
mod alike;
mod driver;
#[path = "scene/src/picture.rs"]
mod picture;
mod plan;
mod scene;
mod shaders;
mod wasm;
