//! Meshes that carry a relief: vertices with tangent frames, and triangles.

use crate::InputError;

/// A vertex of a mesh that carries a relief.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SurfaceVertex {
    /// Position in world units.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unit tangent along u, and a sign ±1. The bitangent, along v, is the sign times normal × tangent. glTF's bitangent points
    /// against v, up the image, so that glTF's fourth component has the opposite sign.
    pub tangent: [f32; 4],
    /// Texture coordinates; a range of 1 is one tile of the relief.
    pub uv: [f32; 2],
}

/// A mesh that carries relief.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceMesh {
    /// The vertices that `indices` name.
    pub vertices: Vec<SurfaceVertex>,
    /// Three indices per triangle.
    pub indices: Vec<u32>,
}

impl SurfaceMesh {
    /// A square in the plane z = 0 with an edge of one world unit, centered at the origin and facing +Z. u runs along +X and v
    /// along −Y, both from 0 to `tiles`.
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

    /// Refuses indices of vertices that do not exist.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn validate(&self) -> Result<(), InputError> {
        crate::asset::indices::check_triangles("indices", &self.indices, self.vertices.len())
    }
}
