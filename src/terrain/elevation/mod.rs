//! Elevation maps in endless terrain: heights of the caller, at the terrain's resolution or coarser, in tiles of several
//! resolutions. Around a map, and between its samples, heights are generated.
//!
//! The heights of the lattice on which the map's samples lie are the map's, where it has any, and generated elsewhere. All finer
//! lattices are subdivided from this one; coarser lattices have every 2^l-th of its heights.

#[cfg(not(target_arch = "wasm32"))]
mod loader;
mod tiles;

use std::fmt::Debug;
use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::terrain::config::{Border, HEIGHT_LIMIT, HEIGHT_ONE, HeightGenerator, TerrainConfig};
use crate::terrain::window::Region;
use crate::{Error, InputError};

#[cfg(not(target_arch = "wasm32"))]
pub use loader::ElevationLoader;
pub use tiles::ElevationTiles;

/// Number of samples along an edge of a tile.
pub const TILE_SIZE: u32 = 256;

/// Largest number of samples along an edge of an elevation map.
pub const MOST_SAMPLES: u32 = 16_384;

/// Distance in samples of a map over which a sample may influence finer heights around it.
pub(crate) const INFLUENCE: i64 = 4;

/// Where the samples of an elevation map lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElevationLayout {
    /// Number of samples of the terrain from one sample of the map to the next, a power of two.
    pub spacing: u32,
    /// Column and row of the first sample, in samples of the map, counted from the first sample of patch (0, 0).
    pub first: [i32; 2],
    /// Number of columns and rows, 2 to [`MOST_SAMPLES`].
    pub size: [u32; 2],
}

/// An elevation map, to be made into [`ElevationTiles`].
#[derive(Debug, Clone, PartialEq)]
pub struct ElevationMap {
    /// Where the samples lie.
    pub layout: ElevationLayout,
    /// The heights in height units, row by row, below 16384 in size.
    pub heights: Vec<f32>,
    /// Number of samples from the map's border inwards over which the map blends with generated heights; at most half of its
    /// columns and rows. 0: the map ends at a cliff.
    pub margin: u32,
}

/// A tile: its level, and its column and row among the tiles of this level. Tiles of level 0 have the map's samples, and tiles of
/// level l every 2^l-th. Tile (0, 0) of each level begins at the first sample of patch (0, 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TileNumber {
    /// The level; 0 is the finest.
    pub level: u32,
    /// Column and row, in edges of tiles of this level to the east and to the south.
    pub at: [i32; 2],
}

/// Heights of a tile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElevationTile {
    /// [`TILE_SIZE`]² heights in 1/65536 height units, row by row, below 2^30 in size. Samples outside the map may have any height.
    pub heights: Vec<i32>,
    /// In the same units: the largest vertical distance between the heights of the map's lattice and the triangles of this level. It is
    /// taken over the cells whose north-western corner is in the tile and that reach within 4 samples of the map; heights outside the
    /// map are the generated ones. The diagonal of a cell runs from south-west to north-east. 0 for tiles of level 0.
    pub deviation: u32,
    /// In the same units: the largest second difference of neighbouring heights of the map's lattice in the tile and 8 samples
    /// around it: along rows, along columns, and the twist of a cell. Tiles of level 0 need none.
    pub second_difference: u32,
}

/// What [`ElevationSource`] tells about its tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ElevationInfo {
    /// Where the samples of the map lie.
    pub layout: ElevationLayout,
    /// Number of levels of tiles above level 0, 0 to 20.
    pub levels: u32,
    /// The largest distance between the map and the heights that are generated without it, in 1/65536 height units, below 2^31.
    pub apart: u32,
}

/// A source of tiles: a whole map ([`ElevationTiles`]), or tiles that arrive one by one, from a disk or over a network.
///
/// [`Scene::record`](crate::scene::Scene::record) asks for the tiles that a frame lacks, again in every frame until they are there: those
/// of coarse nodes first, then those of the nearest. [`Scene::ground`](crate::scene::Scene::ground) and
/// [`Scene::pick`](crate::scene::Scene::pick) ask too.
pub trait ElevationSource: Debug + Send + Sync {
    /// Where the tiles lie. It must not change.
    fn info(&self) -> ElevationInfo;

    /// A tile with samples or cells within 4 samples of the map; `None` if it is still on its way. The first request should start its
    /// way. The function must not wait. A tile that was there may be on its way again later. The same tile must always have the same
    /// heights.
    ///
    /// # Errors
    /// A tile that will never arrive. The frame that asks for it fails.
    fn tile(&self, number: TileNumber) -> Result<Option<Arc<ElevationTile>>, Error>;
}

