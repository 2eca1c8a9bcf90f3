//! By how much injected heights differ from what would be generated in their places, for levels of detail of endless terrain.
//!
//! A region that is coarser than the terrain lacks the injected heights of all finer lattices. These change the surface as random
//! offsets of a lattice do (see [`remainder`](crate::terrain::remainder)), so the same constants bound their effect: the sum over the
//! finer lattices of the largest differences. The difference of an injected height is exact: it is computed once, with all heights
//! injected on which its place depends.

use std::collections::BTreeMap;

use crate::parallel;
use crate::terrain::config::{HeightInterpolation, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::field::region;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::window::{Region, SMOOTH_RIM};

/// Distance, in points of its lattice, over which an injected height changes finer heights around it: at most three points of each
/// lattice from its own on.
const REACH: i64 = 6;

/// Bound of the rounding of one lattice, in 1/65536 height units, in the surface with and without the injected heights.
const ROUNDING: i64 = 8;

/// Injected heights of `seamless` terrain, by the lattice on which they lie.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct FeatureOffsets {
    /// For each lattice, from the samples to the base lattice: the heights that are on no coarser lattice, by row and column in
    /// samples.
    lattices: Vec<BTreeMap<(i64, i64), Injected>>,
    mode: FeatureMode,
}

/// An injected height.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Injected {
    height: i32,
    /// Its distance from the height that would be generated without it.
    offset: u32,
    /// Whether the height that would be there follows from an elevation map.
    is_near_map: bool,
}

impl FeatureOffsets {
    /// Finds the offsets of all injected heights. The configuration must be valid. `is_near_map` tells of a column and row of samples
    /// whether heights follow from an elevation map.
    pub fn new(
        config: &TerrainConfig,
        features: &Features,
        is_near_map: impl Fn([i64; 2]) -> bool + Sync,
    ) -> Self {
        let mut lattices = vec![BTreeMap::new(); config.levels() as usize + 1];
        let spacing = config.sample_spacing();
        for ((y, x), height) in features.points() {
            let (row, column) = (y / spacing, x / spacing);
            let lattice = (row | column).trailing_zeros().min(config.levels());
            let injected = Injected { height: *height, offset: 0, is_near_map: is_near_map([column, row]) };
            lattices[lattice as usize].insert((row, column), injected);
        }
        let own = Self { lattices, mode: features.mode };
        let with_offsets = |lattice: usize| {
            let points: Vec<_> = own.lattices[lattice].iter().collect();
            let offset = |(at, injected): &(&(i64, i64), &Injected)| {
                let offset = own.offset(config, lattice as u32, at.0, at.1, injected.height);
                (**at, Injected { offset, ..**injected })
            };
            parallel::map(&points, offset).into_iter().collect()
        };
        Self { lattices: (0..own.lattices.len()).map(with_offsets).collect(), mode: features.mode }
    }

    fn offset(&self, config: &TerrainConfig, coarser: u32, row: i64, column: i64, height: i32) -> u32 {
        if self.mode == FeatureMode::Additive || coarser == config.levels() {
            return height.unsigned_abs();
        }
        let first = [column >> coarser, row >> coarser];
        let place = Region { first, width: 1, coarser };
        if place.validate(config).is_err() {
            return 0;
        }
        let mut near = self.near(config, place);
        let spacing = config.sample_spacing();
        near.remove(&(row * spacing, column * spacing));
        let near = Features::of_points(self.mode, near);
        let generated = region(config, &near, place)[0];
        (i64::from(height) - i64::from(generated)).unsigned_abs() as u32
    }

    /// The injected heights from which a region is made, by row and column in world coordinates.
    fn near(&self, config: &TerrainConfig, region: Region) -> BTreeMap<(i64, i64), i32> {
        let (spacing, mut world) = (config.sample_spacing(), BTreeMap::new());
        let rim = i64::from(SMOOTH_RIM);
        for (spans, lattice) in region.levels(config).iter().zip((0..=config.levels()).rev()) {
            let [columns, rows] =
                spans.map(|span| ((span.first - rim) << lattice)..=((span.last + rim) << lattice));
            let points =
                self.lattices[lattice as usize].range((*rows.start(), i64::MIN)..=(*rows.end(), i64::MAX));
            let inside = points.filter(|((_, column), _)| columns.contains(column));
            world.extend(
                inside.map(|((row, column), injected)| ((row * spacing, column * spacing), injected.height)),
            );
        }
        world
    }

