//! The elevation map of an endless terrain: which heights it gives to a region, and how far these lie from the map's finest.

use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::terrain::config::{HEIGHT_LIMIT, TerrainConfig};
use crate::terrain::elevation::{ElevationInfo, ElevationSource, ElevationTile, TILE_SIZE, TileNumber};
use crate::terrain::lattice::Given;
use crate::terrain::remainder::remainder;
use crate::terrain::replace::NOT_GIVEN;
use crate::terrain::window::Region;
use crate::{Error, InputError};

/// The heights of a map and what lies between them can be apart by this much more than the map is apart from generated heights:
/// finer heights by 1 + 4 · 0.561 times (see [`remainder`]), triangles by 1.
const FARTHEST: f64 = 4.25;

/// An elevation map.
#[derive(Debug, Clone)]
pub(super) struct Elevation {
    source: Arc<dyn ElevationSource>,
    info: ElevationInfo,
}

/// What a map gives to a node.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NodeElevation {
    /// The heights of a region, row by row; [`NOT_GIVEN`] where the map has none.
    pub heights: Arc<Vec<i32>>,
    /// The same of the region that is generated and eroded for the node; `None` for a node that is not eroded.
    pub around: Option<Arc<Vec<i32>>>,
    pub beyond: Beyond,
}

/// What lies below the heights from which a node is made, in 1/65536 height units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beyond {
    /// Generated heights alone: the region is at most as coarse as the map.
    Generated,
    /// The map's heights are at most this far from the region's triangles, and generated ones as far as they are without a map.
    Map(i64),
    /// All heights are at most this much further from the region's triangles than they are without a map.
    Further(i64),
}

impl Elevation {
    /// # Errors
    /// [`InputError`] below `elevation` for a layout that does not suit the terrain.
    pub fn new(source: &Arc<dyn ElevationSource>, config: &TerrainConfig) -> Result<Self, InputError> {
        let info = source.info();
        info.validate(config).map_err(|error| error.below("elevation"))?;
        Ok(Self { source: source.clone(), info })
    }

    /// Number of levels by which the map is coarser than the terrain.
    pub fn coarser(&self) -> u32 {
        self.info.layout.coarser()
    }

    /// Whether the map influences heights of a region.
    pub fn reaches(&self, region: Region) -> bool {
        let near = self.info.layout.cells(0);
        let first = near.each_ref().map(|range| range.start() << self.coarser());
        let last = near.each_ref().map(|range| range.end() << self.coarser());
        (0..2).all(|axis| {
            let start = region.first[axis] << region.coarser;
            let end = (region.first[axis] + i64::from(region.width) - 1) << region.coarser;
            start <= last[axis] && end >= first[axis]
        })
    }