impl ElevationLayout {
    /// Number of levels by which the map is coarser than the terrain.
    pub(crate) fn coarser(&self) -> u32 {
        self.spacing.ilog2()
    }

    /// Columns and rows of the map.
    pub(crate) fn samples(&self) -> [RangeInclusive<i64>; 2] {
        [0, 1].map(|axis| {
            let first = i64::from(self.first[axis]);
            first..=first + i64::from(self.size[axis]) - 1
        })
    }

    /// Columns and rows of the cells of a level that the map influences.
    pub(crate) fn cells(&self, level: u32) -> [RangeInclusive<i64>; 2] {
        let cell = |range: RangeInclusive<i64>| {
            (range.start() - INFLUENCE) >> level..=(range.end() + INFLUENCE) >> level
        };
        self.samples().map(cell)
    }

    /// Checks a layout for a terrain.
    ///
    /// # Errors
    /// [`InputError`] that names `spacing`, `size` or `first`; `border` and `generator` of a configuration that takes no map.
    pub fn validate(&self, config: &TerrainConfig) -> Result<(), InputError> {
        let bound = || "must be \"seamless\" where a map is given";
        InputError::check(config.border == Border::Seamless, "border", "given", bound)?;
        let most = 1_u32 << config.levels().saturating_sub(1);
        let is_spacing = self.spacing.is_power_of_two() && self.spacing <= most;
        InputError::check(is_spacing, "spacing", self.spacing, || {
            format!("must be a power of two, at most {most}: half the distance of the base lattice's points")
        })?;
        let is_square = config.generator == HeightGenerator::DiamondSquare || self.spacing == 1;
        let bound =
            || "must be 1 unless the generator is \"diamondSquare\", which alone subdivides given heights";
        InputError::check(is_square, "spacing", self.spacing, bound)?;
        for (axis, size) in self.size.into_iter().enumerate() {
            InputError::check_within(format!("size[{axis}]"), size, 2..=MOST_SAMPLES)?;
        }
        let width = self.size[0].max(self.size[1]);
        Region { first: self.first.map(i64::from), width, coarser: self.coarser() }.validate(config)
    }
}

#[cfg(feature = "gpu")]
impl ElevationInfo {
    /// Checks the layout, the levels and the difference.
    ///
    /// # Errors
    /// [`InputError`] as [`ElevationLayout::validate`], or that names `levels` or `apart`.
    pub(crate) fn validate(&self, config: &TerrainConfig) -> Result<(), InputError> {
        self.layout.validate(config)?;
        InputError::check_within("levels", self.levels, 0..=20)?;
        InputError::check_within("apart", self.apart, 0..=2 * HEIGHT_LIMIT as u32)
    }
}

impl ElevationMap {
    /// A map from the brightness of an image, of its full bit depth: black is the height `range[0]`, white `range[1]`. The map lies
    /// at the origin, with the terrain's spacing and without a margin.
    pub fn of_brightness(image: image::DynamicImage, range: [f32; 2]) -> Self {
        let size = [image.width(), image.height()];
        let height = |sample: u16| {
            let [low, high] = range.map(f64::from);
            (low + (high - low) * f64::from(sample) / 65_535.0) as f32
        };
        let heights = image.into_luma16().into_raw().into_iter().map(height).collect();
        Self { layout: ElevationLayout { spacing: 1, first: [0, 0], size }, heights, margin: 0 }
    }

    /// Checks the map for a terrain.
    ///
    /// # Errors
    /// [`InputError`] as [`ElevationLayout::validate`], or that names `heights` or `margin`.
    pub fn validate(&self, config: &TerrainConfig) -> Result<(), InputError> {
        config.validate()?;
        self.layout.validate(config)?;
        let [columns, rows] = self.layout.size;
        let count = columns as usize * rows as usize;
        InputError::check_same("heights.len", self.heights.len(), count, "columns × rows")?;
        let most = HEIGHT_LIMIT as f64 / HEIGHT_ONE;
        for (at, height) in self.heights.iter().enumerate() {
            let is_height = f64::from(height.abs()) <= most;
            InputError::check(
                is_height,
                format!("heights[{at}]"),
                height,
                || "must be finite and below 16384",
            )?;
        }
        InputError::check_within("margin", self.margin, 0..=columns.min(rows) / 2)
    }
}
