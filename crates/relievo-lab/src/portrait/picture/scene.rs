//! Pictures of skinned meshes without a GPU: the CPU reference of `wgsl/render/scene_mesh.wgsl`, for one instance without normal
//! maps.

use glam::{Mat4, Vec3, Vec4};
use relievo::asset::Mesh;
use relievo::asset::material::{Alpha, dither_threshold};
use relievo::asset::{Light, light::lambert};
use relievo::ops::lod::is_mirrored;
use relievo::ops::skinning::vertex::Vertex;
use relievo::ops::surface::linear_image::LinearImage;

use super::texture::Surface;

/// The view and lighting of meshes.
#[derive(Debug, Clone, Copy)]
pub struct Scene {
    /// The matrix from the model's space to clip space. It may mirror; the outside of meshes is still shown.
    pub clip_from_model: Mat4,
    /// The light.
    pub light: Light,
    /// Pixels along x and y.
    pub size: [u32; 2],
}

/// A mesh with its vertices and its surface.
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    /// Triangles and texture coordinates.
    pub mesh: &'a Mesh,
    /// The mesh's level of detail: 0 is the mesh itself; a number beyond the last level gives the last.
    pub level: u32,
    /// One vertex per vertex of the mesh, in its order; only those that the level uses matter.
    pub vertices: &'a [Vertex],
    /// The base colour.
    pub surface: &'a Surface,
}

impl Scene {
    /// Draws the meshes over a linear `background`, with one sample per pixel.
    pub fn draw(&self, parts: &[Part<'_>], background: [f32; 3]) -> LinearImage {
        let pixels = (self.size[0] * self.size[1]) as usize;
        let mut canvas = Canvas {
            scene: self,
            is_mirrored: is_mirrored(&self.clip_from_model),
            depths: vec![1.0; pixels],
            pixels: vec![background; pixels],
        };
        for part in parts {
            for triangle in part.mesh.triangles(part.level).chunks_exact(3) {
                let corner = |corner: usize| self.corner(part, triangle[corner] as usize);
                canvas.triangle(part, [0, 1, 2].map(corner));
            }
        }
        LinearImage { size: self.size, pixels: canvas.pixels }
    }

    fn corner(&self, part: &Part<'_>, at: usize) -> Corner {
        let Vertex { position, normal, .. } = part.vertices[at];
        Corner {
            clip: self.clip_from_model * Vec3::from(position).extend(1.0),
            normal: normal.into(),
            uv: part.mesh.uv[at],
        }
    }
}

#[derive(Clone, Copy)]
struct Corner {
    clip: Vec4,
    normal: Vec3,
    uv: [f32; 2],
}

struct Canvas<'a> {
    scene: &'a Scene,
    is_mirrored: bool,
    depths: Vec<f32>,
    pixels: Vec<[f32; 3]>,
}

/// A triangle on the screen: pixels, depth, and 1/w, which is linear there.
struct Triangle<'a> {
    part: &'a Part<'a>,
    corners: [Corner; 3],
    screen: [Vec4; 3],
    area: f32,
    /// Whether its outside is seen.
    is_front: bool,
}

impl Canvas<'_> {
    /// Draws a triangle if it lies in front of the near plane as a whole.
    fn triangle(&mut self, part: &Part<'_>, corners: [Corner; 3]) {
        if corners.iter().any(|corner| corner.clip.w <= 0.0 || !corner.clip.is_finite()) {
            return;
        }
        let size = self.scene.size.map(|edge| edge as f32);
        let screen = corners.map(|Corner { clip, .. }| {
            let [x, y, z] = (clip.truncate() / clip.w).to_array();
            Vec4::new((0.5 + 0.5 * x) * size[0], (0.5 - 0.5 * y) * size[1], z, 1.0 / clip.w)
        });
        let [a, b, c] = screen;
        // Negative if seen from outside, unless mirrored, because y points down here.
        let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        let is_front = (area < 0.0) != self.is_mirrored;
        if area == 0.0 || !is_front && !part.mesh.double_sided {
            return;
        }
        let triangle = Triangle { part, corners, screen, area, is_front };
        let range = |low: f32, high: f32, edge: f32| {
            (low.floor().max(0.0) as u32)..(high.ceil().clamp(0.0, edge) as u32)
        };
        let [low, high] = [a.min(b).min(c), a.max(b).max(c)];
        for row in range(low.y, high.y, size[1]) {
            for column in range(low.x, high.x, size[0]) {
                self.fragment([column, row], &triangle);
            }
        }
    }

    fn fragment(&mut self, pixel: [u32; 2], triangle: &Triangle<'_>) {
        let [x, y] = pixel.map(|at| at as f32 + 0.5);
        let barycentric = triangle.barycentric(x, y);
        if barycentric.min_element() < 0.0 {
            return;
        }
        let index = (pixel[1] * self.scene.size[0] + pixel[0]) as usize;
        let depth = barycentric.dot(Vec3::from(triangle.screen.map(|corner| corner.z)));
        if !(0.0..self.depths[index]).contains(&depth) {
            return;
        }
        let uv = triangle.uv(x, y);
        let step = |[u, v]: [f32; 2]| [u - uv[0], v - uv[1]];
        let steps = [step(triangle.uv(x + 1.0, y)), step(triangle.uv(x, y + 1.0))];
        let surface = triangle.part.surface;
        let [r, g, b, alpha] = surface.at(uv, steps);
        let least = match surface.alpha {
            Alpha::Opaque => f32::NEG_INFINITY,
            Alpha::Mask(cutoff) => cutoff,
            Alpha::Dithered | Alpha::Blended => dither_threshold(pixel),
        };
        if alpha < least {
            return;
        }
        self.depths[index] = depth;
        let weights = triangle.weights(x, y).to_array();
        let normals = triangle.corners.iter().zip(weights).map(|(corner, weight)| weight * corner.normal);
        let side = if triangle.is_front { 1.0 } else { -1.0 };
        let Light { direction, color, ambient } = self.scene.light;
        let facing = side * normals.sum::<Vec3>().normalize_or_zero().dot(direction.normalize());
        let lit = Vec3::new(r, g, b) * color * lambert(ambient, facing.max(0.0));
        self.pixels[index] = lit.to_array();
    }
}

impl Triangle<'_> {
    /// The perspective-correct weight of each corner at a point of the screen.
    fn barycentric(&self, x: f32, y: f32) -> Vec3 {
        let [a, b, c] = self.screen;
        let edge = |p: Vec4, q: Vec4| ((p.x - x) * (q.y - y) - (q.x - x) * (p.y - y)) / self.area;
        Vec3::new(edge(b, c), edge(c, a), edge(a, b))
    }

    /// The weights of the corners on the screen.
    fn weights(&self, x: f32, y: f32) -> Vec3 {
        let weights = self.barycentric(x, y) * Vec3::from(self.screen.map(|corner| corner.w));
        weights / weights.element_sum()
    }

    fn uv(&self, x: f32, y: f32) -> [f32; 2] {
        let weights = self.weights(x, y);
        [0, 1].map(|axis| weights.dot(Vec3::from(self.corners.map(|corner| corner.uv[axis]))))
    }
}
