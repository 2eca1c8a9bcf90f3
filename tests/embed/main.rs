//! The scene inside a program with its own device, targets and frames, on WebGPU's default limits without features.
#![cfg(all(feature = "gpu", feature = "samples"))]

#[path = "../harness/mod.rs"]
mod harness;

mod frame;
mod life;
mod misuse;
mod placements;
#[cfg(feature = "verify")]
mod promise;
mod targets;
mod views;
mod world;
