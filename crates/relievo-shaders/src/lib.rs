//! Generates all shaders of relievo. WESL composes every shader of `kernels/` and `wgsl/render/` (except modules) into one flat
//! text, and naga validates that text. The results are in `generated/`: the flat shaders, a manifest of their entry points,
//! bindings, override constants and structs, and the modules for shaders outside the crate.

mod bindings;
#[path = "../../../build/digest.rs"]
mod digest;
#[path = "../../../src/scene/wgsl/entries.rs"]
mod entries;
mod modules;
mod packed;
#[path = "../../../src/scene/wgsl/prefix.rs"]
mod prefix;
mod shaders;
mod sources;
mod types;

pub use shaders::generated;