    /// Bound of what the injected heights change that a region lacks because they are on finer lattices, in 1/65536 height units.
    /// The region's rim of at least three samples is not drawn. Without these heights, the region's would be from `low` to `high`.
    pub fn bound(&self, config: &TerrainConfig, region: Region, [low, high]: [i64; 2]) -> i64 {
        let [columns, rows] = region
            .first
            .map(|first| first << region.coarser..=(first + i64::from(region.width) - 1) << region.coarser);
        let lattices = self.lattices.iter().take(region.coarser as usize).enumerate();
        let bounds = lattices.map(|(lattice, points)| {
            let points = points.range((*rows.start(), i64::MIN)..=(*rows.end(), i64::MAX));
            let (mut center, mut edge) = (0_i64, 0_i64);
            for ((row, column), injected) in points.filter(|((_, column), _)| columns.contains(column)) {
                let is_center = (row & column) >> lattice & 1 == 1;
                let largest = if is_center { &mut center } else { &mut edge };
                let height = i64::from(injected.height);
                let offset = match self.mode {
                    FeatureMode::Keep if injected.is_near_map => (height - low).max(high - height),
                    _ => injected.offset.into(),
                };
                *largest = offset.max(*largest);
            }
            let [center, edge] = [center, edge].map(|offset| offset as f64);
            if center + edge == 0.0 {
                return 0;
            }
            let effect = match config.interpolation {
                HeightInterpolation::Linear => center.max(0.5 * center + edge),
                HeightInterpolation::Smooth => 1.077 * center.max(0.65 * center + edge),
            };
            effect.ceil() as i64 + ROUNDING * (region.coarser as i64)
        });
        bounds.sum()
    }

    /// Bound of what all injected heights that a region has, or that it follows from, change in it.
    pub fn influence(&self, region: Region) -> i64 {
        let lattices = (0..).zip(&self.lattices).skip(region.coarser as usize);
        let points = lattices.flat_map(|(lattice, points)| {
            points.iter().map(move |((row, column), injected)| {
                ChangedPoint::on_lattice(lattice, *row, *column, injected.offset)
            })
        });
        ChangedPoint::bound(&points.collect::<Vec<_>>(), region)
    }

    /// The places at which two sets of injected heights differ.
    pub fn changed(&self, other: &Self) -> Vec<ChangedPoint> {
        let mut changed = Vec::new();
        for (lattice, (one, two)) in (0..).zip(self.lattices.iter().zip(&other.lattices)) {
            let differs = |at: &(i64, i64)| {
                let [one, two] = [one.get(at), two.get(at)].map(|point| point.map(|point| point.height));
                one != two || self.mode != other.mode
            };
            let offset = |at: &(i64, i64)| {
                [one, two].iter().filter_map(|points| points.get(at)).map(|point| point.offset).max()
            };
            let places = one.keys().chain(two.keys().filter(|at| !one.contains_key(at)));
            let changed_at =
                |at: &(i64, i64)| ChangedPoint::on_lattice(lattice, at.0, at.1, offset(at).unwrap_or(0));
            changed.extend(places.filter(|at| differs(at)).map(changed_at));
        }
        changed
    }
}

/// A place whose injected height changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ChangedPoint {
    /// Column and row of the sample.
    pub at: [i64; 2],
    /// The coarsest regions that change are this many levels coarser than the terrain.
    pub coarsest: u32,
    /// Distance in samples over which heights change.
    pub reach: i64,
    /// The larger distance of the old and the new height from what would be there without them.
    pub offset: u32,
}

impl ChangedPoint {
    /// A point by the coarsest lattice that has it, and its row and column.
    fn on_lattice(lattice: u32, row: i64, column: i64, offset: u32) -> Self {
        Self { at: [column, row], coarsest: lattice, reach: REACH << lattice, offset }
    }

