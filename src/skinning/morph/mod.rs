//! Morph targets: displacements of vertices that are added before skinning. Clips can animate their weights (glTF 2.0,
//! sections 3.7.2.2 and 3.11).

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::MorphPass;

/// Bound on the difference between CPU and GPU for one component of a morphed vertex, on any device: 5e-6. It holds for
/// four targets with deltas of at most 1, weights of at most 1.5, and vertex components of at most 2. Each target adds
/// a product to a sum. With ε = 2⁻²⁴, the addition has an error of 2ε times the sum, which is at most 8. The product
/// has an error of 2ε times its value, which is at most 1.5. Together this is 19ε per target, and 4.6e-6 for four
/// targets.
pub const MORPH_BOUND: f32 = 5e-6;
