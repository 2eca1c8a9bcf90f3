//! Palettes: for each bone of a skin what takes a vertex from where it was bound to where it is in the model's space.
//!
//! Linear blending takes affine matrices. Dual-quaternion blending (Kavan et al. 2008) takes each matrix apart into a
//! stretch, upper triangular, and a rigid motion after it (Gram–Schmidt on its columns): stretches blend linearly,
//! motions as dual quaternions. So one bone alone does the same in both, sheared and mirrored or not.

use crate::animation::transform::Affine;

/// A bone's stretch, and its rigid motion after it, as kernels keep it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct DualBone {
    /// The rotation, a unit quaternion (x, y, z, w).
    pub real: [f32; 4],
    /// Half the translation times the rotation.
    pub dual: [f32; 4],
    /// The stretch's diagonal, and a word that means nothing.
    pub diagonal: [f32; 4],
    /// What is above it, row by row, and a word that means nothing.
    pub above: [f32; 4],
}

/// What bones do to vertices.
#[derive(Debug, Clone, PartialEq)]
pub enum Palette {
    /// For linear blending.
    Linear(Vec<Affine>),
    /// For dual-quaternion blending.
    Dual(Vec<DualBone>),
}
