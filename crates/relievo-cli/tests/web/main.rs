//! Headless Chromium compiles every flat shader and every module that `relievo shaders` writes, with WebGPU's default
//! limits, and draws a scene.

#[path = "../program/mod.rs"]
mod harness;

#[path = "../../../../tests/mesh/alike.rs"]
mod alike;
mod delivery;
mod driver;
#[path = "../../../relievo-delivery/tests/delivery/host.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod host;
#[path = "scene/src/picture.rs"]
mod picture;
mod plan;
#[path = "scene/src/delivery.rs"]
mod received;
mod scene;
mod shaders;
mod wasm;
