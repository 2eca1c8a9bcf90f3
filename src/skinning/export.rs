//! Export of skinned meshes as Wavefront OBJ.

use std::io::{self, Write};

use crate::asset::mesh::Mesh;
use crate::asset::obj::{ObjWriter, Object};
use crate::skinning::vertex::Vertex;

/// Writes one OBJ object per mesh, in order. Each has vertices in the mesh's order with all digits that `f32` needs,
/// texture coordinates (v up, as in OBJ), normals and triangles.
///
/// # Errors
/// The errors of `out`.
///
/// # Panics
/// If the number of vertices differs from the mesh's.
pub fn write_obj(out: &mut impl Write, meshes: &[(&Mesh, &[Vertex])]) -> io::Result<()> {
    let mut writer = ObjWriter::new(out);
    for (mesh, vertices) in meshes {
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
