//! What skinning reads and writes, and how it blends.

use crate::asset::Mesh;

/// A vertex as skinning reads and writes it: 40 bytes, laid out for vertex buffers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Vertex {
    /// In the space that it was bound in, then in the model's.
    pub position: [f32; 3],
    /// Unit length.
    pub normal: [f32; 3],
    /// Unit length, and ±1: see [`Mesh::tangents`](crate::asset::mesh::Mesh::tangents).
    pub tangent: [f32; 4],
}

/// How the influences of a vertex are blended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Blend {
    /// The mean of matrices, as glTF asks.
    #[default]
    Linear,
    /// The mean of rigid motions. What is promised of linear blending does not hold for it: the bound of
    /// [`Gate::Bounded`](crate::animation::Gate::Bounded), with which it is refused, the fades and levels of
    /// [`Extent`](super::Extent), and boxes and balls around all that bones reach.
    DualQuaternion,
}

/// A mesh's vertices in the space that they were bound in, without its morph targets.
///
/// # Panics
/// For a mesh that [`Mesh::validate`] refuses.
pub fn vertices_of(mesh: &Mesh) -> Vec<Vertex> {
    let vertex = |vertex: usize| Vertex {
        position: mesh.positions[vertex],
        normal: mesh.normals[vertex],
        tangent: mesh.tangents[vertex],
    };
    (0..mesh.vertices()).map(vertex).collect()
}
