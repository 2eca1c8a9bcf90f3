//! Skinning: transforms every vertex by its bones (A section 8.4).
//!
//! *Linear* blending transforms by the weighted mean of the bones' matrices. Normals use that mean's cofactors
//! times the sign of its determinant, which is right under uneven and mirrored scale; tangents use the matrix
//! itself, and a mirrored frame changes its handedness. *Dual-quaternion* blending uses the mean of the bones'
//! rigid motions instead, so that twisted limbs keep their volume; see [`super::palette`].

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::SkinPass;

/// The largest difference allowed between a component of a position and the reference, on any device, relative
/// to the palette's largest component L (at least 1) times 1 + |x| + |y| + |z| of the vertex.
///
/// For normals the bound is 4·SKIN_BOUND·2 of L² divided by their length before normalization, for tangents
/// 2·SKIN_BOUND·L. `docs/rounding-bounds.md` has the derivation.
pub const SKIN_BOUND: f32 = 5e-6;

/// The factor by which [`SKIN_BOUND`] is larger where influences are truncated: the sum of the removed weights
/// carries 16ε, and the division by the remaining weight, at least 1/8, turns it into 128ε of each weight,
/// twice.
pub const TRUNCATED: f32 = 5.0;
