//! Terrain configuration: the JSON of thesis B table 4.6 with relievo's optional fields.

mod json;
mod zones;

pub(crate) use json::from_json_value;
pub(crate) use json::{Object, from_json_object, named, read_text, whole};
pub use zones::{BuiltIn, MAX_REPEATS, MAX_ZONES, Slope, Zone, ZoneTexture};
pub(crate) use zones::{check_range, check_zone_count};

use std::path::Path;

use serde::Deserialize;

use crate::shared::terrain::fixed;
#[cfg(feature = "gpu")]
use crate::shared::terrain::offset;
use crate::{Error, InputError};

/// Fixed-point value of 1 height unit: heights are stored as integer multiples of 1/65536 unit.
pub const HEIGHT_ONE: f64 = fixed::HEIGHT_ONE as f64;

/// Length of a patch's edge in integer world coordinates: one coordinate step is 1/4096 of an edge.
pub const PATCH_EDGE: i64 = 4096;

/// Largest absolute height, 2^30 − 1 in 1/65536 units. Sums and differences of two heights still fit `i32`.
pub const HEIGHT_LIMIT: i64 = fixed::HEIGHT_LIMIT as i64;

/// With smooth interpolation: largest range of the offsets and largest absolute feature height, 2^29 in 1/65536 units.
const SMOOTH_LIMIT: i64 = 1 << 29;

/// Largest number of texture tiles along a patch's edge. With more, `f32` texture coordinates could not resolve half a texel.
const MAX_TILES: f64 = 16_384.0;

/// Distribution of the random height offsets. Below, r is the range of the offsets at a level of subdivision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Offset {
    /// Uniform in [−r, r).
    #[default]
    Signed,
    /// Uniform in [0, r), as in thesis B.
    Positive,
    /// Sum of four uniform numbers, scaled to [−r, r): nearly Gaussian.
    Gaussian,
}

impl Offset {
    /// Value of the shaders' constant `DISTRIBUTION` for this distribution.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        match self {
            Self::Signed => offset::OFFSET_SIGNED,
            Self::Positive => offset::OFFSET_POSITIVE,
            Self::Gaussian => offset::OFFSET_GAUSSIAN,
        }
    }
}

/// How the heights of a terrain are made. All generators are integer arithmetic on world coordinates: every device computes the
/// same bits, and a coarser resolution has exactly every second sample of a finer one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, serde::Serialize)]
#[serde(rename_all = "camelCase")]
pub enum HeightGenerator {
    /// Midpoint displacement by the diamond-square algorithm (thesis B section 3.3.1).
    #[default]
    DiamondSquare,
    /// Spectral synthesis (fractional Brownian motion): a sum of octaves of gradient noise (Perlin, "Improving noise", SIGGRAPH
    /// 2002; thesis B section 3.3.1). See [`noise`](crate::ops::terrain::noise).
    Fbm,
    /// Ridged multifractal: octaves of 1 − |noise|, whose sharp crests look like mountain ridges (Musgrave, in Texturing and
    /// Modeling, 3rd edition, 2003, chapter 16). See [`noise`](crate::ops::terrain::noise).
    Ridged,
    /// Fractional Brownian motion over simplex noise, whose lattice is triangular (Perlin, "Noise hardware", 2001; Gustavson,
    /// "Simplex noise demystified", 2005). See [`noise`](crate::ops::terrain::noise).
    Simplex,
}

/// How a new point's height is interpolated from the coarser lattice, before the random offset is added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum HeightInterpolation {
    /// Mean of four neighbours, as in thesis B. This leaves visible creases along the lines of coarse lattices.
    #[default]
    Linear,
    /// Four-point interpolation, without creases (Dyn, Levin and Gregory, "A 4-point interpolatory subdivision scheme for curve
    /// design", Computer Aided Geometric Design 1987). Allowed only with [`Border::Seamless`].
    Smooth,
}

