//! Height zones and their textures (thesis B section 3.3.1, tables 4.7 and 4.8).

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::json::{Object, whole};
use super::{HEIGHT_ONE, Offset, finite};
use crate::InputError;

/// Largest number of zones in a configuration.
pub const MAX_ZONES: usize = 32;

/// Largest number of times that a zone's texture repeats along the edge of one texture tile.
pub const MAX_REPEATS: u32 = 16;

/// Source of a zone's texture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ZoneTexture {
    /// A texture that relievo generates.
    BuiltIn(BuiltIn),
    /// The path of an image file.
    File(PathBuf),
}

/// Textures that relievo generates, each with a height map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BuiltIn {
    /// Pale, fine-grained sand with wind ripples.
    Sand,
    /// Tufts of grass.
    Grass,
    /// Broken grey-brown rock.
    Hill,
    /// Nearly white snow with drifts.
    Snow,
    /// Dark earth with crumbs and small stones.
    Soil,
    /// Layers of rock. With [`TerrainConfig::triplanar`](super::TerrainConfig::triplanar) on, the layers lie level on steep
    /// walls.
    Strata,
    /// Broken stones on a slope.
    Scree,
}

impl BuiltIn {
    /// All built-in textures.
    pub const ALL: [Self; 7] =
        [Self::Sand, Self::Grass, Self::Hill, Self::Snow, Self::Soil, Self::Strata, Self::Scree];

    /// Default textures, from the lowest zone to the highest, for zones that name none.
    const DEFAULTS: [Self; 4] = [Self::Sand, Self::Grass, Self::Hill, Self::Snow];

    /// Names of all built-in textures, comma-separated, for error messages.
    pub(crate) fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }

    /// Name of the texture in JSON.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sand => "sand",
            Self::Grass => "grass",
            Self::Hill => "hill",
            Self::Snow => "snow",
            Self::Soil => "soil",
            Self::Strata => "strata",
            Self::Scree => "scree",
        }
    }
}

/// A range of slopes, in degrees from level ground. A zone's weight is 1 inside the range and falls to 0 in a transition at each
/// end.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Slope {
    /// Lower end of the range in degrees, 0 to 90. The weight is ½ at this slope. If `min` is 0, there is no lower transition,
    /// and the weight on level ground is 1. Default 0.
    pub min: f64,
    /// Upper end of the range in degrees, above `min`, up to 90. The weight is ½ at this slope. If `max` is 90, there is no upper
    /// transition, and the weight on vertical walls is 1. Default 90.
    pub max: f64,
    /// Width of the transition at each end, in degrees, 1 to 45. The weight changes linearly from 0 to 1 across a transition.
    /// Each transition is centered on its end of the range and cut off at slopes of 0 and 90. Default 10.
    pub fade: f64,
}

impl Default for Slope {
    fn default() -> Self {
        Self { min: 0.0, max: 90.0, fade: 10.0 }
    }
}

impl Slope {
    /// Checks that the ends are in 0..=90 and in order, and that `fade` is in 1..=45.
    ///
    /// # Errors
    /// [`InputError`] that names the field, prefixed with `path`.
    pub fn validate(&self, path: &str) -> Result<(), InputError> {
        finite(&format!("{path}.min"), self.min, 0.0, 90.0)?;
        finite(&format!("{path}.max"), self.max, 0.0, 90.0)?;
        finite(&format!("{path}.fade"), self.fade, 1.0, 45.0)?;
        if self.max <= self.min {
            let bound = format!("must be above min = {}", self.min);
            return Err(InputError::new(format!("{path}.max"), self.max, bound));
        }
        Ok(())
    }
}

/// A range of heights and slopes with its own texture. The zone's weight is greatest at height `max` and falls to 0 at `max` ±
/// (`max` − `min`). Outside the range `slope` the weight also falls to 0.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Zone {
    /// Lower end of the range, in height units.
    pub min: f64,
    /// Upper end of the range, in height units; above `min`.
    pub max: f64,
    /// Texture: `"sand"`, `"grass"`, `"hill"`, `"snow"`, `"soil"`, `"strata"`, `"scree"` or the path of an image. Default: the
    /// first four zones get the first four names, in order; later zones get `"snow"`.
    #[serde(default, deserialize_with = "texture")]
    pub texture: Option<ZoneTexture>,
    /// Slopes on which the zone lies. Default: all slopes.
    #[serde(default, deserialize_with = "slope")]
    pub slope: Slope,
    /// Influence of the texture's height map where zones meet (thesis B section 2.3.4), 0 to 1. At 1, the zone shows first where
    /// its texture is high, and last where its texture is deep. Default 0.
    #[serde(default, rename = "heightBlend")]
    pub height_blend: f64,
    /// Number of times that the texture repeats along the edge of a texture tile, 1 to 16. Default 1.
    #[serde(default = "once", deserialize_with = "whole::<_, 1, MAX_REPEATS>")]
    pub repeats: u32,
}

