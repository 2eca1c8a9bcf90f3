//! Meshes that carry relief: vertices with tangent frames, and triangles.

use crate::InputError;

/// A vertex, as the relief pass reads it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SurfaceVertex {
    /// World units.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unit tangent along u, and ±1: the bitangent along v is that times normal × tangent. In glTF the bitangent
    /// points against v, up the image: glTF's fourth component has the other sign.
    pub tangent: [f32; 4],
    /// Texture coordinates; a tile of relief covers 1.
    pub uv: [f32; 2],
}

/// A mesh that carries relief.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceMesh {
    /// Vertices.
    pub vertices: Vec<SurfaceVertex>,
    /// Three a triangle.
    pub indices: Vec<u32>,
}

impl SurfaceMesh {
    /// A square of one world unit around the origin, seen from +Z; u runs along +X and v along −Y, from 0 to
    /// `tiles`.
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

    /// Refuses indices of no vertex.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn validate(&self) -> Result<(), InputError> {
        crate::asset::indices::check_triangles("indices", &self.indices, self.vertices.len())
    }
}
