//! Sampling clips: where a clip stands at a moment, and every bone's transform then (spec of glTF 2.0, appendix C).
//!
//! Rotations between linear keys take the shortest arc at constant speed (slerp), by Eberly's polynomial (2011, "A
//! fast and accurate algorithm for computing SLERP"), which needs neither `sin` nor `acos`. The arc is halved first,
//! so five terms keep it within [`SLERP_BOUND`] of the true rotation for every two keys.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{SampleActiveJob, SamplePass};

/// How far a sampled rotation between linear keys may lie from the true one, in radians. The polynomial alone is
/// within 4e-8; the rest is `f32`'s rounding of keys, products and sums.
pub const SLERP_BOUND: f32 = 1e-6;

/// How far a component may lie from the reference's at the same place, on any device, times the largest value (at least 1).
///
/// With ε = 2⁻²⁴ (`+ − ×` to either neighbour 2ε, `inverseSqrt` 4ε): a spline adds four products of weights of at most
/// 1.15, each with 8ε: 40ε. A slerp's cosine carries 8ε, its inverse 8ε, the cosine of half the angle 14ε; each of
/// five terms adds 6ε, times at most 0.3: 16ε a weight, of two or three: 50ε. Normalizing adds 16ε. 160ε < 1e-5.
pub const SAMPLE_BOUND: f32 = 1e-5;

/// By what the bound grows with each layer above the base. A blend of two vectors that are off by e is off by e and 12ε
/// of rounding (weight times mask 2ε, what is left of 1 4ε, both products and their sum 6ε). The blend of two unit
/// quaternions less than 90° apart is at least √½ long, so normalizing enlarges that by at most √2, and adds 16ε:
/// √2·e + 33ε, and 33ε = 2e-6 is a fifth of the least e.
pub const LAYER_GROWTH: f32 = 1.65;

/// Coefficients of Eberly's polynomial for cosines from √½ to 1: 1/(i(2i + 1)) for i from 1 to 5. The last makes up
/// for the terms that are left out.
pub const SLERP_U: [f32; 5] = [1.0 / 3.0, 1.0 / 10.0, 1.0 / 21.0, 1.0 / 36.0, REST / 55.0];

/// i/(2i + 1), likewise.
pub const SLERP_V: [f32; 5] = [1.0 / 3.0, 2.0 / 5.0, 3.0 / 7.0, 4.0 / 9.0, REST * 5.0 / 11.0];

/// Makes the largest error of five terms on halved arcs least.
const REST: f32 = 1.15;