fn once() -> u32 {
    1
}

fn slope<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Slope, D::Error> {
    Object::<Slope>::deserialize(deserializer).map(|object| object.0)
}

fn texture<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<ZoneTexture>, D::Error> {
    let text = String::deserialize(deserializer)?;
    let built_in = BuiltIn::ALL.into_iter().find(|texture| texture.name() == text);
    Ok(Some(built_in.map_or_else(|| ZoneTexture::File(text.into()), ZoneTexture::BuiltIn)))
}

impl Zone {
    /// Creates a zone for all slopes, with `height_blend` 0 and one repetition of its texture per tile.
    pub fn new(min: f64, max: f64, texture: Option<ZoneTexture>) -> Self {
        Self { min, max, texture, slope: Slope::default(), height_blend: 0.0, repeats: 1 }
    }

    /// The four default zones, at fixed fractions of `scale_factor`. With `positive` offsets the terrain is on average 1.5 ·
    /// `scale_factor` higher, so the zones are raised by the same amount.
    pub(crate) fn defaults(scale_factor: f64, offset: Offset) -> Vec<Self> {
        // If the range is below the resolution of heights, the terrain is flat and fractions of the range are useless.
        let unit = if scale_factor >= 1.0 / HEIGHT_ONE { scale_factor } else { 1.0 };
        let lift = if offset == Offset::Positive { 1.5 } else { 0.0 };
        [(-1.7, -0.65), (-0.65, -0.1), (-0.1, 0.45), (0.4, 1.1)]
            .into_iter()
            .zip(BuiltIn::DEFAULTS)
            .map(|((min, max), texture)| {
                Self::new((min + lift) * unit, (max + lift) * unit, Some(ZoneTexture::BuiltIn(texture)))
            })
            .collect()
    }

    /// Checks that `min` and `max` are finite and in order, and checks every other field.
    ///
    /// # Errors
    /// [`InputError`] that names the field, prefixed with `path`.
    pub fn validate(&self, path: &str) -> Result<(), InputError> {
        check_range(path, self.min, self.max)?;
        self.slope.validate(&format!("{path}.slope"))?;
        finite(&format!("{path}.height_blend"), self.height_blend, 0.0, 1.0)?;
        if !(1..=MAX_REPEATS).contains(&self.repeats) {
            let bound = format!("must be a whole number in 1..={MAX_REPEATS}");
            return Err(InputError::new(format!("{path}.repeats"), self.repeats, bound));
        }
        Ok(())
    }

    /// Texture of this zone; `index` is the zone's position in the list and selects the default.
    pub fn texture_at(&self, index: usize) -> ZoneTexture {
        self.texture.clone().unwrap_or(ZoneTexture::BuiltIn(BuiltIn::DEFAULTS[index.min(3)]))
    }

    pub(crate) fn resolve_texture(&mut self, folder: &Path) {
        if let Some(ZoneTexture::File(path)) = &mut self.texture {
            *path = folder.join(&*path);
        }
    }
}

/// Checks that the number of zones is 1 to [`MAX_ZONES`].
pub(crate) fn check_zone_count(count: usize) -> Result<(), InputError> {
    if (1..=MAX_ZONES).contains(&count) {
        return Ok(());
    }
    Err(InputError::new("zones", format!("[{count} zones]"), format!("must hold 1 to {MAX_ZONES} zones")))
}

pub(crate) fn check_range(path: &str, min: f64, max: f64) -> Result<(), InputError> {
    finite(&format!("{path}.min"), min, -32768.0, 32768.0)?;
    finite(&format!("{path}.max"), max, -32768.0, 32768.0)?;
    // Shaders compute in f32. They would divide by zero if max − min is 0 in f32 or is flushed to 0.
    if max as f32 - (min as f32) < f32::MIN_POSITIVE {
        return Err(InputError::new(format!("{path}.max"), max, format!("must be above min = {min}")));
    }
    Ok(())
}
