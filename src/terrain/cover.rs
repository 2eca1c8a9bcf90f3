//! Ground cover in the form that shaders use: zones, texels of the zones' textures at the resolution of a colour map, and the
//! mapping of textures onto the ground.

pub use crate::shared::terrain::texturing::{TILES_PERIOD, TRIPLANAR_PLANES};
pub use crate::shared::terrain::tiles::MapZone;
/// A zone in the form that shaders use; [`zone_of`] computes it.
pub use crate::shared::terrain::zones::Zone as ShaderZone;
use crate::terrain::config::{
    MAX_REPEATS, Slope, TerrainConfig, Zone, check_range, check_terrain_scale, check_zone_count, finite,
};
use crate::terrain::texture::{TEXTURE_SIZE, TerrainTexture};
use crate::{InputError, srgb};

/// Fixed-point value of one texture tile, 2^22. A `u32` can therefore count [`TILES_PERIOD`] tiles.
const TILE_ONE: f64 = 4_194_304.0;

/// Converts a zone to the form that shaders use.
pub fn zone_of(zone: &Zone) -> ShaderZone {
    let Slope { min, max, fade } = zone.slope;
    // A slope is stored as the tangent of half its angle. A range that begins at 0° or ends at 90° has no transition at that end.
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

/// Ground cover of a colour map: zones and the texels of their textures.
#[derive(Debug, Clone, PartialEq)]
pub struct Cover {
    /// Zones, 1 to 32. A zone has 4^`edge_log2` texels, which start at `texels[first]`.
    pub zones: Vec<MapZone>,
    /// Linear texels of all zones, row by row: red, green, blue, and height in the texture; 16 bits each, 0 to 65535.
    pub texels: Vec<[u16; 4]>,
    /// World units between neighbouring samples.
    pub terrain_scale: f64,
    /// Edge length of a texture tile in world units.
    pub tile: f64,
    /// Strength of the colour variation, 0 to 1.
    pub variation: f32,
    /// Whether steep ground is also textured from the sides (triplanar mapping).
    pub triplanar: bool,
}

impl Cover {
    /// Creates the cover of a configuration, with one texture per zone. It takes one mip level of each texture: the level whose
    /// texel size is nearest to the distance between samples.
    ///
    /// # Errors
    /// [`InputError`] when the number of textures is not the number of zones, and as [`TerrainConfig::validate`].
    pub fn new(config: &TerrainConfig, textures: &[TerrainTexture]) -> Result<Self, InputError> {
        config.validate()?;
        let bound = || format!("must be one for each of the {} zones", config.zones.len());
        InputError::check(textures.len() == config.zones.len(), "textures.len", textures.len(), bound)?;
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

    /// Checks that there are 1 to 32 zones, that their ranges are valid and their texels exist, and checks every other field.
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

    /// Texels in the form that the colour map kernel reads, two words each. The first word has red in its low half and green in
    /// its high half; the second has blue and height.
    #[cfg(feature = "gpu")]
    pub fn packed_texels(&self) -> Vec<[u32; 2]> {
        let packed = |texel: &[u16; 4]| {
            let [red, green, blue, height] = texel.map(u32::from);
            [red | green << 16, blue | height << 16]
        };
        self.texels.iter().map(packed).collect()
    }

    /// Number of planes from which textures are projected onto the ground: 3 with triplanar mapping, otherwise 1.
    pub fn planes(&self) -> u32 {
        planes(self.triplanar)
    }

    /// Texture distance per sample and per unit of height, both in 2^-22 tiles.
    pub fn steps(&self) -> [u32; 2] {
        [self.terrain_scale / self.tile, 1.0 / self.tile].map(|tiles| (tiles * TILE_ONE).round() as u32)
    }

    /// Texture position of a patch's first sample (east, south) in 2^-22 tiles, modulo [`TILES_PERIOD`] tiles. `patch` is the
    /// patch's column and row. `patch_size` is the number of samples along the patch's edge.
    pub fn place(&self, patch: [i32; 2], patch_size: u32) -> [u32; 2] {
        let tiles = f64::from(patch_size.saturating_sub(1)) * self.terrain_scale / self.tile;
        // Rounding may give the period itself, which the conversion to `u32` wraps to 0.
        let fixed = |index: i32| (f64::from(index) * tiles).rem_euclid(TILES_PERIOD.into()) * TILE_ONE;
        patch.map(|index| fixed(index).round() as u64 as u32)
    }
}

/// Number of planes from which textures are projected: 3 with triplanar mapping, otherwise 1.
pub(crate) fn planes(triplanar: bool) -> u32 {
    if triplanar { TRIPLANAR_PLANES } else { 1 }
}

/// Mip level whose texel size is nearest to the distance between samples. `between` is this distance, in texels of level 0.
fn level_of(between: f64) -> u32 {
    (0..TEXTURE_SIZE.ilog2())
        .find(|level| between < f64::from(1 << level) * std::f64::consts::SQRT_2)
        .unwrap_or(TEXTURE_SIZE.ilog2())
}

/// Converts an sRGB texel with 8 bits per channel to linear light with 16 bits. The fourth channel is the height, which is only
/// widened to 16 bits.
fn linear(texel: &[u8]) -> [u16; 4] {
    let color = |channel: usize| (srgb::linear(texel[channel]) * 65_535.0 + 0.5) as u16;
    [color(0), color(1), color(2), u16::from(texel[3]) * 257]
}
