//! Headless Chromium compiles every flat shader and every module that `relievo shaders` writes, with WebGPU's default
//! limits, and draws a scene.

#[path = "../program/mod.rs"]
mod harness;

#[path = "../../../../tests/mesh/alike.rs"]
mod alike;
mod driver;
#[path = "scene/src/picture.rs"]
mod picture;
mod plan;
mod scene;
mod shaders;
mod wasm;
