//! Textures of height zones: four that relievo generates, and those of image files.

use std::path::Path;

use image::imageops::FilterType;

use crate::Error;
use crate::srgb;
use crate::terrain::blend::MapZone;
use crate::terrain::config::{Border, Config};
use crate::terrain::config::{BuiltIn, Zone, ZoneTexture};
use crate::terrain::features::Features;
use crate::terrain::wrap::reference::wrap;

/// Texels along an edge of a zone texture. Image files are resized to it.
pub const TEXTURE_SIZE: u32 = 256;

/// A zone texture: square, RGBA, sRGB, with all mip levels and its mean colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// Mip levels, from 256² texels down to 1; four bytes per texel.
    pub mips: Vec<Vec<u8>>,
    /// Mean linear colour.
    pub mean: [f32; 3],
}

impl Texture {
    /// Generates a texture.
    pub fn built_in(kind: BuiltIn) -> Self {
        // A wrapped patch serves as tileable noise.
        let (roughness, ramp): (f64, [[f32; 3]; 3]) = match kind {
            BuiltIn::Sand => (0.35, [[0.60, 0.50, 0.34], [0.75, 0.66, 0.48], [0.86, 0.79, 0.62]]),
            BuiltIn::Grass => (0.30, [[0.16, 0.26, 0.08], [0.29, 0.42, 0.15], [0.45, 0.55, 0.24]]),
            BuiltIn::Hill => (0.55, [[0.26, 0.23, 0.20], [0.42, 0.38, 0.34], [0.58, 0.54, 0.49]]),
            BuiltIn::Snow => (0.60, [[0.82, 0.86, 0.91], [0.91, 0.93, 0.96], [0.98, 0.98, 0.99]]),
        };
        let config = Config {
            patch_size: TEXTURE_SIZE + 1,
            scale_factor: 1.0,
            seed: kind.name().to_owned(),
            roughness,
            coarse_levels: 0,
            interpolation: crate::terrain::config::Interpolation::Linear,
            offset: Default::default(),
            border: Border::Wrap,
            corners: [0.0; 4],
            terrain_scale: 1.0,
            texture_tile: None,
            zones: Vec::new(),
        };
        let noise = wrap(&config, &Features::default(), [0, 0]);
        let edge = TEXTURE_SIZE as usize;
        let (low, high) =
            (noise.iter().min().copied().unwrap_or(0), noise.iter().max().copied().unwrap_or(1));
        let mut texels = Vec::with_capacity(edge * edge * 4);
        for y in 0..edge {
            for x in 0..edge {
                let at = (noise[y * (edge + 1) + x] - low) as f32 / (high - low).max(1) as f32;
                let (from, to, t) =
                    if at < 0.5 { (ramp[0], ramp[1], 2.0 * at) } else { (ramp[1], ramp[2], 2.0 * at - 1.0) };
                let channel = |i: usize| ((from[i] + (to[i] - from[i]) * t) * 255.0 + 0.5) as u8;
                texels.extend([channel(0), channel(1), channel(2), 255]);
            }
        }
        Self::from_texels(texels)
    }

    /// Reads an image file and resizes it.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        Ok(Self::from_image(&image::open(path).map_err(|error| Error::file(path, error))?))
    }

    /// Resizes an image.
    pub fn from_image(image: &image::DynamicImage) -> Self {
        let image = image.resize_exact(TEXTURE_SIZE, TEXTURE_SIZE, FilterType::Triangle);
        Self::from_texels(image.into_rgba8().into_raw())
    }

    /// The textures of zones, in the zones' order.
    ///
    /// # Errors
    /// [`Error::File`] when one cannot be read.
    pub fn of_zones(zones: &[Zone]) -> Result<Vec<Self>, Error> {
        let texture = |(index, zone): (usize, &Zone)| match zone.texture_at(index) {
            ZoneTexture::BuiltIn(kind) => Ok(Self::built_in(kind)),
            ZoneTexture::File(path) => Self::from_file(&path),
        };
        zones.iter().enumerate().map(texture).collect()
    }

    fn from_texels(texels: Vec<u8>) -> Self {
        let mut level: Vec<[f32; 3]> = texels
            .chunks_exact(4)
            .map(|texel| [srgb::linear(texel[0]), srgb::linear(texel[1]), srgb::linear(texel[2])])
            .collect();
        let mut mips = vec![texels];
        let mut edge = TEXTURE_SIZE as usize;
        while edge > 1 {
            edge /= 2;
            // A box filter in linear light.
            level = (0..edge * edge)
                .map(|index| {
                    let (x, y) = (2 * (index % edge), 2 * (index / edge));
                    let at = |x: usize, y: usize| level[y * 2 * edge + x];
                    let four = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
                    std::array::from_fn(|channel| four.iter().map(|texel| texel[channel]).sum::<f32>() / 4.0)
                })
                .collect();
            mips.push(
                level
                    .iter()
                    .flat_map(|[r, g, b]| [srgb::byte(*r), srgb::byte(*g), srgb::byte(*b), 255])
                    .collect(),
            );
        }
        Self { mips, mean: level[0] }
    }
}

/// The zones with the mean colours of their textures, as colour maps need them.
pub fn map_zones(zones: &[Zone], textures: &[Texture]) -> Vec<MapZone> {
    (zones.iter().zip(textures))
        .map(|(zone, texture)| MapZone { color: texture.mean, min: zone.min as f32, max: zone.max as f32 })
        .collect()
}