    /// The heights that the map gives to a region that is at least as coarse as the map; `None` while tiles are on their way.
    ///
    /// # Errors
    /// Those of the source; [`InputError`] for a tile of another size.
    pub fn heights(&self, region: Region) -> Result<Option<Vec<i32>>, Error> {
        let step = region.coarser - self.coarser();
        let level = step.min(self.info.levels);
        // Each column of the region is every `stride`th of the tiles' level.
        let (stride, size) = (1_i64 << (step - level), i64::from(TILE_SIZE));
        let samples = self.info.layout.samples();
        let given = [0, 1].map(|axis| {
            let (range, first) = (&samples[axis], region.first[axis]);
            let last = first + i64::from(region.width) - 1;
            divided_up(*range.start(), 1 << step).max(first)..=(range.end() >> step).min(last)
        });
        let tiles = given
            .each_ref()
            .map(|range| (range.start() * stride).div_euclid(size)..=(range.end() * stride).div_euclid(size));
        let width = region.width as usize;
        let (mut heights, mut is_whole) = (vec![NOT_GIVEN; width * width], true);
        for at in tiles[1].clone().flat_map(|row| tiles[0].clone().map(move |column| [column, row])) {
            // The region's columns and rows in the tile.
            let [columns, rows] = [0, 1].map(|axis| {
                let first = divided_up(at[axis] * size, stride).max(*given[axis].start());
                let last = (at[axis] * size + size - 1).div_euclid(stride).min(*given[axis].end());
                first..=last
            });
            if columns.is_empty() || rows.is_empty() {
                continue;
            }
            let Some(tile) = self.tile(TileNumber { level, at: at.map(|at| at as i32) })? else {
                is_whole = false;
                continue;
            };
            for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
                let from = (row * stride).rem_euclid(size) * size + (column * stride).rem_euclid(size);
                let to = (row - region.first[1]) as usize * width + (column - region.first[0]) as usize;
                let height = tile.heights[from as usize];
                let bound = || "must be below 2^30 in size";
                let is_height = height.unsigned_abs() <= HEIGHT_LIMIT as u32;
                InputError::check(is_height, "elevation.tile.heights", height, bound)?;
                heights[to] = height;
            }
        }
        Ok(is_whole.then_some(heights))
    }

    /// What lies below a region of a node. `cells` are the node's cells, without its margin. `None` while tiles are on their way.
    ///
    /// # Errors
    /// Those of the source; [`InputError`] for a tile of another size.
    pub fn beyond(
        &self,
        config: &TerrainConfig,
        coarser: u32,
        cells: [RangeInclusive<i64>; 2],
    ) -> Result<Option<Beyond>, Error> {
        if coarser <= self.coarser() {
            return Ok(Some(Beyond::Generated));
        }
        let level = coarser - self.coarser();
        if level > self.info.levels {
            let most = (f64::from(self.info.apart) * FARTHEST).ceil();
            return Ok(Some(Beyond::Further(most as i64)));
        }
        let size = i64::from(TILE_SIZE);
        let near = self.info.layout.cells(level);
        let tiles = [0, 1].map(|axis| {
            let (near, own) = (&near[axis], &cells[axis]);
            near.start().max(own.start()).div_euclid(size)..=near.end().min(own.end()).div_euclid(size)
        });
        let (mut deviation, mut second, mut is_whole) = (0, 0, true);
        for row in tiles[1].clone() {
            for column in tiles[0].clone() {
                let number = TileNumber { level, at: [column as i32, row as i32] };
                let Some(tile) = self.tile(number)? else {
                    is_whole = false;
                    continue;
                };
                deviation = deviation.max(tile.deviation);
                second = second.max(tile.second_difference);
            }
        }
        let between = remainder(config, self.coarser(), second.into());
        Ok(is_whole.then_some(Beyond::Map(i64::from(deviation) + between)))
    }

    fn tile(&self, number: TileNumber) -> Result<Option<Arc<ElevationTile>>, Error> {
        let tile = self.source.tile(number)?;
        let size = TILE_SIZE as usize;
        if let Some(tile) = tile.as_ref().filter(|tile| tile.heights.len() != size * size) {
            let bound = format!("must be {TILE_SIZE} × {TILE_SIZE} heights");
            return Err(InputError::new("elevation.tile.heights.len", tile.heights.len(), bound).into());
        }
        Ok(tile)
    }

    /// Calls `made` with the map's heights on its own lattice, for the region of samples `region`. `None` while tiles are on their
    /// way.
    ///
    /// # Errors
    /// Those of the source; [`InputError`] for a tile of another size.
    pub fn given<T>(
        &self,
        config: &TerrainConfig,
        region: Region,
        made: impl FnOnce(&Given<'_>) -> T,
    ) -> Result<Option<T>, Error> {
        let lattice = config.levels() - self.coarser();
        let spans = region.levels(config)[lattice as usize];
        let width = spans[0].width().max(spans[1].width()) as u32;
        let first = spans.map(|span| span.first);
        let Some(heights) = self.heights(Region { first, width, coarser: self.coarser() })? else {
            return Ok(None);
        };
        let at = |point: [i64; 2]| {
            let [column, row] = [0, 1].map(|axis| (point[axis] - first[axis]) as usize);
            heights.get(row * width as usize + column).copied().filter(|height| *height != NOT_GIVEN)
        };
        Ok(Some(made(&Given { coarser: self.coarser(), at: &at })))
    }
}

