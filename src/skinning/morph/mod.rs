//! Morph targets: how vertices move before they are skinned, and the keys of the targets' weights (glTF 2.0, sections
//! 3.7.2.2 and 3.11).

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::MorphPass;

/// How far a component may lie from the reference's for four targets of deltas of at most 1, weights of at most 1.5 and
/// vertices of at most 2, on any device: each sum of at most 8 adds 2ε of it and 2ε of the product, ε = 2⁻²⁴.
pub const MORPH_BOUND: f32 = 5e-6;
