//! Skinning: transforms every vertex by its bones (thesis A section 8.4).
//!
//! *Linear* blending transforms a vertex by the weighted mean of its bones' matrices. Normals use the cofactors of the
//! mean times the sign of its determinant, which is correct under non-uniform and mirrored scale. Tangents use the
//! matrix itself; a mirroring matrix flips their handedness. *Dual-quaternion* blending uses the mean of the bones'
//! rigid motions instead, so that twisted limbs keep their volume; see [`super::palette`].

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::SkinPass;

/// Bound on the difference between CPU and GPU for one component of a skinned position, on any device. It is 5e-6,
/// relative to L · (1 + |x| + |y| + |z|) of the vertex, where L is the palette's largest component (at least 1).
///
/// For normals, the bound is 8·SKIN_BOUND·L², divided by the normal's length before normalization. For tangents, it is
/// 2·SKIN_BOUND·L. `docs/rounding-bounds.md` has the derivation.
pub const SKIN_BOUND: f32 = 5e-6;

/// Factor that multiplies [`SKIN_BOUND`] if influences are truncated. The sum of the removed weights has an error of
/// 16ε. The division by the remaining weight, at least 1/8, turns it into 128ε of each weight. The error counts twice,
/// because the strongest weight is 1 minus the others.
pub const TRUNCATED: f32 = 5.0;
