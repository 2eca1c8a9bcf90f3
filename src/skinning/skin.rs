//! Skinning: every vertex where its bones take it (A section 8.4).
//!
//! *Linear* blending transforms by the weighted mean of the bones' matrices. Normals take that mean's cofactors times
//! the sign of its determinant, which is right under uneven and mirrored scale, where tangents keep the matrix itself
//! and a mirrored frame changes its handedness. *Dual-quaternion* blending turns about the mean of the bones' motions
//! instead, so that twisted limbs keep their volume: see [`super::palette`].

/// A vertex as skinning reads and writes it: 40 bytes, laid out for vertex buffers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Vertex {
    /// In the space that it was bound in, then in the model's.
    pub position: [f32; 3],
    /// Unit length.
    pub normal: [f32; 3],
    /// Unit length, and ±1: see [`Mesh::tangents`](super::mesh::Mesh::tangents).
    pub tangent: [f32; 4],
}

/// How the influences of a vertex are blended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Blend {
    /// The mean of matrices, as glTF asks.
    #[default]
    Linear,
    /// The mean of rigid motions.
    DualQuaternion,
}
