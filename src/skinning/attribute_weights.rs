//! Weights of normals and texture coordinates in mesh simplification, relative to positions
//! ([`Surface::attributes`](crate::mesh::Surface::attributes)).

use glam::{DVec2, DVec3};

use crate::asset::{Mesh, Model};

/// Weight of normals in mesh simplification. Where several normals meet at one point, simplification uses their mean,
/// so normals are blurred at sharp corners. With a larger weight, simplification would therefore keep vertices inside
/// flat faces and cut off the corners.
pub const NORMAL: f32 = 0.05;

/// Edge of a square, as a fraction of the mesh's size. Over the area of this square, a texture that slips by some
/// distance costs as much as a surface that is displaced by that distance.
const SQUARE: f64 = 3e-2;

/// Texture coordinates of a mesh for simplification. They are 0 if the mesh's material has no texture and no normal
/// map. A mesh without a material keeps its texture coordinates, because it may be textured.
pub fn shown_uv(model: &Model, mesh: &Mesh) -> Vec<[f32; 2]> {
    let material = mesh.material.and_then(|at| model.materials.get(at));
    let is_shown = material.is_none_or(|material| material.texture.is_some() || material.normal.is_some());
    if is_shown { mesh.uv.clone() } else { vec![[0.0; 2]; mesh.uv.len()] }
}

/// The area of a mesh's triangles, measured in the mesh's units and in texture coordinates. Both values are doubled.
#[derive(Debug, Clone, Copy, Default)]
pub struct TextureArea {
    surface: f64,
    texture: f64,
}

impl TextureArea {
    /// Adds a triangle, given by the positions and the texture coordinates of its corners.
    pub fn add(&mut self, [a, b, c]: [DVec3; 3], [d, e, f]: [DVec2; 3]) {
        self.surface += (b - a).cross(c - a).length();
        self.texture += (e - d).perp_dot(f - d).abs();
    }

    /// The weight of texture coordinates for a mesh of this size; 0 if the mesh has none.
    pub fn factor(&self, size: f64) -> f32 {
        let factor = ((self.surface / self.texture).sqrt() / (SQUARE * size)) as f32;
        if factor.is_finite() { factor } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The factor does not depend on the mesh's scale. It is halved if texture coordinates grow twice as fast.
    #[test]
    fn a_texture_counts_by_how_far_it_slips() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let uv = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let factor = |scale: f64, texture: f64| {
            let mut area = TextureArea::default();
            area.add(corners.map(|corner| corner * scale), uv.map(|uv| uv * texture));
            area.factor(scale)
        };
        // Texture coordinates from 0 to 1 span one unit of length, which is also the mesh's size.
        let one = (1.0 / SQUARE) as f32;
        assert!((factor(1.0, 1.0) - one).abs() < 1e-3);
        assert!((factor(8.0, 1.0) - one).abs() < 1e-3);
        assert!((factor(1.0, 2.0) - 0.5 * one).abs() < 1e-3);
        assert_eq!(factor(1.0, 0.0), 0.0);
        assert_eq!(TextureArea::default().factor(1.0), 0.0);
    }
}
