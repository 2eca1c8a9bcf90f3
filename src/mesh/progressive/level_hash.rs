//! Hash of a level of a progressive mesh.

use crate::asset::Mesh;
use crate::hash::sha256;

/// SHA-256 of a level's vertices and triangles. The level's vertices are the first `vertices` vertices of the mesh, and
/// are hashed with all attributes.
pub(super) fn hash(mesh: &Mesh, level: u32, vertices: u32) -> String {
    let count = vertices as usize;
    let mut words = vec![vertices, mesh.triangles(level).len() as u32];
    let mut floats = |values: &[f32]| words.extend(values.iter().map(|value| value.to_bits()));
    floats(mesh.positions[..count].as_flattened());
    floats(mesh.normals[..count].as_flattened());
    floats(mesh.tangents[..count].as_flattened());
    floats(mesh.uv[..count].as_flattened());
    for vertex in 0..count {
        let influences = mesh.influences.of(vertex);
        words.push(influences.len() as u32);
        words.extend(influences.iter().flat_map(|one| [one.bone, one.weight.to_bits()]));
    }
    for target in &mesh.targets {
        let moved = target.vertices.partition_point(|vertex| *vertex < vertices);
        words.push(moved as u32);
        for (vertex, delta) in target.vertices.iter().zip(&target.deltas).take(moved) {
            words.push(*vertex);
            words.extend(
                [delta.position, delta.normal, delta.tangent].as_flattened().iter().map(|x| x.to_bits()),
            );
        }
    }
    words.extend(mesh.triangles(level));
    sha256(&words)
}
