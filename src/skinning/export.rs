//! Export of skinned meshes as Wavefront OBJ.

use std::fmt::Write as _;

use crate::asset::mesh::Mesh;
use crate::skinning::vertex::Vertex;

/// Writes one object per mesh, in order: vertices in the mesh's order with all digits that `f32` needs, texture
/// coordinates (v up, as in OBJ), normals, triangles.
///
/// # Panics
/// If the number of vertices differs from the mesh's.
pub fn obj(meshes: &[(&Mesh, &[Vertex])]) -> String {
    let mut text = String::new();
    let mut first = 1;
    for (mesh, vertices) in meshes {
        // A space would end the name, and a line break the object.
        let name: String = mesh.name.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect();
        let mut line = |args: std::fmt::Arguments<'_>| text.write_fmt(args).expect("strings take all");
        line(format_args!("o {name}\n"));
        for Vertex { position: [x, y, z], .. } in *vertices {
            line(format_args!("v {x} {y} {z}\n"));
        }
        for [u, v] in &mesh.uv {
            line(format_args!("vt {u} {}\n", 1.0 - v));
        }
        for Vertex { normal: [x, y, z], .. } in *vertices {
            line(format_args!("vn {x} {y} {z}\n"));
        }
        for triangle in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| first + triangle[corner]);
            line(format_args!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n"));
        }
        assert_eq!(vertices.len(), mesh.vertices());
        first += vertices.len() as u32;
    }
    text
}
