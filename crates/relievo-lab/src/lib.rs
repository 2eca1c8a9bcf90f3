//! The laboratory of relievo: it proves and measures what the library does, on the adapter at hand.
//!
//! [`verify`] compares every kernel with its CPU reference (`relievo verify`), and [`mod@bench`] measures it against a copy of
//! the same bytes (`relievo bench`). [`OPERATIONS`] lists the cases of both, and [`harness`] has comparators and clocks. Two
//! kinds of kernels serve this alone: those of [`baseline`] only move bytes, and that of [`shade`] lists the colours of points.
//!
//! [`measure`] says what methods cost and which errors they show on the caller's own data: level of detail in crowds of models,
//! and surface mapping on height maps. [`files`] writes reports and pictures whole or not at all. [`plot`] draws charts.
//! [`crowd`] advances gated crowds without a device. [`portrait`] draws models, on the host and by a scene. [`reduce`] has every
//! reducer behind one interface, and [`distance`](mod@distance) measures how far meshes are apart.
//!
//! On `wasm32` there are the parity cases ([`verify::run_async`]), [`distance_sweep`](measure::distance_sweep()) and reducers:
//! the rest waits for the device, or draws plots.

#![cfg_attr(
    target_arch = "wasm32",
    allow(dead_code, unused_imports, reason = "benchmarks wait for the device")
)]

pub mod baseline;
#[cfg(not(target_arch = "wasm32"))]
pub mod bench;
pub mod cases;
pub mod crowd;
pub mod distance;
#[cfg(not(target_arch = "wasm32"))]
pub mod files;
pub mod harness;
pub mod measure;
#[cfg(not(target_arch = "wasm32"))]
pub mod plot;
pub mod portrait;
pub mod reduce;
pub mod shade;
pub mod verify;

pub use cases::{OPERATIONS, Operation};
