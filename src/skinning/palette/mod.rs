//! Palettes: for each bone of a skin what takes a vertex from where it was bound to where it is in the model's space.
//!
//! Linear blending takes affine matrices. Dual-quaternion blending (Kavan et al. 2008) takes each matrix apart into a
//! stretch, upper triangular, and a rigid motion after it (Gram–Schmidt on its columns): stretches blend linearly,
//! motions as dual quaternions. So one bone alone does the same in both, sheared and mirrored or not.

use crate::asset::transform::Affine;

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::PalettePass;

/// How far a component may lie from the reference's, on any device: times the palette's largest (at least 1), for matrices
/// whose columns are no shorter than ½ and no nearer to each other than 45°. A product of rows carries 16ε (ε = 2⁻²⁴);
/// Gram–Schmidt's axes carry twice that over the length (64ε), again over the sine (128ε), and their cross product
/// 256ε; the quaternion's components, differences of these over at least 1, 512ε; the dual part as much times the
/// translation: 3.1e-5.
pub const PALETTE_BOUND: f32 = 3.2e-5;

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
