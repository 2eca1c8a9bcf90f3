//! Export of skinned meshes as Wavefront OBJ.

use std::io::{self, Write};

use crate::asset::mesh::Mesh;
use crate::asset::obj::{ObjWriter, Object};
use crate::skinning::vertex::Vertex;

/// A mesh and its skinned vertices, as input of [`write_obj`].
#[derive(Debug, Clone, Copy)]
pub struct ObjMesh<'a> {
    /// The mesh. Its name, texture coordinates and triangles are written.
    pub mesh: &'a Mesh,
    /// Skinned vertices, one per vertex of the mesh, in the mesh's order.
    pub vertices: &'a [Vertex],
}

/// Writes one OBJ object per mesh, in order: its vertices in the mesh's order, texture coordinates (v up, as in OBJ),
/// normals and triangles. Numbers have all digits that `f32` needs.
///
/// # Errors
/// An I/O error of `out`.
///
/// # Panics
/// If a mesh's number of skinned vertices differs from the mesh's number of vertices.
pub fn write_obj(out: &mut impl Write, meshes: &[ObjMesh<'_>]) -> io::Result<()> {
    let mut writer = ObjWriter::new(out);
    for ObjMesh { mesh, vertices } in meshes {
        assert_eq!(vertices.len(), mesh.vertices());
        let normals: Vec<_> = vertices.iter().map(|vertex| vertex.normal).collect();
        writer.object(Object {
            name: Some(&mesh.name),
            material: None,
            positions: vertices.iter().map(|vertex| vertex.position),
            uv: &mesh.uv,
            normals: &normals,
            triangles: mesh.indices.as_chunks().0.iter().copied(),
        })?;
    }
    Ok(())
}
