//! Morph targets: displacements of vertices that are added before skinning. Clips can animate their weights (glTF 2.0,
//! sections 3.7.2.2 and 3.11).

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::MorphPass;

/// Bound on the difference between CPU and GPU for one component of a morphed vertex, on any device: 5e-6. It holds for
/// four targets with deltas of at most 1, weights of at most 1.5, and vertex components of at most 2. Each sum is at
/// most 8. The addition has a relative rounding error of 2ε, and the product that it adds another 2ε, with ε = 2⁻²⁴.
pub const MORPH_BOUND: f32 = 5e-6;
