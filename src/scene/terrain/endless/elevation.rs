//! The elevation map of an endless terrain: which heights it gives to a region, and how far these lie from the map's finest.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::terrain::config::{HEIGHT_LIMIT, HEIGHT_ONE, TerrainConfig};
use crate::terrain::elevation::{
    ElevationInfo, ElevationSource, ElevationTile, INFLUENCE, TILE_SIZE, TileNumber,
};
use crate::terrain::features::Features;
use crate::terrain::fixed::{FeatureMode, inject};
use crate::terrain::injection::{ChangedPoint, FeatureOffsets};
use crate::terrain::lattice::{Given, limited};
use crate::terrain::remainder::remainder;
use crate::terrain::replace::NOT_GIVEN;
use crate::terrain::window::{Lattice, Region};
use crate::{Error, InputError};

/// The heights of a map and what lies between them can be apart by this much more than the map is apart from generated heights:
/// finer heights by 1 + 4 · 0.561 times (see [`remainder`]), triangles by 1.
const FARTHEST: f64 = 4.25;

/// An elevation map, with the injected heights of its own samples.
#[derive(Debug, Clone)]
pub(super) struct Elevation {
    source: Arc<dyn ElevationSource>,
    info: ElevationInfo,
    features: Features,
    /// Distance between samples of the terrain in world coordinates.
    spacing: i64,
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

impl NodeElevation {
    /// The lowest and the highest height in world units.
    pub fn range(&self) -> [f64; 2] {
        let given = self.heights.iter().filter(|height| **height != NOT_GIVEN);
        let [low, high] = [given.clone().min(), given.max()];
        [low, high].map(|height| height.map_or(0.0, |height| f64::from(*height) / HEIGHT_ONE))
    }
}

impl Elevation {
    /// # Errors
    /// [`InputError`] below `elevation` for a layout that does not suit the terrain.
    pub fn new(source: &Arc<dyn ElevationSource>, config: &TerrainConfig) -> Result<Self, InputError> {
        let info = source.info();
        info.validate(config).map_err(|error| error.below("elevation"))?;
        let (features, spacing) = (Features::default(), config.sample_spacing());
        Ok(Self { source: source.clone(), info, features, spacing })
    }

    /// Replaces the injected heights. Returns those that the generator injects: those of places that are no samples of the map.
    pub fn set_features(&mut self, features: &Features) -> Features {
        let (samples, step) = (self.info.layout.samples(), self.spacing << self.coarser());
        let is_own = |at: [i64; 2]| (0..2).all(|i| at[i] % step == 0 && samples[i].contains(&(at[i] / step)));
        let [own, other] = features.divided(is_own);
        self.features = own;
        other
    }

    /// The samples at which the injected heights of two maps differ. Regions of any resolution change.
    pub fn changed(&self, other: &Self) -> Vec<ChangedPoint> {
        let [one, two] = [self, other].map(|map| map.features.points().collect::<BTreeMap<_, _>>());
        let differs =
            |at: &&(i64, i64)| self.features.mode != other.features.mode || one.get(*at) != two.get(*at);
        let point = |(row, column): &(i64, i64)| ChangedPoint {
            at: [column / self.spacing, row / self.spacing],
            coarsest: u32::MAX,
            reach: INFLUENCE << self.coarser(),
            offset: 0,
        };
        one.keys().chain(two.keys()).copied().filter(differs).map(point).collect()
    }

    /// Whether heights at a column and row of samples that are none of the map's follow from it.
    pub fn is_near(&self, sample: [i64; 2]) -> bool {
        let near = self.info.layout.cells(0);
        self.coarser() > 0 && (0..2).all(|axis| near[axis].contains(&(sample[axis] >> self.coarser())))
    }

    /// The injected heights of the map that lie on the lattice of a region, by column and row in it.
    fn injected(&self, region: Region) -> Vec<(u32, u32, i32)> {
        let spacing = self.spacing << region.coarser;
        let origin = region.first.map(|first| first * spacing);
        self.features.on_lattice([0, 0], Lattice { origin, width: region.width, spacing }, false)
    }

    /// Number of levels by which the map is coarser than the terrain.
    pub fn coarser(&self) -> u32 {
        self.info.layout.coarser()
    }

    /// Whether the map influences heights of a region.
    pub fn reaches(&self, region: Region) -> bool {
        let near = self.info.layout.cells(0);
        (0..2).all(|axis| {
            let [first, last] = [near[axis].start(), near[axis].end()].map(|at| at << self.coarser());
            let start = region.first[axis] << region.coarser;
            start <= last && start + ((i64::from(region.width) - 1) << region.coarser) >= first
        })
    }

