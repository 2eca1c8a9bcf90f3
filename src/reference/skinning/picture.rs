//! A picture of skinned meshes without a GPU: twin of `wgsl/render/skinned.wgsl`, for one instance of one colour.

use glam::{Mat4, Vec3, Vec4};

use crate::skinning::picture::Light;
use crate::skinning::skin::Vertex;
use crate::surface::linear_image::LinearImage;

/// Where and how meshes are seen.
#[derive(Debug, Clone, Copy)]
pub struct Scene {
    /// From the model's space to clip space.
    pub clip_from_model: Mat4,
    /// What lights them.
    pub light: Light,
    /// Linear colour.
    pub albedo: [f32; 3],
    /// Columns and rows.
    pub size: [u32; 2],
}

impl Scene {
    /// Triangles, each mesh's vertices with its indices, over a linear `background`; one sample a pixel.
    pub fn draw(&self, meshes: &[(&[Vertex], &[u32])], background: [f32; 3]) -> LinearImage {
        let pixels = (self.size[0] * self.size[1]) as usize;
        let mut canvas = Canvas { scene: self, depths: vec![1.0; pixels], pixels: vec![background; pixels] };
        for (vertices, indices) in meshes {
            let clip = |vertex: &Vertex| self.clip_from_model * Vec3::from(vertex.position).extend(1.0);
            let corners: Vec<(Vec4, Vec3)> =
                vertices.iter().map(|vertex| (clip(vertex), vertex.normal.into())).collect();
            for triangle in indices.chunks_exact(3) {
                canvas.triangle([0, 1, 2].map(|corner| corners[triangle[corner] as usize]));
            }
        }
        LinearImage { size: self.size, pixels: canvas.pixels }
    }
}

struct Canvas<'a> {
    scene: &'a Scene,
    depths: Vec<f32>,
    pixels: Vec<[f32; 3]>,
}

impl Canvas<'_> {
    /// A triangle in front of the near plane; others are left out whole.
    fn triangle(&mut self, corners: [(Vec4, Vec3); 3]) {
        if corners.iter().any(|(clip, _)| clip.w <= 0.0 || !clip.is_finite()) {
            return;
        }
        let size = self.scene.size.map(|edge| edge as f32);
        // Pixels, depth, and 1/w, which is linear on the screen.
        let screen = corners.map(|(clip, _)| {
            let [x, y, z] = (clip.truncate() / clip.w).to_array();
            Vec4::new((0.5 + 0.5 * x) * size[0], (0.5 - 0.5 * y) * size[1], z, 1.0 / clip.w)
        });
        let [a, b, c] = screen;
        let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if area == 0.0 {
            return;
        }
        let range = |low: f32, high: f32, edge: f32| {
            (low.floor().max(0.0) as u32)..(high.ceil().clamp(0.0, edge) as u32)
        };
        let [low, high] = [a.min(b).min(c), a.max(b).max(c)];
        for row in range(low.y, high.y, size[1]) {
            for column in range(low.x, high.x, size[0]) {
                let (x, y) = (column as f32 + 0.5, row as f32 + 0.5);
                let share = |p: Vec4, q: Vec4| ((p.x - x) * (q.y - y) - (q.x - x) * (p.y - y)) / area;
                let shares = Vec3::new(share(b, c), share(c, a), share(a, b));
                if shares.min_element() >= 0.0 {
                    self.fragment(
                        (row * self.scene.size[0] + column) as usize,
                        shares,
                        screen,
                        corners.map(|corner| corner.1),
                    );
                }
            }
        }
    }

    fn fragment(&mut self, pixel: usize, shares: Vec3, screen: [Vec4; 3], normals: [Vec3; 3]) {
        let depth = shares.dot(Vec3::new(screen[0].z, screen[1].z, screen[2].z));
        if !(0.0..self.depths[pixel]).contains(&depth) {
            return;
        }
        self.depths[pixel] = depth;
        let weights = shares * Vec3::new(screen[0].w, screen[1].w, screen[2].w);
        let normal = weights.x * normals[0] + weights.y * normals[1] + weights.z * normals[2];
        let Light { direction, ambient } = self.scene.light;
        let direct = normal.normalize_or_zero().dot(direction.normalize()).max(0.0);
        self.pixels[pixel] = self.scene.albedo.map(|color| color * (ambient + (1.0 - ambient) * direct));
    }
}
