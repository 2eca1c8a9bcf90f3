//! The vertex that skinning reads and writes, and the kinds of blending.

use crate::InputError;
use crate::asset::Mesh;
use crate::asset::mesh::COORDINATE_LIMIT;

/// A vertex as skinning reads and writes it: 40 bytes, in the layout of vertex buffers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Vertex {
    /// Position: in bind space before skinning, in the model's space afterwards.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unit tangent, and handedness ±1; see [`Mesh::tangents`](crate::asset::mesh::Mesh::tangents).
    pub tangent: [f32; 4],
}

/// Blending of a vertex's influences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Blend {
    /// The mean of matrices, as glTF requires.
    #[default]
    Linear,
    /// The mean of rigid motions.
    ///
    /// The guarantees of linear blending do not hold for it: the bound of
    /// [`Gate::Bounded`](crate::animation::Gate::Bounded), which refuses it; the fades and levels of
    /// [`Extent`](super::Extent); and boxes and spheres around everything that bones move.
    DualQuaternion,
}

/// A mesh's vertices in bind space, without its morph targets.
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

/// Refuses vertices outside the range of coordinates, as large scales produce.
///
/// # Errors
/// [`InputError`] that names the mesh by its number, and the first such vertex.
pub fn check_range(mesh: usize, vertices: &[Vertex]) -> Result<(), InputError> {
    let is_good = |value: &f32| value.abs() <= COORDINATE_LIMIT;
    match vertices.iter().position(|vertex| !vertex.position.iter().all(is_good)) {
        None => Ok(()),
        Some(at) => {
            let bound = format!("must be within ±{COORDINATE_LIMIT:e}: scales or weights are too large");
            let value = format!("{:?}", vertices[at].position);
            Err(InputError::new(format!("meshes[{mesh}].positions[{at}]"), value, bound))
        }
    }
}
