//! What covers the ground, as shaders take it: zones, the texels of their textures at the scale of a colour map, and how these lie
//! on the ground.

pub use crate::shared::terrain::texturing::{TILES_PERIOD, TRIPLANAR_PLANES};
pub use crate::shared::terrain::tiles::MapZone;
/// A zone as shaders take it ([`zone_of`]).
pub use crate::shared::terrain::zones::Zone as ShaderZone;
use crate::terrain::config::{
    Config, MAX_REPEATS, Slope, Zone, check_range, check_terrain_scale, check_zone_count, finite,
};
use crate::terrain::texture::{TEXTURE_SIZE, Texture};
use crate::{InputError, srgb};

/// 2^22 of these units are a texture tile, so that a word holds [`TILES_PERIOD`] tiles.
const TILE_ONE: f64 = 4_194_304.0;

/// A zone in the form of the shaders.
pub fn zone_of(zone: &Zone) -> ShaderZone {
    let Slope { min, max, fade } = zone.slope;
    // Tangents of half the angles at which a weight is 0 and 1; what begins at 0° or ends at 90° has no transition there.
    let half = |degrees: f64| libm::tan(degrees.clamp(0.0, 90.0).to_radians() / 2.0);
    let line = |from: f64, to: f64| {
        let [zero, one] = [half(from), half(to)];
        [(1.0 / (one - zero)) as f32, (-zero / (one - zero)) as f32]
    };
    ShaderZone {
        min: zone.min as f32,
        max: zone.max as f32,
        rise: if min > 0.0 { line(min - fade / 2.0, min + fade / 2.0) } else { [0.0, 1.0] },
        fall: if max < 90.0 { line(max + fade / 2.0, max - fade / 2.0) } else { [0.0, 1.0] },
        height_blend: zone.height_blend as f32,
        repeats: zone.repeats as f32,
    }
}

/// What covers the ground of colour maps.
#[derive(Debug, Clone, PartialEq)]
pub struct Cover {
    /// The zones, 1 to 32, each with a place in `texels`: `first`, and 4^`edge_log2` texels from there on.
    pub zones: Vec<MapZone>,
    /// Linear texels, row by row: red, green, blue, and the height in the texture, 16 bits each, 0 to 65535.
    pub texels: Vec<[u16; 4]>,
    /// World units between neighbouring samples.
    pub terrain_scale: f64,
    /// World units that a texture tile covers.
    pub tile: f64,
    /// The strength of the variation of colour, 0 to 1.
    pub variation: f32,
    /// Whether textures lie on steep ground from the sides too.
    pub triplanar: bool,
}

impl Cover {
    /// The cover of a configuration with one texture for each zone, of which it takes the mip level whose texels are nearest to
    /// the distance between samples.
    ///
    /// # Errors
    /// [`InputError`] where the numbers of zones and textures differ, and as [`Config::validate`].
    pub fn new(config: &Config, textures: &[Texture]) -> Result<Self, InputError> {
        config.validate()?;
        if textures.len() != config.zones.len() {
            let bound = format!("must be one for each of the {} zones", config.zones.len());
            return Err(InputError::new("textures.len", textures.len(), bound));
        }
        let tile = config.tile();
        let mut cover = Self {
            zones: Vec::new(),
            texels: Vec::new(),
            terrain_scale: config.terrain_scale,
            tile,
            variation: config.variation as f32,
            triplanar: config.triplanar,
        };
        for (zone, texture) in config.zones.iter().zip(textures) {
            let between = f64::from(TEXTURE_SIZE * zone.repeats) * config.terrain_scale / tile;
            let level = level_of(between);
            let first = cover.texels.len() as u32;
            cover.zones.push(MapZone { zone: zone_of(zone), first, edge_log2: TEXTURE_SIZE.ilog2() - level });
            cover.texels.extend(texture.mips[level as usize].chunks_exact(4).map(linear));
        }
        Ok(cover)
    }

