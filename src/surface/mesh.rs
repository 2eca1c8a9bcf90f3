//! Meshes for relief mapping: vertices with tangent frames, and triangles.

use crate::InputError;

/// A vertex of a mesh for relief mapping.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SurfaceVertex {
    /// Position of the vertex in world units.
    pub position: [f32; 3],
    /// Unit normal of the surface at the vertex.
    pub normal: [f32; 3],
    /// Unit tangent along u in x, y and z, and a sign ±1 in w. The bitangent points along v and is w · cross(normal, tangent). In
    /// glTF, the bitangent points opposite to v, up the image, so glTF's w has the opposite sign.
    pub tangent: [f32; 4],
    /// Texture coordinates. A range of 1 is one tile of the relief.
    pub uv: [f32; 2],
}

/// A triangle mesh for relief mapping.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceMesh {
    /// Vertices, referred to by `indices`.
    pub vertices: Vec<SurfaceVertex>,
    /// Three vertex indices per triangle.
    pub indices: Vec<u32>,
}

impl SurfaceMesh {
    /// Creates a square in the plane z = 0. Its edges are one world unit long; it is centered at the origin and faces +Z. u runs
    /// along +X and v along −Y, both from 0 to `tiles`.
    pub fn square(tiles: f32) -> Self {
        let vertex = |x: f32, y: f32| SurfaceVertex {
            position: [x - 0.5, 0.5 - y, 0.0],
            normal: [0.0, 0.0, 1.0],
            tangent: [1.0, 0.0, 0.0, -1.0],
            uv: [x * tiles, y * tiles],
        };
        let vertices = vec![vertex(0.0, 0.0), vertex(1.0, 0.0), vertex(0.0, 1.0), vertex(1.0, 1.0)];
        Self { vertices, indices: vec![0, 2, 1, 1, 2, 3] }
    }

    /// Checks that all indices refer to existing vertices and that their number is a multiple of 3.
    ///
    /// # Errors
    /// [`InputError`] that names the first invalid field or index.
    pub fn validate(&self) -> Result<(), InputError> {
        crate::asset::indices::check_triangles("indices", &self.indices, self.vertices.len())
    }
}
