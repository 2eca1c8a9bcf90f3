//! Skinning: every vertex where its bones take it (A section 8.4).
//!
//! *Linear* blending transforms by the weighted mean of the bones' matrices. Normals take that mean's cofactors times
//! the sign of its determinant, which is right under uneven and mirrored scale, where tangents keep the matrix itself
//! and a mirrored frame changes its handedness. *Dual-quaternion* blending turns about the mean of the bones' motions
//! instead, so that twisted limbs keep their volume: see [`super::palette`].

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{SkinPass, keep_last};

/// How far a component of a position may lie from the reference's, on any device: times the palette's largest component L (at
/// least 1), times 1 + |x| + |y| + |z| of the vertex.
///
/// With ε = 2⁻²⁴ (`+ − ×` to either neighbour 2ε, division 5ε): a weight carries 13ε of itself (λ times the second 2ε,
/// the difference 2ε, the scale 7ε, the product 2ε), the strongest 13ε of the others and 16ε of their sum: together
/// 42ε. A mean of eight bones adds 32ε: 74ε of L. A product with the vertex adds 10ε: 84ε = 5e-6. Cofactors carry
/// 2·74ε·2 + 8ε = 304ε of L², their product with a unit normal no more a unit of |x| + |y| + |z|, and a unit vector
/// twice that over the length: less than 4·SKIN_BOUND·2 of L² over the length before; tangents 2·SKIN_BOUND·L.
pub const SKIN_BOUND: f32 = 5e-6;

/// By how much [`SKIN_BOUND`] is larger where influences are cut off: what is lost carries 16ε, which division by what
/// is left, at least 1/8, makes 128ε of each weight, twice.
pub const TRUNCATED: f32 = 5.0;
