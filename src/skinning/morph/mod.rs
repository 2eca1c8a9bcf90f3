//! Morph targets: displacements of vertices, added before skinning, and the keys of their weights (glTF 2.0,
//! sections 3.7.2.2 and 3.11).

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::MorphPass;

/// Parity bound for a component on any device: 5e-6, for four targets with deltas of at most 1, weights of at most 1.5
/// and vertices of at most 2. Each sum, of at most 8, adds 2ε of its own and 2ε of the product, with ε = 2⁻²⁴.
pub const MORPH_BOUND: f32 = 5e-6;