/// A quotient, rounded up.
fn divided_up(number: i64, by: i64) -> i64 {
    -(-number).div_euclid(by)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::threefry2x32;
    use crate::terrain::config::HeightInterpolation;
    use crate::terrain::elevation::{ElevationLayout, ElevationMap, ElevationTiles};
    use crate::terrain::features::Features;
    use crate::terrain::field::{region, region_of};
    use crate::terrain::remainder::tests::{CELLS, exact};

    /// On random nodes in a map, at its border and around it, no sample is further from the triangles than the bound. Without the
    /// map's part, many are.
    #[test]
    fn random_nodes_are_within_the_bound() {
        use HeightInterpolation::{Linear, Smooth};
        for (interpolation, spacing, margin) in
            [(Linear, 1, 12), (Smooth, 2, 0), (Smooth, 1, 20), (Linear, 4, 3)]
        {
            let config = TerrainConfig {
                interpolation,
                coarse_levels: 3,
                ..TerrainConfig::new(65, 20.0, "tiles").expect("valid")
            };
            let size = [90, 70];
            let height = |at: u32| {
                let stone = (at.wrapping_mul(2_654_435_761) >> 24) as f32 * 0.02;
                30.0 * (at as f32 * 0.011).sin() + stone
            };
            let layout = ElevationLayout { spacing, first: [-37, 13], size };
            let map = ElevationMap { layout, heights: (0..size[0] * size[1]).map(height).collect(), margin };
            let tiles: Arc<dyn ElevationSource> =
                Arc::new(ElevationTiles::new(&config, &map).expect("valid"));
            let elevation = Elevation::new(&tiles, &config).expect("valid");
            let none = Features::default();
            let heights = |of: Region| {
                if of.coarser > elevation.coarser() {
                    // Every so many samples of the map's lattice.
                    let step = 1 << (of.coarser - elevation.coarser());
                    let (width, coarser) = ((of.width - 1) * step + 1, elevation.coarser());
                    let fine = Region { first: of.first.map(|at| at * i64::from(step)), width, coarser };
                    let made =
                        elevation.given(&config, fine, |given| region_of(&config, &none, Some(given), fine));
                    let made = made.expect("loaded").expect("there");
                    let rows = made.chunks_exact(width as usize).step_by(step as usize);
                    return rows.flat_map(|row| row.iter().step_by(step as usize).copied()).collect();
                }
                let made = elevation.given(&config, of, |given| region_of(&config, &none, Some(given), of));
                made.expect("loaded").expect("there")
            };
            let (mut beyond, mut kinds) = (0, [0; 3]);
            for node in 0..150_u32 {
                let (words, _) = threefry2x32([node, 0x71e5], [0, 1, 2, 3, 4, 5, 6, 7], [0; 8]);
                let coarser = 1 + words[0] % 6;
                // Around the map's middle, in samples.
                let middle = [8, 48].map(|at| at * i64::from(spacing));
                let reach = 70 * i64::from(spacing);
                let first = [0, 1].map(|axis| {
                    (middle[axis] + i64::from(words[1 + axis]) % (2 * reach) - reach).div_euclid(1 << coarser)
                });
                let (bent, largest) = exact(&config, heights, coarser, first);
                let cells = first.map(|at| at..=at + CELLS as i64 - 1);
                let found = elevation.beyond(&config, coarser, cells).expect("loaded").expect("there");
                let (generated, _) = exact(&config, |of| region(&config, &none, of), coarser, first);
                let without = remainder(&config, coarser, generated);
                let bound = match found {
                    Beyond::Generated => remainder(&config, coarser, bent),
                    Beyond::Map(distance) => without.max(distance),
                    Beyond::Further(distance) => without + distance,
                };
                assert!(
                    largest <= bound as f64,
                    "{interpolation:?} {spacing} {coarser}: {largest} > {bound}"
                );
                beyond += usize::from(largest > without as f64);
                kinds[match found {
                    Beyond::Generated => 0,
                    Beyond::Map(_) => 1,
                    Beyond::Further(_) => 2,
                }] += 1;
            }
            println!("{interpolation:?} {spacing}: {beyond} of 150 beyond the plain bound, {kinds:?}");
            assert!(beyond > 20 && kinds[1] > 20 && kinds[2] > 10, "{beyond} {kinds:?}");
        }
    }
}
