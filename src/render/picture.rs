//! Off-screen pictures of terrain, as the command line draws them; the shortest way to a picture.

use image::imageops::{FilterType, resize};

use crate::Error;
use crate::gpu::Gpu;
use crate::render::camera::Camera;
use crate::render::target::{COLOR_FORMAT, Target};
use crate::render::terrain::{Materials, Style, TerrainRenderer};
use crate::terrain::blend::Shading;
use crate::terrain::config::{Config, HEIGHT_ONE};
use crate::terrain::fields::Fields;
use crate::terrain::texture::Texture;

/// Colour of the sky in linear light.
const SKY: [f64; 3] = [0.36, 0.55, 0.80];

/// How a picture is drawn.
#[derive(Debug, Clone)]
pub struct Picture<'a> {
    /// The configuration of the heights.
    pub config: &'a Config,
    /// One texture for each zone of the configuration.
    pub textures: &'a [Texture],
    /// Light and the mode of zone weights.
    pub shading: Shading,
    /// Textured, or a wireframe.
    pub style: Style,
    /// The camera; world position 0 is the first sample of the first patch.
    pub camera: Camera,
    /// Pixels.
    pub size: [u32; 2],
}

impl Picture<'_> {
    /// Draws fields, which have a margin of at least one sample and show `patches` in the order of the fields.
    ///
    /// # Errors
    /// [`crate::InputError`] for fields or parameters that cannot be drawn; [`crate::gpu::GpuError`].
    pub fn draw(&self, gpu: &Gpu, parts: &[Fields], patches: &[[i32; 2]]) -> Result<image::RgbaImage, Error> {
        let materials = Materials::new(gpu, &self.config.zones, self.textures)?;
        let renderer = TerrainRenderer::new(gpu, COLOR_FORMAT, self.style)?;
        let mut scene = renderer.scene(gpu, &materials, &self.shading)?;
        let origin = patches.first().copied().unwrap_or_default();
        let mut rest = patches;
        for part in parts {
            let (here, after) = rest.split_at(rest.len().min(part.count as usize));
            scene.add(gpu, self.config, part, here, origin)?;
            rest = after;
        }
        // Draws at twice the size and averages, because edges are jagged with one sample per pixel.
        let available = gpu.device().limits().max_texture_dimension_2d;
        let bytes = 16 * u64::from(self.size[0]) * u64::from(self.size[1]);
        let fits = self.size.iter().all(|edge| 2 * edge <= available) && bytes <= gpu.max_binding();
        let scale = if fits { 2 } else { 1 };
        let target = Target::new(gpu, self.size.map(|edge| scale * edge))?;
        scene.set_camera(gpu, &self.camera, target.aspect())?;
        target.draw(gpu, SKY, |pass| scene.draw(pass))?;
        let image = target.read(gpu)?;
        Ok(if scale == 1 { image } else { resize(&image, self.size[0], self.size[1], FilterType::Triangle) })
    }
}

/// A camera that sees a grid of columns × rows of patches with these heights (1/65536 units).
pub fn framing<'a>(config: &Config, grid: [u32; 2], heights: impl Iterator<Item = &'a i32>) -> Camera {
    let (low, high) = heights.fold((i32::MAX, i32::MIN), |(low, high), h| (low.min(*h), high.max(*h)));
    let edge = |patches: u32| f64::from(patches) * f64::from(config.patch_size - 1) * config.terrain_scale;
    let corner =
        |x: f64, height: i32, z: f64| glam::DVec3::new(x, f64::from(height) / HEIGHT_ONE, z).as_vec3();
    Camera::framing(corner(0.0, low.min(high), 0.0), corner(edge(grid[0]), high.max(low), edge(grid[1])))
}
