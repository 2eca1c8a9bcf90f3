//! The vertex that skinning reads and writes, and the kinds of blending.

use crate::InputError;
use crate::asset::Mesh;
use crate::asset::mesh::COORDINATE_LIMIT;

/// A vertex before or after skinning: 40 bytes, in the layout of vertex buffers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Vertex {
    /// Position: in bind space before skinning, in the model's space afterwards.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unit tangent (x, y, z), and handedness ±1 (w); see [`Mesh::tangents`](crate::asset::mesh::Mesh::tangents).
    pub tangent: [f32; 4],
}

/// How skinning blends the bones that a vertex follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Blend {
    /// The weighted mean of the bones' matrices, as glTF requires.
    #[default]
    Linear,
    /// The weighted mean of the bones' rigid motions, as dual quaternions.
    ///
    /// Some guarantees hold for linear blending only: the error bound of
    /// [`Gate::Bounded`](crate::animation::Gate::Bounded), which refuses dual quaternions; the fades and levels of
    /// [`Extent`](super::Extent); and bounding boxes and spheres of animated models.
    DualQuaternion,
}

/// The vertices of a mesh in bind space, without morph targets.
///
/// # Panics
/// If [`Mesh::validate`] refuses the mesh.
pub fn vertices_of(mesh: &Mesh) -> Vec<Vertex> {
    let vertex = |vertex: usize| Vertex {
        position: mesh.positions[vertex],
        normal: mesh.normals[vertex],
        tangent: mesh.tangents[vertex],
    };
    (0..mesh.vertices()).map(vertex).collect()
}

/// Refuses vertices whose positions exceed the range of coordinates, which large scales can cause.
///
/// # Errors
/// [`InputError`] that names the mesh by its number, and the first vertex out of range.
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