    /// Checks that there are 1 to 32 zones with valid ranges, whose texels are there, and every other field.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self) -> Result<(), InputError> {
        check_terrain_scale(self.terrain_scale)?;
        finite("tile", self.tile, f64::MIN_POSITIVE, f64::MAX)?;
        finite("variation", self.variation, 0.0, 1.0)?;
        check_zone_count(self.zones.len())?;
        for (index, map_zone) in self.zones.iter().enumerate() {
            self.check_zone(&format!("zones[{index}]"), map_zone)?;
        }
        Ok(())
    }

    fn check_zone(&self, path: &str, MapZone { zone, first, edge_log2 }: &MapZone) -> Result<(), InputError> {
        check_range(path, zone.min.into(), zone.max.into())?;
        for (name, line) in [("rise", zone.rise), ("fall", zone.fall)] {
            for (at, value) in line.into_iter().enumerate() {
                finite(&format!("{path}.{name}[{at}]"), value, -1e6, 1e6)?;
            }
        }
        finite(&format!("{path}.height_blend"), zone.height_blend, 0.0, 1.0)?;
        finite(&format!("{path}.repeats"), zone.repeats, 1.0, MAX_REPEATS.into())?;
        if zone.repeats.fract() != 0.0 {
            return Err(InputError::new(format!("{path}.repeats"), zone.repeats, "must be a whole number"));
        }
        let most = TEXTURE_SIZE.ilog2();
        InputError::check_within(format!("{path}.edge_log2"), *edge_log2, 0..=most)?;
        let end = u64::from(*first) + (1 << (2 * edge_log2));
        if end > self.texels.len() as u64 {
            let bound =
                format!("must leave room for {} texels in {}", 1_u64 << (2 * edge_log2), self.texels.len());
            return Err(InputError::new(format!("{path}.first"), first, bound));
        }
        Ok(())
    }

    /// The texels as the colour map reads them: red and green in the halves of a word, blue and height in those of another.
    #[cfg(feature = "gpu")]
    pub fn packed_texels(&self) -> Vec<[u32; 2]> {
        let packed = |texel: &[u16; 4]| {
            let [red, green, blue, height] = texel.map(u32::from);
            [red | green << 16, blue | height << 16]
        };
        self.texels.iter().map(packed).collect()
    }

    /// Tiles per sample and per unit of height, in 2^-22 tiles.
    pub fn steps(&self) -> [u32; 2] {
        [self.terrain_scale / self.tile, 1.0 / self.tile].map(|tiles| (tiles * TILE_ONE).round() as u32)
    }

    /// The position in tiles of the first sample of a patch, in 2^-22 tiles and without whole multiples of [`TILES_PERIOD`], from
    /// the column and row of the patch and the samples along its edge.
    pub fn place(&self, patch: [i32; 2], patch_size: u32) -> [u32; 2] {
        let tiles = f64::from(patch_size.saturating_sub(1)) * self.terrain_scale / self.tile;
        // Rounding up to the period itself gives 0.
        let fixed = |index: i32| (f64::from(index) * tiles).rem_euclid(TILES_PERIOD.into()) * TILE_ONE;
        patch.map(|index| fixed(index).round() as u64 as u32)
    }
}

/// The number of planes from which textures lie on the ground.
#[cfg(feature = "gpu")]
pub fn planes(triplanar: bool) -> u32 {
    if triplanar { TRIPLANAR_PLANES } else { 1 }
}

/// The mip level whose texels are nearest to the distance between samples, which is that of so many texels of level 0.
fn level_of(between: f64) -> u32 {
    (0..TEXTURE_SIZE.ilog2())
        .find(|level| between < f64::from(1 << level) * std::f64::consts::SQRT_2)
        .unwrap_or(TEXTURE_SIZE.ilog2())
}

/// A texel in linear light.
fn linear(texel: &[u8]) -> [u16; 4] {
    let color = |channel: usize| (srgb::linear(texel[channel]) * 65_535.0 + 0.5) as u16;
    [color(0), color(1), color(2), u16::from(texel[3]) * 257]
}
