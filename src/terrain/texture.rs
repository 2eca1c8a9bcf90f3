//! Textures of terrain zones, each with a height map. relievo generates them or reads them from image files.

mod built_in;
mod field;
mod noise;

use std::path::Path;
use std::sync::OnceLock;

use image::Pixel as _;
use image::imageops::{FilterType, resize};

use crate::Error;
use crate::asset::open_image;
use crate::srgb;
use crate::terrain::config::{BuiltIn, Zone, ZoneTexture};

/// Number of texels along an edge of a zone texture. Images of other sizes are resized to this size.
pub const TEXTURE_SIZE: u32 = 512;

/// A square zone texture with all mip levels. Colours are sRGB; the fourth channel is a height map from 0 (deep) to 255 (high).
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainTexture {
    /// Mip levels, from 512² texels down to one texel; four bytes per texel.
    pub mips: Vec<Vec<u8>>,
}

impl TerrainTexture {
    /// Returns a texture that relievo generates. The first call computes the texture; later calls copy it.
    pub fn built_in(kind: BuiltIn) -> Self {
        static KNOWN: [OnceLock<TerrainTexture>; BuiltIn::ALL.len()] =
            [const { OnceLock::new() }; BuiltIn::ALL.len()];
        KNOWN[kind as usize].get_or_init(|| Self::from_texels(built_in::texels(kind))).clone()
    }

    /// Reads a texture from an image file and resizes it to [`TEXTURE_SIZE`].
    ///
    /// # Errors
    /// [`Error::File`] when the image cannot be read.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        Ok(Self::from_image(&open_image(path, image::Limits::default())?))
    }

    /// Converts an image to a texture of [`TEXTURE_SIZE`]² texels. The height map is the image's alpha channel or, without alpha,
    /// its brightness.
    pub fn from_image(image: &image::DynamicImage) -> Self {
        let mut resized = resize(&image.to_rgba8(), TEXTURE_SIZE, TEXTURE_SIZE, FilterType::Triangle);
        if !image.color().has_alpha() {
            resized.pixels_mut().for_each(|texel| texel.0[3] = texel.to_luma().0[0]);
        }
        Self::from_texels(resized.into_raw())
    }

    /// Reads or generates the texture of every zone, in the order of the zones.
    ///
    /// # Errors
    /// [`Error::File`] when an image file cannot be read.
    pub fn of_zones(zones: &[Zone]) -> Result<Vec<Self>, Error> {
        let texture = |(index, zone): (usize, &Zone)| match zone.texture_at(index) {
            ZoneTexture::BuiltIn(kind) => Ok(Self::built_in(kind)),
            ZoneTexture::File(path) => Self::from_file(&path).map_err(|error| unreadable(index, error)),
        };
        zones.iter().enumerate().map(texture).collect()
    }

    fn from_texels(texels: Vec<u8>) -> Self {
        let light: Vec<f32> = (0..=255).map(srgb::linear).collect();
        let is_height = |index: usize| index % 4 == 3;
        let linear = |(index, byte): (usize, &u8)| {
            if is_height(index) { f32::from(*byte) / 255.0 } else { light[usize::from(*byte)] }
        };
        let mut level: Vec<f32> = texels.iter().enumerate().map(linear).collect();
        let mut mips = vec![texels];
        let mut edge = TEXTURE_SIZE as usize;
        while edge > 1 {
            edge /= 2;
            // Each texel of a coarser level is the mean of 2 × 2 texels, computed in linear light.
            let mean = |index: usize| {
                let (row, column, channel) = (index / (4 * edge), index / 4 % edge, index % 4);
                let [first, below] = [0, 1].map(|dy| 8 * ((2 * row + dy) * edge + column) + channel);
                (level[first] + level[first + 4] + level[below] + level[below + 4]) / 4.0
            };
            level = (0..4 * edge * edge).map(mean).collect();
            let byte = |(index, value): (usize, &f32)| {
                if is_height(index) { (value * 255.0 + 0.5) as u8 } else { srgb::byte(*value) }
            };
            mips.push(level.iter().enumerate().map(byte).collect());
        }
        Self { mips }
    }
}

/// Extends the error of an unreadable texture file with the names of the built-in textures that the zone could use instead.
fn unreadable(zone: usize, error: Error) -> Error {
    match error {
        Error::File { path, reason } => {
            let names = BuiltIn::names();
            let reason =
                format!("{reason}; zones[{zone}].texture must be the path of an image, or one of {names}");
            Error::File { path, reason }
        }
        other => other,
    }
}
