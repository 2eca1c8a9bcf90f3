//! Palettes: for each bone of a skin, the transform from bind space to the model's space.
//!
//! Linear blending uses affine matrices. Dual-quaternion blending (Kavan et al. 2008) decomposes each matrix into an
//! upper triangular stretch and a rigid motion after it (Gram–Schmidt on its columns). Stretches are blended linearly,
//! motions as dual quaternions. A single bone thus gives the same result in both, sheared and mirrored or not.

use crate::asset::transform::Affine;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::PalettePass;

/// Parity bound for a component on any device: 3.2e-5, relative to the palette's largest component (at least 1). It
/// holds for matrices whose columns have a length of at least ½ and angles of at least 45° between them.
///
/// A product of rows carries 16ε (ε = 2⁻²⁴). The axes of Gram–Schmidt carry twice that over the length (64ε), again
/// over the sine (128ε), and their cross product 256ε. The quaternion's components, differences of these over at least
/// 1, carry 512ε, and the dual part as much times the translation: 3.1e-5.
pub const PALETTE_BOUND: f32 = 3.2e-5;

/// A bone's stretch and the rigid motion after it, in the layout of the kernels.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct DualBone {
    /// The rotation, a unit quaternion (x, y, z, w).
    pub real: [f32; 4],
    /// Half of the translation times the rotation.
    pub dual: [f32; 4],
    /// The diagonal of the stretch, and an unused word.
    pub diagonal: [f32; 4],
    /// The elements above the diagonal, row by row, and an unused word.
    pub above: [f32; 4],
}

/// The transforms of bones, for one kind of blending.
#[derive(Debug, Clone, PartialEq)]
pub enum Palette {
    /// Matrices for linear blending.
    Linear(Vec<Affine>),
    /// Stretches and motions for dual-quaternion blending.
    Dual(Vec<DualBone>),
}
