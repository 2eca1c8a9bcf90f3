//! Wavefront OBJ, written.

use std::fmt::Display;
use std::io::{self, Write};

/// What becomes an object of a file: vertices, and triangles that count them from 0.
pub(crate) struct Object<'a, P, T> {
    /// Without one, the triangles belong to the object before. Whitespace becomes `_`: a space would end the name, a line
    /// the object.
    pub name: Option<&'a str>,
    /// Where each vertex is.
    pub positions: P,
    /// Texture coordinates of each vertex, v down the image.
    pub uv: &'a [[f32; 2]],
    /// The normal of each vertex, or none at all.
    pub normals: &'a [[f32; 3]],
    /// Corners, counter-clockwise seen from outside.
    pub triangles: T,
}

/// Writes objects into one file, one after the other. Numbers have every digit that their type needs.
pub(crate) struct ObjWriter<W> {
    out: W,
    /// The number of the next vertex; the file's first is 1.
    next: u64,
}

impl<W: Write> ObjWriter<W> {
    pub fn new(out: W) -> Self {
        Self { out, next: 1 }
    }

    /// A line that readers skip.
    pub fn comment(&mut self, text: impl Display) -> io::Result<()> {
        writeln!(self.out, "# {text}")
    }

    /// An object with as many texture coordinates as positions.
    pub fn object<N: Display>(
        &mut self,
        object: Object<'_, impl IntoIterator<Item = [N; 3]>, impl IntoIterator<Item = [u32; 3]>>,
    ) -> io::Result<()> {
        let Object { name, positions, uv, normals, triangles } = object;
        let out = &mut self.out;
        if let Some(name) = name {
            let name: String = name.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect();
            writeln!(out, "o {name}")?;
        }
        for [x, y, z] in positions {
            writeln!(out, "v {x} {y} {z}")?;
        }
        for [u, v] in uv {
            // OBJ's texture origin is the bottom.
            writeln!(out, "vt {u} {}", 1.0 - v)?;
        }
        for [x, y, z] in normals {
            writeln!(out, "vn {x} {y} {z}")?;
        }
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| self.next + u64::from(corner));
            match normals {
                [] => writeln!(out, "f {a}/{a} {b}/{b} {c}/{c}")?,
                _ => writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}")?,
            }
        }
        self.next += uv.len() as u64;
        Ok(())
    }
}
