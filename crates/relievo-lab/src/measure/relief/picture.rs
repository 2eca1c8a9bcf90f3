//! A picture of a square of relief: the CPU reference of `wgsl/render/scene_relief.wgsl` under a parallel projection.

use glam::Vec3;
use rayon::prelude::*;

use super::view::SquareView;
use crate::shade::shadow::{SoftShadow, light_ray, shaded, soft_shadow};
use relievo::ops::surface::linear_image::LinearImage;
use relievo::ops::surface::map::Address;
use relievo::ops::surface::mips::Mips;
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::relief::reference::height::height;
use relievo::ops::surface::relief::{March, ReliefHit, ReliefMethod, ReliefRay};
use relievo::ops::surface::{Green, ReliefMaterial, ReliefShadow};
use relievo::srgb::linear;

/// The scene of a picture.
#[derive(Debug, Clone, Copy)]
pub struct Scene<'a> {
    /// Heights and acceleration maps.
    pub surface: &'a ReliefSurface<'a>,
    /// The method that finds the surface.
    pub method: ReliefMethod,
    /// The parameters of its march.
    pub march: &'a March,
    /// Base colours.
    pub albedo: &'a Mips,
    /// Tangent-space normals; if `None`, normals follow from the heights.
    pub normals: Option<&'a Mips>,
    /// The direction to which the green channel of the normals points.
    pub green: Green,
    /// Self-shadow.
    pub shadow: ReliefShadow,
    /// Whether points beyond the square are cut away.
    pub silhouette: bool,
    /// Depth and light; here the light is in tangent space.
    pub material: &'a ReliefMaterial,
    /// The view of the square.
    pub view: SquareView,
}

impl Scene<'_> {
    /// Draws the picture over a linear `background`.
    pub fn draw(&self, background: [f32; 3]) -> LinearImage {
        let [width, height] = self.view.size;
        let pixels = (0..width * height).into_par_iter().map(|index| {
            let (x, y) = (f64::from(index % width) + 0.5, f64::from(index / width) + 0.5);
            let ray = self.view.ray(x, y, self.material.scale, self.material.plane);
            ray.and_then(|ray| self.shade(&ray)).unwrap_or(background)
        });
        LinearImage { size: self.view.size, pixels: pixels.collect() }
    }

    /// The linear colour that a ray sees, or `None` beyond the silhouette.
    fn shade(&self, ray: &ReliefRay) -> Option<[f32; 3]> {
        let hit = self.surface.trace(self.method, ray, self.march);
        let tiles = self.view.tiles as f32;
        if self.silhouette && !hit.uv.iter().all(|axis| (0.0..=tiles).contains(axis)) {
            return None;
        }
        let steps = self.view.uv_steps();
        let color = sampled(self.albedo, hit.uv, steps, self.march.address);
        let facing = match self.normals {
            None => self.normal(&hit),
            Some(normals) => {
                let texel = sampled(normals, hit.uv, steps, self.march.address);
                let [x, y] = [texel[0], texel[1]].map(|channel| channel * 2.0 - 1.0);
                let along_v = if self.green == Green::Up { -y } else { y };
                [x, along_v, (1.0 - x * x - y * y).max(0.0).sqrt()]
            }
        };
        let light = self.material.light;
        let facing = Vec3::from(facing).dot(light.into());
        let direct = facing.max(0.0) * self.sunlit(&hit);
        let ambient = self.material.ambient;
        // Lambert's cosine, and the ambient part.
        Some(color.map(|channel| channel * (ambient + (1.0 - ambient) * direct)))
    }

    fn sunlit(&self, hit: &ReliefHit) -> f32 {
        let (light, scale) = (self.material.light, self.material.scale);
        if light[2] <= 0.0 {
            return 1.0;
        }
        match self.shadow {
            ReliefShadow::None => 1.0,
            ReliefShadow::Hard => {
                let first = self.surface.trace(self.method, &light_ray(hit, light, scale), self.march);
                if shaded(&first, hit) { 0.0 } else { 1.0 }
            }
            ReliefShadow::Soft => {
                let (steps, softness) = (self.material.shadow_steps, self.material.softness);
                let (map, march) = (self.surface.map, self.march);
                soft_shadow(&SoftShadow { map, light, scale, march, steps, softness }, hit)
            }
        }
    }

    fn normal(&self, hit: &ReliefHit) -> [f32; 3] {
        let map = self.surface.map;
        let size = [map.width() as f32, map.height() as f32];
        let at = |du: f32, dv: f32| height(map, [hit.uv[0] + du, hit.uv[1] + dv], self.march.address);
        let rise = [
            at(1.0 / size[0], 0.0) - at(-1.0 / size[0], 0.0),
            at(0.0, 1.0 / size[1]) - at(0.0, -1.0 / size[1]),
        ];
        let [x, y] = [0, 1].map(|i| -0.5 * self.material.scale * size[i] * rise[i]);
        let length = (x * x + y * y + 1.0).sqrt();
        [x / length, y / length, 1.0 / length]
    }
}

/// Trilinear sampling of the mip levels whose texels are about as long as the longer of the pixel's two steps.
fn sampled(mips: &Mips, uv: [f32; 2], steps: [[f64; 2]; 2], address: Address) -> [f32; 3] {
    let size = [mips.levels[0].width(), mips.levels[0].height()].map(f64::from);
    let texels = steps.map(|step| (step[0] * size[0]).hypot(step[1] * size[1]));
    let level = texels[0].max(texels[1]).log2().clamp(0.0, (mips.levels.len() - 1) as f64);
    let (near, part) = (level.floor() as usize, level.fract() as f32);
    let first = bilinear(mips, near, uv, address);
    if part == 0.0 {
        return first;
    }
    let second = bilinear(mips, near + 1, uv, address);
    [0, 1, 2].map(|i| first[i] + part * (second[i] - first[i]))
}

fn bilinear(mips: &Mips, level: usize, uv: [f32; 2], address: Address) -> [f32; 3] {
    let image = &mips.levels[level];
    let size = [image.width(), image.height()];
    let at = [0, 1].map(|i| uv[i] * size[i] as f32 - 0.5);
    let texel = |dx: i32, dy: i32| {
        let place = [dx, dy].into_iter().zip(at).zip(size).map(|((offset, at), edge)| {
            let index = at.floor() as i32 + offset;
            let inside = match address {
                Address::Wrap => index.rem_euclid(edge as i32),
                Address::Clamp => index.clamp(0, edge as i32 - 1),
            };
            inside as u32
        });
        let place: Vec<u32> = place.collect();
        let texel = image.get_pixel(place[0], place[1]).0;
        let value = |byte: u8| if mips.is_srgb { linear(byte) } else { f32::from(byte) / 255.0 };
        [value(texel[0]), value(texel[1]), value(texel[2])]
    };
    let [x, y] = at.map(|at| at - at.floor());
    let (a, b, c, d) = (texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1));
    [0, 1, 2].map(|i| (a[i] * (1.0 - x) + b[i] * x) * (1.0 - y) + (c[i] * (1.0 - x) + d[i] * x) * y)
}