/// How heights on the borders of patches are made to fit the neighbouring patches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Border {
    /// Every patch is a window onto one diamond-square surface of the whole plane. Neighbouring patches agree bit for bit in
    /// heights and slopes, whatever the order of generation.
    #[default]
    Seamless,
    /// Every patch is generated without its neighbours; its own opposite edge replaces them (thesis B section 3.3.1).
    Wrap,
    /// Every patch is generated as with [`Border::Wrap`] and then blended towards existing neighbours (thesis B section 3.3.1).
    /// The value is the width of the transition, in samples. Only in this mode does the result depend on the order of generation.
    Blend(u32),
}

/// Configuration of a terrain. [`TerrainConfig::validate`] checks every field.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainConfig {
    /// Samples along a patch's edge: 2^n + 1, n in 1..=12.
    pub patch_size: u32,
    /// Range of the random offsets at the coarsest level, in height units; ≥ 0.
    ///
    /// **Decided**: the first subdivision uses the whole range, as in thesis B's steps 1 and 2 (3.3.1). The base lattice of
    /// `seamless` terrain uses the whole range too. Thesis B's text, however, halves the range at the start of each subdivision,
    /// including the first.
    pub scale_factor: f64,
    /// Seed of the random offsets: any text. The same seed gives the same world at every resolution.
    pub seed: String,
    /// Roughness H ≥ 0: per level, the range of the random offsets shrinks by the factor 2^−H. Default 1.
    pub roughness: f64,
    /// Number k of subdivision levels that are coarser than a patch, 0 to 8. Points of the coarsest lattice are 2^k patch edges
    /// apart. Default 0. Must be 0 unless `border` is `seamless`.
    pub coarse_levels: u32,
    /// Distribution of the random offsets. Default `signed`.
    pub offset: Offset,
    /// How heights are made. Default `diamondSquare` (thesis B). The other generators require the border `seamless`, the offset
    /// `signed` and the interpolation `linear`, and take no injected heights.
    pub generator: HeightGenerator,
    /// Interpolation of new points from the coarser lattice. Default `linear`.
    pub interpolation: HeightInterpolation,
    /// How patches fit their neighbours at the borders. Default `seamless`.
    pub border: Border,
    /// Heights of a patch's corners (x, y) = (0, 0), (1, 0), (0, 1), (1, 1), in height units. Default 0. Only for `wrap` and
    /// `blend`.
    pub corners: [f64; 4],
    /// World units between neighbouring samples, > 0. Default 1.
    pub terrain_scale: f64,
    /// World units that a zone's texture covers before it repeats; at least 1/16384 of a patch's edge. Default `None`:
    /// (`patch_size` − 1) / 10 units, which gives 10 · `terrain_scale` tiles along a patch's edge (thesis B's `terrainScale`).
    pub texture_tile: Option<f64>,
    /// Whether steep ground is also textured from the sides (triplanar mapping), which avoids stretched textures there. Default
    /// `false`.
    pub triplanar: bool,
    /// Strength of a colour variation that hides the repetition of textures, 0 to 1. Default 0.
    pub variation: f64,
    /// Zones of ground by height and slope, 1 to 32. Default: four zones with sand, grass, hill and snow.
    pub zones: Vec<Zone>,
}

impl TerrainConfig {
    /// Configuration with the three parameters of thesis B. All other fields have their defaults.
    ///
    /// # Errors
    /// [`InputError`] as [`TerrainConfig::validate`].
    pub fn new(patch_size: u32, scale_factor: f64, seed: &str) -> Result<Self, InputError> {
        let config = Self {
            patch_size,
            scale_factor,
            seed: seed.to_owned(),
            roughness: 1.0,
            coarse_levels: 0,
            offset: Offset::Signed,
            generator: HeightGenerator::DiamondSquare,
            interpolation: HeightInterpolation::Linear,
            border: Border::Seamless,
            corners: [0.0; 4],
            terrain_scale: 1.0,
            texture_tile: None,
            triplanar: false,
            variation: 0.0,
            zones: Zone::defaults(scale_factor, Offset::Signed),
        };
        config.validate()?;
        Ok(config)
    }