    /// How far changed points may raise or lower heights of a region, in 1/65536 height units: for each lattice, twice the effect
    /// of its largest offset, for the old and the new heights.
    pub fn bound(changed: &[Self], region: Region) -> i64 {
        let mut largest = BTreeMap::new();
        for point in changed.iter().filter(|point| point.changes(region)) {
            let most: &mut u32 = largest.entry(point.coarsest).or_default();
            *most = point.offset.max(*most);
        }
        largest.values().map(|offset| 4 * i64::from(*offset)).sum()
    }

    /// Whether heights of a region change.
    pub fn changes(&self, region: Region) -> bool {
        region.coarser <= self.coarsest
            && (0..2).all(|axis| {
                let first = region.first[axis] << region.coarser;
                let last = (region.first[axis] + i64::from(region.width) - 1) << region.coarser;
                (first - self.reach..=last + self.reach).contains(&self.at[axis])
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::threefry2x32;
    use crate::terrain::features::FeatureFile;
    use crate::terrain::remainder::remainder;
    use crate::terrain::remainder::tests::{CELLS, exact};

    /// On random nodes with injected heights, at random places and on a road, no sample is further from the triangles than the bound.
    /// Without the part of the injected heights, most are.
    #[test]
    fn random_nodes_are_within_the_bound() {
        use FeatureMode::{Additive, Keep};
        use HeightInterpolation::{Linear, Smooth};
        for (interpolation, mode) in [(Linear, Keep), (Smooth, Keep), (Linear, Additive), (Smooth, Additive)]
        {
            let (mut beyond, mut loose) = (0, Vec::new());
            for node in 0..60_u32 {
                let (words, more) = threefry2x32([node, 0xfea7], [0, 1, 2, 3, 4, 5, 6, 7], [0; 8]);
                let config = TerrainConfig {
                    interpolation,
                    coarse_levels: words[0] % 3,
                    ..TerrainConfig::new(65, 40.0, &format!("node {node}")).expect("valid")
                };
                let coarser = 1 + words[1] % 4;
                let first = [words[2], words[3]].map(|word| i64::from(word % 2_001) - 1_000);
                let start = first.map(|at| at << coarser);
                let points = (0..1 + words[4] % 9).flat_map(|at| {
                    let [x, y] = [more[at as usize % 8], words[at as usize % 8] ^ more[0]];
                    let height = f64::from(y % 160) - 80.0;
                    // Half of the nodes have rows of the same height.
                    let width = if node % 2 == 0 { 1 } else { 5 };
                    (0..width).map(move |aside| ([x % 64 + aside, y % 64], height))
                });
                let mut files = std::collections::BTreeMap::new();
                for ([x, y], height) in points {
                    let at = [start[0] + i64::from(x), start[1] + i64::from(y)];
                    let patch = at.map(|at| at.div_euclid(64) as i32);
                    let [x, y] = at.map(|at| at.rem_euclid(64) as f64);
                    let file: &mut BTreeMap<(u64, u64), f64> = files.entry(patch).or_default();
                    file.insert((x as u64, y as u64), height);
                }
                let file = |(patch, points): (&[i32; 2], &BTreeMap<(u64, u64), f64>)| FeatureFile {
                    patch_coordinates: *patch,
                    precomputed_heights: points
                        .iter()
                        .flat_map(|((x, y), height)| [*x as f64, *y as f64, *height])
                        .collect(),
                };
                let files: Vec<FeatureFile> = files.iter().map(file).collect();
                let features = Features::new(&config, &files, mode).expect("valid");
                let offsets = FeatureOffsets::new(&config, &features, |_| false);
                let (bent, largest) = exact(&config, |of| region(&config, &features, of), coarser, first);
                let without = remainder(&config, coarser, bent);
                let around = Region { first: first.map(|at| at - 4), width: CELLS as u32 + 9, coarser };
                let bound = without + offsets.bound(&config, around, [0, 0]);
                assert!(largest <= bound as f64, "{interpolation:?} {mode:?} {node}: {largest} > {bound}");
                beyond += usize::from(largest > without as f64);
                loose.push(bound as f64 / largest);
            }
            loose.sort_by(f64::total_cmp);
            println!(
                "{interpolation:?} {mode:?}: {beyond} of 60 beyond the plain bound, median {:.2}",
                loose[30]
            );
            assert!(beyond > 20, "{beyond}");
        }
    }
}
