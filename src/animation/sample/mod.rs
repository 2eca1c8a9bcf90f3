//! Sampling of clips: every bone's local transform at a time (glTF 2.0, appendix C).
//!
//! Rotations between linear keys take the shortest arc at constant speed (slerp). Eberly's polynomial (Eberly 2011,
//! `docs/sources.md`) evaluates it without `sin` and `acos`. The arc is halved first, so that five terms keep the result within
//! [`SLERP_BOUND`] of the true rotation for any two keys.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::animation::rotation::{SLERP_U, SLERP_V};
#[cfg(feature = "gpu")]
pub use pass::SamplePass;

/// Largest angle, in radians, between a sampled rotation and the true one, for linear keys. The polynomial alone is within
/// 4e-8; the rest is `f32` rounding of keys, products and sums.
pub const SLERP_BOUND: f32 = 1e-6;

/// Largest allowed difference between a component and the reference at the same cursor, on any device, relative to the largest
/// value (at least 1).
///
/// Let ε = 2⁻²⁴ (`+ − ×` round by up to 2ε, `inverseSqrt` by 4ε). A spline adds four products with weights of at most 1.15,
/// each with 8ε: 40ε. The cosine of a slerp carries 8ε, its inverse 8ε, the cosine of half the angle 14ε. Each of five terms
/// adds 6ε, times at most 0.3: 16ε per weight, for two or three weights: 50ε. Normalizing adds 16ε. 160ε < 1e-5.
pub const SAMPLE_BOUND: f32 = 1e-5;

/// Factor by which the bound grows with each layer above the base.
///
/// A blend of two vectors with error e has the error e and 12ε of rounding (weight times mask 2ε, 1 minus that 4ε, both
/// products and their sum 6ε). The blend of two unit quaternions less than 90° apart has a length of at least √½. Normalizing
/// therefore enlarges its error by at most √2 and adds 16ε: √2·e + 33ε, where 33ε = 2e-6 is a fifth of the smallest e.
pub const LAYER_GROWTH: f32 = 1.65;
