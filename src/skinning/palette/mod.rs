//! Palettes: for each bone of a skin, the transform from bind space to the model's space.
//!
//! Linear blending uses affine matrices. Dual-quaternion blending (Kavan et al. 2008) splits each matrix into an upper
//! triangular stretch, followed by a rigid motion (Gram–Schmidt on the columns). It blends stretches linearly and
//! motions as dual quaternions. For a vertex with one bone, both kinds give the same result, even for sheared or
//! mirrored bones.

use crate::asset::transform::Affine;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::PalettePass;

/// Bound on the difference between CPU and GPU for one component of a palette, on any device: 3.2e-5, relative to the
/// palette's largest component (at least 1). It holds for matrices whose columns have a length of at least ½ and angles
/// of at least 45° between them.
///
/// Derivation, with ε = 2⁻²⁴: a product of rows has an error of 16ε. The first axis of Gram–Schmidt has twice this
/// error, divided by the length: 64ε. For the second axis, the error is also divided by the sine of the angle: 128ε.
/// The cross product of both axes has 256ε. The quaternion's components are differences of the axes' components,
/// divided by at least 1: 512ε. The dual part has this error times the translation: 3.1e-5.
pub const PALETTE_BOUND: f32 = 3.2e-5;

/// The transform of a bone as a stretch followed by a rigid motion, in the layout of the kernels.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct DualBone {
    /// The rotation as a unit quaternion (x, y, z, w).
    pub real: [f32; 4],
    /// Half of the product of the translation and the rotation, as quaternions: the dual part.
    pub dual: [f32; 4],
    /// The diagonal of the stretch matrix (x, y, z); w is unused.
    pub diagonal: [f32; 4],
    /// The elements of the stretch matrix above the diagonal, row by row (x, y, z); w is unused.
    pub above: [f32; 4],
}

/// The transforms of a skin's bones, in the form that a kind of blending needs.
#[derive(Debug, Clone, PartialEq)]
pub enum Palette {
    /// One matrix per bone, for linear blending.
    Linear(Vec<Affine>),
    /// One stretch and rigid motion per bone, for dual-quaternion blending.
    Dual(Vec<DualBone>),
}
