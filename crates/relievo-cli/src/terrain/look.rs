//! The perspective view of `relievo terrain`, drawn through a scene.

use glam::{DVec3, Vec3};
use image::RgbaImage;
use image::imageops::{FilterType, resize};
use relievo::Error;
use relievo::asset::Light;
use relievo::gpu::Gpu;
use relievo::ops::terrain::blend::Shading;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::texture::TerrainTexture;
use relievo::render::Offscreen;
use relievo::render::target::COLOR_FORMAT;
use relievo::scene::{Camera, Scene, TerrainSource, TerrainStyle};

use super::export::HeightRange;

/// Colour of the sky in linear light.
const SKY: [f32; 3] = [0.36, 0.55, 0.80];

/// What is drawn, and how.
pub struct Look<'a> {
    pub config: &'a TerrainConfig,
    /// Columns and rows of patches.
    pub grid: [u32; 2],
    /// The patches, row by row.
    pub patches: &'a [[i32; 2]],
    /// Pixels.
    pub size: [u32; 2],
    pub shading: Shading,
    pub textures: &'a [TerrainTexture],
    pub style: TerrainStyle,
}

impl Look<'_> {
    /// Draws fields, which show the patches in the order of the fields, to a camera that sees all heights of `range`.
    pub fn picture(&self, gpu: &Gpu, parts: &[Fields], range: HeightRange) -> Result<RgbaImage, Error> {
        let mut scene = self.scene(gpu, parts)?;
        // Draws at twice the size and averages, because edges are jagged with one sample per pixel.
        let twice = self.size.map(|edge| 2 * edge);
        let size = if Offscreen::fits(gpu, twice, COLOR_FORMAT) { twice } else { self.size };
        let target = Offscreen::new(gpu, size)?;
        target.draw(&mut scene, self.camera(range, size), SKY)?;
        let image = target.read(gpu)?;
        Ok(if size == self.size {
            image
        } else {
            resize(&image, self.size[0], self.size[1], FilterType::Triangle)
        })
    }

    fn scene(&self, gpu: &Gpu, parts: &[Fields]) -> Result<Scene, Error> {
        let mut scene = Scene::new(gpu)?;
        let Shading { light, ambient, .. } = self.shading;
        scene.set_light(Light { direction: light.into(), color: Vec3::ONE, ambient })?;
        let mut rest = self.patches;
        for part in parts {
            let (here, after) = rest.split_at(rest.len().min(part.count as usize));
            let source = TerrainSource::from_fields(self.config.clone(), part.clone(), here)
                .with_textures(self.textures.to_vec())
                .with_shading(self.shading)
                .with_style(self.style);
            scene.add_terrain(&source)?;
            rest = after;
        }
        Ok(scene)
    }

    /// A camera that sees the whole grid.
    fn camera(&self, HeightRange { low, high }: HeightRange, size: [u32; 2]) -> Camera {
        let edge = f64::from(self.config.patch_size - 1) * self.config.terrain_scale;
        let first = self.patches.first().map_or([0.0; 2], |patch| patch.map(|index| f64::from(index) * edge));
        let [east, south] = self.grid.map(|patches| f64::from(patches) * edge);
        let corner = DVec3::new(first[0], 0.0, first[1]);
        Camera::framing(corner + DVec3::Y * low, corner + DVec3::new(east, high, south), size)
    }
}
