//! Sampling of clips: computes the local transform of every bone at a time (glTF 2.0, appendix C).
//!
//! Rotations between linear keys take the shortest arc at constant speed (slerp). Eberly's polynomial (Eberly 2011,
//! `docs/sources.md`) evaluates the slerp without `sin` and `acos`. The arc is halved first. Five terms then keep the result
//! within [`SLERP_BOUND`] of the true rotation for any two keys.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::animation::rotation::{SLERP_U, SLERP_V};
#[cfg(feature = "gpu")]
pub use pass::SamplePass;

/// Largest angle, in radians, between a sampled rotation and the true rotation, for linear keys. The polynomial contributes at
/// most 4e-8. Rounding of keys, products and sums to `f32` contributes the remaining error.
pub const SLERP_BOUND: f32 = 1e-6;

/// Largest allowed difference between a component and the CPU reference at the same cursor, on any device. It is relative to the
/// largest absolute component of the reference (at least 1).
///
/// Let ε = 2⁻²⁴: `+`, `−` and `×` round by up to 2ε, and `inverseSqrt` by up to 4ε.
///
/// - A spline adds four products with weights of at most 1.15. Each product has an error of 8ε, and the sum has 40ε.
/// - In a slerp, the cosine and the inverse square root computed from it have an error of 8ε each. The cosine of half the angle
///   has 14ε. Each of the five polynomial terms adds 6ε, times a factor of at most 0.3. A weight thus has an error of 16ε. Two or
///   three weights together have 50ε.
/// - Normalizing adds 16ε.
///
/// The total is below 160ε < 1e-5.
pub const SAMPLE_BOUND: f32 = 1e-5;

/// Factor by which [`SAMPLE_BOUND`] grows with each layer above the base.
///
/// A blend of two vectors with error e has the error e plus 12ε of rounding: 2ε for weight times mask, 4ε for 1 minus this
/// product, and 6ε for multiplying and adding the vectors. The blend of two unit quaternions less than 90° apart has a length of
/// at least √½. Normalizing therefore multiplies the blend's error by at most √2 and adds 16ε. The result is √2·e + 33ε. Here
/// 33ε = 2e-6 is a fifth of the smallest e, which is [`SAMPLE_BOUND`].
pub const LAYER_GROWTH: f32 = 1.65;