    /// Reads a configuration from a JSON file. Texture paths in the file's zones are relative to the file.
    ///
    /// # Errors
    /// [`Error::File`] when the file cannot be read; [`Error::InputFile`] for the errors of [`TerrainConfig::from_json`].
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        let text = read_text(path)?;
        let mut config =
            Self::from_json(&text).map_err(|source| Error::InputFile { path: path.to_owned(), source })?;
        config.resolve_textures(path);
        Ok(config)
    }

    /// Resolves texture paths relative to the folder of `path`, the file that names the textures.
    pub(crate) fn resolve_textures(&mut self, path: &Path) {
        let folder = path.parent().unwrap_or(Path::new(""));
        for zone in &mut self.zones {
            zone.resolve_texture(folder);
        }
    }

    /// Checks every field. Every function that takes a `TerrainConfig` makes this check.
    ///
    /// # Errors
    /// [`InputError`] for the first field that is out of bounds.
    pub fn validate(&self) -> Result<(), InputError> {
        let size = self.patch_size;
        if !(3..=4097).contains(&size) || !(size - 1).is_power_of_two() {
            return Err(InputError::new(
                "patch_size",
                size,
                "must be 2^n + 1 with n in 1..=12 (3, 5, 9, … 4097)",
            ));
        }
        finite("scale_factor", self.scale_factor, 0.0, f64::MAX)?;
        finite("roughness", self.roughness, 0.0, f64::MAX)?;
        InputError::check_within("coarse_levels", self.coarse_levels, 0..=8)?;
        check_terrain_scale(self.terrain_scale)?;
        if let Some(tile) = self.texture_tile {
            finite("texture_tile", tile, self.edge_length() / MAX_TILES, f64::MAX)?;
        }
        finite("variation", self.variation, 0.0, 1.0)?;
        let most = HEIGHT_LIMIT as f64 / HEIGHT_ONE;
        for (index, &corner) in self.corners.iter().enumerate() {
            finite(&format!("corners[{index}]"), corner, -most, most)?;
        }
        self.validate_border()?;
        self.validate_generator()?;
        self.check_overflow(0, false)?;
        check_zone_count(self.zones.len())?;
        for (index, zone) in self.zones.iter().enumerate() {
            zone.validate(&format!("zones[{index}]"))?;
        }
        Ok(())
    }

    fn validate_border(&self) -> Result<(), InputError> {
        if self.border == Border::Seamless {
            if self.corners != [0.0; 4] {
                let bound = "only the borders \"wrap\" and \"blend\" have corners";
                return Err(InputError::new("corners", format!("{:?}", self.corners), bound));
            }
        } else if self.coarse_levels != 0 {
            let bound = "must be 0 unless border is \"seamless\": a patch by itself has nothing coarser";
            return Err(InputError::new("coarse_levels", self.coarse_levels, bound));
        }
        if self.interpolation == HeightInterpolation::Smooth && self.border != Border::Seamless {
            let bound =
                "must be \"linear\" unless border is \"seamless\": a patch by itself has too few neighbours";
            return Err(InputError::new("interpolation", "smooth", bound));
        }
        match self.border {
            Border::Blend(width) if width == 0 || width >= self.patch_size => {
                let bound = format!("must be in 1..={} (a patch has one sample more)", self.patch_size - 1);
                Err(InputError::new("border.blend", width, bound))
            }
            _ => Ok(()),
        }
    }

    /// Refuses fields that have a meaning for diamond-square only.
    fn validate_generator(&self) -> Result<(), InputError> {
        if self.generator == HeightGenerator::DiamondSquare {
            return Ok(());
        }
        let seamless =
            "must be \"seamless\" unless generator is \"diamondSquare\": noise covers the whole plane";
        let border = || format!("{:?}", self.border).to_lowercase();
        InputError::check(self.border == Border::Seamless, "border", border(), || seamless)?;
        let signed = "must be \"signed\" unless generator is \"diamondSquare\": noise has both signs";
        let offset = || format!("{:?}", self.offset).to_lowercase();
        InputError::check(self.offset == Offset::Signed, "offset", offset(), || signed)?;
        let linear =
            "must be \"linear\" unless generator is \"diamondSquare\": noise has an interpolation of its own";
        InputError::check(
            self.interpolation == HeightInterpolation::Linear,
            "interpolation",
            "smooth",
            || linear,
        )
    }

    /// Refuses a configuration whose heights could exceed 2^30 − 1 in 1/65536 units ([`HEIGHT_LIMIT`]). `largest_feature` is the
    /// largest absolute feature height in the same units. With smooth interpolation, heights are clamped to the limit, so only an
    /// overflow before the clamp is refused.
    ///
    /// # Errors
    /// [`InputError`] that names `scale_factor` or `precomputed_heights`.
    pub(crate) fn check_overflow(&self, largest_feature: i64, additive: bool) -> Result<(), InputError> {
        if self.interpolation == HeightInterpolation::Smooth {
            return self.check_smooth(largest_feature);
        }
        if self.generator != HeightGenerator::DiamondSquare {
            return self.check_noise();
        }
        let corner =
            self.corners.iter().map(|height| (height.abs() * HEIGHT_ONE).round()).fold(0.0, f64::max);
        let feature = largest_feature as f64;
        let mut bound = match self.border {
            Border::Seamless => self.range(0) + feature,
            Border::Wrap | Border::Blend(_) => corner + feature,
        };
        for level in 0..self.levels() {
            bound += 2.0 * (self.range(level) + if additive { feature } else { 0.0 });
        }
        if bound > HEIGHT_LIMIT as f64 {
            let highest = bound / HEIGHT_ONE;
            let most = HEIGHT_LIMIT as f64 / HEIGHT_ONE;
            let bound = format!(
                "heights could reach {highest:.5} units with these ranges, corners and features; the bound is {most:.5}"
            );
            return Err(InputError::new("scale_factor", self.scale_factor, bound));
        }
        Ok(())
    }

    /// Bound of the noise generators: octave l contributes at most r_l, the random heights of the base lattice r_0 / 2, and
    /// every octave is rounded down by less than one unit. The second r_0 keeps r_0 below 2^29, which products in the noise need.
    fn check_noise(&self) -> Result<(), InputError> {
        let octaves = self.octaves(0);
        let ranges: f64 = (0..octaves).map(|octave| self.range(octave) + 1.0).sum();
        let highest = (self.range(0) + ranges) / HEIGHT_ONE;
        let most = HEIGHT_LIMIT as f64 / HEIGHT_ONE;
        let bound =
            || format!("heights could reach {highest:.5} units with these ranges; the bound is {most:.5}");
        InputError::check(highest <= most, "scale_factor", self.scale_factor, bound)
    }

    fn check_smooth(&self, largest_feature: i64) -> Result<(), InputError> {
        let most = SMOOTH_LIMIT as f64 / HEIGHT_ONE;
        let feature = largest_feature as f64 / HEIGHT_ONE;
        for (field, units, value) in [
            ("scale_factor", self.range(0), self.scale_factor),
            ("precomputed_heights", largest_feature as f64, feature),
        ] {
            if units > SMOOTH_LIMIT as f64 {
                let bound = format!("must be at most {most} in size where interpolation is smooth");
                return Err(InputError::new(field, value, bound));
            }
        }
        Ok(())
    }

    /// Exponent n, where `patch_size` = 2^n + 1.
    pub(crate) fn exponent(&self) -> u32 {
        (self.patch_size - 1).ilog2()
    }

    /// Number of subdivisions from the coarsest lattice down to the samples: L = n + k, where `patch_size` is 2^n + 1 and k is
    /// `coarse_levels`.
    pub fn levels(&self) -> u32 {
        self.exponent() + self.coarse_levels
    }

    /// Number of octaves of noise in the samples of a region that is `coarser` levels coarser than the terrain.
    ///
    /// Fbm: as many as there are subdivisions, because finer octaves are 0 at these samples; at least octave 0, which also has
    /// the random heights of the base lattice. Ridged and simplex noise do not vanish at samples. Their octaves are the same
    /// at every resolution, down to a lattice of 8 world coordinates (1/512 of a patch's edge).
    pub(crate) fn octaves(&self, coarser: u32) -> u32 {
        match self.generator {
            HeightGenerator::DiamondSquare => 0,
            HeightGenerator::Fbm => self.levels().saturating_sub(coarser).max(1),
            HeightGenerator::Ridged | HeightGenerator::Simplex => self.base_log2() - 2,
        }
    }

    /// Binary logarithm of the base lattice's spacing in integer world coordinates, 12 to 20.
    pub(crate) fn base_log2(&self) -> u32 {
        PATCH_EDGE.ilog2() + self.coarse_levels
    }

    /// Length of a patch's edge in world units.
    pub fn edge_length(&self) -> f64 {
        f64::from(self.patch_size - 1) * self.terrain_scale
    }

    /// Number of texture tiles along a patch's edge.
    pub fn tiles_per_patch(&self) -> f64 {
        self.texture_tile.map_or(10.0 * self.terrain_scale, |tile| self.edge_length() / tile)
    }

    /// Edge length of a texture tile in world units.
    pub(crate) fn tile(&self) -> f64 {
        self.edge_length() / self.tiles_per_patch()
    }

    /// Distance between neighbouring samples, in integer world coordinates ([`PATCH_EDGE`] per patch).
    pub(crate) fn sample_spacing(&self) -> i64 {
        PATCH_EDGE >> self.exponent()
    }

    /// Range r_l of the random offsets at level `level`, in 1/65536 height units, rounded to nearest with ties to even.
    pub fn level_range(&self, level: u32) -> u32 {
        self.range(level) as u32
    }

    /// Range of the random offsets of edge points at level `level` with smooth interpolation, in 1/65536 height units. It is the
    /// level's rounded range times 2^(−roughness / 2), the factor by which the range shrinks over half a level (Saupe,
    /// "Algorithms for random fractals", in The Science of Fractal Images, 1988).
    pub fn edge_range(&self, level: u32) -> u32 {
        (self.range(level) * libm::exp2(-self.roughness / 2.0)).round_ties_even() as u32
    }

    // `libm::exp2` is pure Rust. A C library could give different bits on different platforms.
    fn range(&self, level: u32) -> f64 {
        (self.scale_factor * libm::exp2(-self.roughness * f64::from(level)) * HEIGHT_ONE).round_ties_even()
    }

    /// Key of the random number generator, derived from the seed.
    pub fn key(&self) -> [u32; 2] {
        crate::hash::key_of(&self.seed)
    }

    /// Corner heights as integers in 1/65536 height units.
    pub(crate) fn fixed_corners(&self) -> [i32; 4] {
        self.corners.map(|height| (height * HEIGHT_ONE).round_ties_even() as i32)
    }
}

/// Checks that the distance between neighbouring samples is 1e-6 to 1e6 world units.
pub(crate) fn check_terrain_scale(terrain_scale: f64) -> Result<(), InputError> {
    finite("terrain_scale", terrain_scale, 1e-6, 1e6)
}

/// Checks that a number is finite and in `low..=high`.
pub(crate) fn finite<T>(field: &str, value: T, low: f64, high: f64) -> Result<(), InputError>
where
    T: Copy + Into<f64> + std::fmt::Display,
{
    let number: f64 = value.into();
    if number.is_finite() && (low..=high).contains(&number) {
        return Ok(());
    }
    let bound = match (low > -f64::MAX, high < f64::MAX) {
        (true, true) => format!("must be a number in {low}..={high}"),
        (true, false) => format!("must be a finite number ≥ {low}"),
        _ => "must be a finite number".to_owned(),
    };
    Err(InputError::new(field, value, bound))
}