    /// The heights that the map gives to a region that is at least as coarse as the map, with those that are injected; `None` while
    /// tiles are on their way.
    ///
    /// # Errors
    /// As [`Self::plain`].
    pub fn heights(&self, region: Region) -> Result<Option<Vec<i32>>, Error> {
        Ok(self.plain(region)?.map(|heights| self.with_features(region, heights)))
    }

    /// Heights of the map with those that are injected.
    pub fn with_features(&self, region: Region, mut heights: Vec<i32>) -> Vec<i32> {
        for (column, row, injected) in self.injected(region) {
            let height = &mut heights[(row * region.width + column) as usize];
            *height = limited(inject(self.features.mode, *height, injected));
        }
        heights
    }

    /// The same as [`Self::heights`], without those that are injected.
    ///
    /// # Errors
    /// Those of the source; [`InputError`] for a tile of another size.
    pub fn plain(&self, region: Region) -> Result<Option<Vec<i32>>, Error> {
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

    /// Bound of the distance between the map's heights and the triangles of a coarser region, with the heights that are injected.
    /// `deviation` is the bound without them, for which the region has the heights `plain`.
    fn deviation(&self, region: Region, plain: &[i32], deviation: i64) -> i64 {
        // All samples of the map that change what lies below the region.
        let step = 1 << (region.coarser - self.coarser());
        let first = region.first.map(|first| first * step - INFLUENCE);
        let width = (i64::from(region.width) - 1) * step + 1 + 2 * INFLUENCE;
        let injected = self.injected(Region { first, width: width as u32, coarser: self.coarser() });
        if injected.is_empty() {
            return deviation;
        }
        // The host does not know the heights around the map.
        if plain.contains(&NOT_GIVEN) {
            return 2 * HEIGHT_LIMIT;
        }
        let is_kept = self.features.mode == FeatureMode::Keep;
        let own = injected.iter().map(|(_, _, height)| *height);
        let most = own.clone().map(|height| i64::from(height.unsigned_abs())).max().unwrap_or(0);
        let all = plain.iter().copied().chain(own.filter(|_| is_kept)).map(i64::from);
        let [low, high] = [all.clone().min(), all.max()].map(|height| height.unwrap_or(0));
        let added = if is_kept { 0 } else { 2 * most };
        high - low + added + deviation
    }

    /// Bounds the distance of finer heights from a region of a node; `None` while tiles are on their way. `plain` are the map's heights
    /// of the region, without those that are injected. `cells` are the node's, without its margin. `offsets` are those of the heights
    /// that the generator injects.
    ///
    /// # Errors
    /// Those of the source; [`InputError`] for a tile of another size.
    pub fn beyond(
        &self,
        config: &TerrainConfig,
        offsets: &FeatureOffsets,
        region: Region,
        plain: &[i32],
        cells: [RangeInclusive<i64>; 2],
    ) -> Result<Option<Beyond>, Error> {
        if region.coarser <= self.coarser() {
            return Ok(Some(Beyond::Generated));
        }
        let level = region.coarser - self.coarser();
        let influence = offsets.influence(region);
        if level > self.info.levels {
            // Too few heights to know what lies between them.
            let apart = self.deviation(region, &[NOT_GIVEN], i64::from(self.info.apart) + influence);
            return Ok(Some(Beyond::Further((apart as f64 * FARTHEST).ceil() as i64)));
        }
        let size = i64::from(TILE_SIZE);
        let near = self.info.layout.cells(level);
        let tiles = [0, 1].map(|axis| {
            let (near, own) = (&near[axis], &cells[axis]);
            near.start().max(own.start()).div_euclid(size)..=near.end().min(own.end()).div_euclid(size)
        });
        let (mut deviation, mut second, mut is_whole) = (0, 0, true);
        for at in tiles[1].clone().flat_map(|row| tiles[0].clone().map(move |column| [column, row])) {
            let Some(tile) = self.tile(TileNumber { level, at: at.map(|at| at as i32) })? else {
                is_whole = false;
                continue;
            };
            (deviation, second) = (deviation.max(tile.deviation), second.max(tile.second_difference));
        }
        let plain_deviation = i64::from(deviation) + influence;
        let deviation = self.deviation(region, plain, plain_deviation);
        // No sample of the map moves by more than this.
        let moved = if deviation > plain_deviation { deviation } else { influence };
        let between = remainder(config, self.coarser(), i64::from(second) + 4 * moved);
        Ok(is_whole.then_some(Beyond::Map(deviation + between)))
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

    /// Injected heights on the map of the test below and around it: a road, whose samples lie on many lattices, and single places.
    fn road(config: &TerrainConfig, mode: FeatureMode) -> Features {
        let along = (-80..170_i64).map(|x| ([x, 40 + x / 5], if mode == FeatureMode::Keep { 5 } else { -9 }));
        let places = (0..40_i64).map(|at| ([at * 67 % 500 - 200, at * 91 % 400 - 150], 30 - at));
        let points = places.chain(along).map(|([x, y], height)| {
            let [x, y] = [x, y].map(|at| at * config.sample_spacing());
            ((y, x), height as i32 * HEIGHT_ONE as i32)
        });
        Features::of_points(mode, points.collect())
    }

    /// On random nodes in a map, at its border and around it, no sample is further from the triangles than the bound, without and with
    /// injected heights. Without the map's part, many are.
    #[test]
    fn random_nodes_are_within_the_bound() {
        use FeatureMode::{Additive, Keep};
        use HeightInterpolation::{Linear, Smooth};
        let mut all_lacking = 0;
        let maps = [(Linear, 1, 12), (Smooth, 2, 0), (Smooth, 1, 20), (Linear, 4, 3)];
        for ((interpolation, spacing, margin), mode) in
            maps.into_iter().flat_map(|map| [None, Some(Keep), Some(Additive)].map(|mode| (map, mode)))
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
            let mut elevation = Elevation::new(&tiles, &config).expect("valid");
            let all = mode.map_or_else(Features::default, |mode| road(&config, mode));
            let generated = elevation.set_features(&all);
            let offsets = FeatureOffsets::new(&config, &generated, |sample| elevation.is_near(sample));
            let heights = |of: Region| {
                if of.coarser > elevation.coarser() {
                    // Every so many samples of the map's lattice.
                    let step = 1 << (of.coarser - elevation.coarser());
                    let (width, coarser) = ((of.width - 1) * step + 1, elevation.coarser());
                    let fine = Region { first: of.first.map(|at| at * i64::from(step)), width, coarser };
                    let made = elevation
                        .given(&config, fine, |given| region_of(&config, &generated, Some(given), fine));
                    let made = made.expect("loaded").expect("there");
                    let rows = made.chunks_exact(width as usize).step_by(step as usize);
                    return rows.flat_map(|row| row.iter().step_by(step as usize).copied()).collect();
                }
                let made =
                    elevation.given(&config, of, |given| region_of(&config, &generated, Some(given), of));
                made.expect("loaded").expect("there")
            };
            let bare = Elevation::new(&tiles, &config).expect("valid");
            let no_offsets = FeatureOffsets::default();
            let (mut beyond, mut known, mut lacking, mut kinds) = (0, 0, 0, [0; 3]);
            for node in 0..80_u32 {
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
                let around = first.map(|at| at - 8);
                let node = Region { first: around, width: CELLS as u32 + 17, coarser };
                let plain = match coarser > elevation.coarser() {
                    true => elevation.plain(node).expect("loaded").expect("there"),
                    false => Vec::new(),
                };
                let found = elevation.beyond(&config, &offsets, node, &plain, cells.clone());
                let found = found.expect("loaded").expect("there");
                let (generated, _) = exact(&config, |of| region(&config, &generated, of), coarser, first);
                let without = remainder(&config, coarser, generated);
                let bound_of = |found: Beyond| match found {
                    Beyond::Generated => remainder(&config, coarser, bent),
                    Beyond::Map(distance) => without.max(distance),
                    Beyond::Further(distance) => without + distance,
                };
                let bound = bound_of(found);
                let bare = bare.beyond(&config, &no_offsets, node, &plain, cells);
                lacking += usize::from(largest > bound_of(bare.expect("loaded").expect("there")) as f64);
                let own = heights(node).into_iter().map(i64::from);
                let range = [own.clone().min(), own.max()].map(|height| height.expect("some"));
                let injected = offsets.bound(&config, node, [range[0] - bound, range[1] + bound]);
                let bound = bound + injected;
                assert!(
                    largest <= bound as f64,
                    "{interpolation:?} {spacing} {mode:?} {coarser}: {largest} > {bound}"
                );
                beyond += usize::from(largest > without as f64);
                known += usize::from(bound < 2 * HEIGHT_LIMIT);
                kinds[match found {
                    Beyond::Generated => 0,
                    Beyond::Map(_) => 1,
                    Beyond::Further(_) => 2,
                }] += 1;
            }
            println!(
                "{interpolation:?} {spacing} {mode:?}: {beyond} of 80 beyond the plain bound, {known} bounded, {lacking} beyond \
                 the bound without injected heights, {kinds:?}"
            );
            assert!(beyond > 10 && known > 10 && kinds[1] > 10 && kinds[2] > 5, "{beyond} {known} {kinds:?}");
            all_lacking += lacking;
        }
        assert!(all_lacking > 1, "{all_lacking} nodes need the part of the injected heights");
    }
}
