//! Morph targets: the CPU reference of `kernels/skinning/morph.wgsl`.

use crate::asset::Mesh;
use crate::skinning::vertex::{Vertex, vertices_of};

/// The vertices of a mesh after morphing and before skinning. `weights` has one weight per morph target. Normals and
/// tangents are sums and not normalized.
///
/// # Panics
/// If [`Mesh::validate`] refuses the mesh.
pub fn morph(mesh: &Mesh, weights: &[f32]) -> Vec<Vertex> {
    let mut vertices = vertices_of(mesh);
    for (target, weight) in mesh.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        for (vertex, delta) in target.vertices.iter().zip(&target.deltas) {
            let vertex = &mut vertices[*vertex as usize];
            for axis in 0..3 {
                vertex.position[axis] += weight * delta.position[axis];
                vertex.normal[axis] += weight * delta.normal[axis];
                vertex.tangent[axis] += weight * delta.tangent[axis];
            }
        }
    }
    vertices
}
