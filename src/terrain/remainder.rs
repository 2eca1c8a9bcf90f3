//! Proven bounds on the detail that a coarse region leaves out, for levels of detail of a terrain.
//!
//! A region that is `coarser` levels coarser (see [`Region`](super::window::Region)) is drawn as triangles. The diagonal of each
//! cell runs from south-west to north-east. [`remainder`] bounds the vertical distance between these triangles and the terrain's
//! finest samples.
//!
//! # Diamond-square
//!
//! Both interpolations are linear in the coarse heights and in the random offsets. So the distance is at most the sum of two
//! parts.
//!
//! **Interpolation without offsets.** The distance is a linear function of the coarse heights, and 0 for planes. Its largest
//! value under the constraint that no second difference or twist exceeds 1 is the solution of a linear program, and so is the
//! largest second difference or twist after some levels. After the levels 1 to 4, the largest distances are 0.25, 0.25, 0.2813
//! and 0.2774 (linear), and 0.5157, 0.394, 0.4876 and 0.5112 (smooth). The largest second difference after 4 levels is 0.2149
//! (linear) and 0.0791 (smooth). All finer levels start from the lattice of level 4. So the bound κ at all levels satisfies κ ≤
//! 0.2813 + 0.2149 κ (linear) and κ ≤ 0.5157 + 0.0791 κ (smooth): 0.36 and 0.561 are bounds.
//! The test `linear_interpolation_stays_near_the_triangles` derives 0.36.
//!
//! **Offsets over coarse heights of 0.** Linear interpolation is a mean, so the largest distance occurs when all offsets are
//! largest: it is the height of the surface with these offsets, which repeats from cell to cell. With smooth interpolation, the
//! effect of offsets of range r on centers and e on edges is at most a sum of absolute weights. After 6 levels, this sum plus κ
//! times that of its second differences is at most 1.077 max(r, 0.65 r + e). (Both are convex in e and were computed for e/r = 0,
//! 0.2, 0.3, 0.35, 0.4, 0.5, 0.7072 and 1.)
//!
//! Rounding counts as an offset of 1/2 (linear), and of 9/8 on centers and 1 on edges (smooth).
//!
//! # Noise
//!
//! A function whose second derivatives are at most H differs from right triangles with legs σ by at most σ²·H/4 (the circumradius
//! is σ/√2). A triangle never differs by more than twice the function's largest value. The largest first and second derivatives
//! of one octave, per spacing of its lattice, are 2.86 and 12.8 (gradient noise), 4.74 and 17.4 (with random values), and 5.74
//! and 35.2 (simplex noise); the test `noise_and_its_derivatives_are_bounded` finds them. For `ridged`, |n| is also bent at
//! crests: there, it differs from the triangles by at most half the largest difference between corners, plus the distance of n
//! itself.
//!
//! Octaves of `fbm` that are left out of the coarse region are 0 at its samples. They add their range.

use crate::terrain::config::{HEIGHT_LIMIT, HeightGenerator, HeightInterpolation, TerrainConfig};

/// Levels of linear interpolation over which the largest effect of offsets is computed exactly.
const EXACT_LEVELS: u32 = 5;

/// Upper bound, in 1/65536 height units, on the vertical distance between the terrain's finest samples in a cell of a region and
/// the triangles through the region's samples. The region is `coarser` levels coarser than the terrain. Erosion and features are
/// not included.
///
/// `second_difference` is the largest absolute value among the second differences along x and along y (a − 2b + c) and the twists
/// of cells (a + d − b − c), in 1/65536 units. They are taken over the region's samples within [`remainder_reach`] samples of the
/// cell.
pub fn remainder(config: &TerrainConfig, coarser: u32, second_difference: i64) -> i64 {
    if coarser == 0 {
        return 0;
    }
    let bent = second_difference as f64;
    let bound = match (config.generator, config.interpolation) {
        (HeightGenerator::DiamondSquare, HeightInterpolation::Linear) => {
            0.36 * bent + linear_offsets(config, coarser)
        }
        (HeightGenerator::DiamondSquare, HeightInterpolation::Smooth) => {
            let offsets = |levels| smooth_offsets(config, levels);
            // Where heights may be clamped, the interpolation is not linear. Second differences of the base lattice are at most
            // four times its range.
            if (1.0 + 4.0 * 0.561) * f64::from(config.level_range(0)) + offsets(config.levels())
                > HEIGHT_LIMIT as f64
            {
                return 2 * HEIGHT_LIMIT;
            }
            0.561 * bent + offsets(coarser)
        }
        (HeightGenerator::Fbm, _) => fbm(config, coarser),
        (HeightGenerator::Ridged, _) => ridged(config, coarser),
        (HeightGenerator::Simplex, _) => octaves(config, coarser)
            .map(|(cells, range)| range * (35.2 / 4.0 / (cells * cells)).min(1.88))
            .sum(),
    };
    // All steps above are exact to a few bits of 53.
    (bound * (1.0 + 1e-12)).ceil() as i64
}

/// Number of samples around a cell whose second differences [`remainder`] needs. 0: it needs none.
pub fn remainder_reach(config: &TerrainConfig) -> u32 {
    match (config.generator, config.interpolation) {
        (HeightGenerator::DiamondSquare, HeightInterpolation::Linear) => 1,
        (HeightGenerator::DiamondSquare, HeightInterpolation::Smooth) => 6,
        _ => 0,
    }
}

/// Largest height of a surface with coarse heights of 0 and the largest offsets at each of the `coarser` finest levels.
fn linear_offsets(config: &TerrainConfig, coarser: u32) -> f64 {
    let first = config.levels() - coarser;
    let offset = |level: u32| f64::from(config.level_range(level)) + 0.5;
    let mut width = 1;
    let mut heights = vec![0.0];
    for level in (first..config.levels()).take(EXACT_LEVELS as usize) {
        // One cell that repeats in both directions.
        let coarse = |x: usize, y: usize| heights[y % width * width + x % width];
        let centers: Vec<f64> = (0..width * width)
            .map(|at| (at % width, at / width))
            .map(|(x, y)| (coarse(x, y) + coarse(x + 1, y) + coarse(x, y + 1) + coarse(x + 1, y + 1)) / 4.0)
            .map(|mean| mean + offset(level))
            .collect();
        let center = |x: usize, y: usize| centers[y % width * width + x % width];
        let fine = |at: usize| {
            let (column, row) = (at % (2 * width), at / (2 * width));
            let (x, y) = (column / 2, row / 2);
            let before = width - 1;
            match (column % 2, row % 2) {
                (0, 0) => coarse(x, y),
                (1, 1) => center(x, y),
                (1, _) => {
                    let sum = coarse(x, y) + coarse(x + 1, y) + center(x, y + before) + center(x, y);
                    sum / 4.0 + offset(level)
                }
                _ => {
                    let sum = coarse(x, y) + coarse(x, y + 1) + center(x + before, y) + center(x, y);
                    sum / 4.0 + offset(level)
                }
            }
        };
        heights = (0..4 * width * width).map(fine).collect();
        width *= 2;
    }
    let rest = (first + EXACT_LEVELS..config.levels()).map(offset);
    heights.into_iter().fold(0.0, f64::max) + 1.5 * rest.sum::<f64>()
}

/// Largest effect of the offsets at the `levels` finest levels with smooth interpolation.
fn smooth_offsets(config: &TerrainConfig, levels: u32) -> f64 {
    let offset = |level: u32| {
        let center = f64::from(config.level_range(level)) + 1.125;
        let edge = f64::from(config.edge_range(level)) + 1.0;
        1.077 * center.max(0.65 * center + edge)
    };
    (config.levels() - levels..config.levels()).map(offset).sum()
}

/// For every octave: spacing of its lattice in cells of the coarse region (below 1 for finer octaves), and range with rounding.
///
/// Rounding: an octave's height is rounded down by less than 1, and its value, in Q4.27, is wrong by less than 128.
fn octaves(config: &TerrainConfig, coarser: u32) -> impl Iterator<Item = (f64, f64)> {
    let cell = f64::from(config.sample_spacing() as u32) * f64::from(coarser).exp2();
    (0..config.octaves(0)).map(move |octave| {
        let spacing = f64::from(config.base_log2() - octave).exp2();
        let range = f64::from(config.level_range(octave));
        (spacing / cell, range * (1.0 + 3e-6) + 2.0)
    })
}

fn fbm(config: &TerrainConfig, coarser: u32) -> f64 {
    let distance = |(octave, (cells, range)): (usize, (f64, f64))| {
        let (second, most) = if octave == 0 { (17.4, 2.99) } else { (12.8, 1.99) };
        // Octaves whose lattices hold all samples of the region vanish there.
        let vanishes = octave > 0 && cells <= 1.0;
        range * if vanishes { 1.0 } else { f64::min(second / 4.0 / (cells * cells), most) }
    };
    octaves(config, coarser).enumerate().map(distance).sum()
}

fn ridged(config: &TerrainConfig, coarser: u32) -> f64 {
    // Distance of |v + n|, and its largest difference between two corners of a triangle.
    let parts = |cells: f64| {
        let across = f64::min(4.74 * 2.0_f64.sqrt() / cells, 1.5);
        (f64::min(across / 2.0 + 17.4 / 4.0 / (cells * cells), 1.5), across)
    };
    let first = octaves(config, coarser).next().map_or((0.0, 0.0), |(cells, _)| parts(cells));
    let distance = |(octave, (cells, range)): (usize, (f64, f64))| {
        let (ridge, across) = parts(cells);
        if octave == 0 {
            return range * ridge;
        }
        // A product f·g of size 1 differs by the distances of f and g, and by a third of the product of their differences. The
        // weight changes half as much as octave 0's ridge.
        range * f64::min(ridge + first.0 / 2.0 + across * first.1 / 6.0, 1.5)
    };
    octaves(config, coarser).enumerate().map(distance).sum()
}

#[cfg(test)]
pub(crate) mod tests {
    use std::collections::HashMap;
    use std::ops::RangeInclusive;

    use super::*;
    use crate::hash::threefry2x32;
    use crate::terrain::features::Features;
    use crate::terrain::field::region;
    use crate::terrain::window::Region;

    pub(crate) const CELLS: usize = 4;

    /// Largest second difference around the cells of a node, and its largest exact distance from the terrain. `heights` makes the
    /// heights of a region.
    pub(crate) fn exact(
        config: &TerrainConfig,
        heights: impl Fn(Region) -> Vec<i32>,
        coarser: u32,
        first: [i64; 2],
    ) -> (i64, f64) {
        let made = |region_of: Region| {
            region_of.validate(config).expect("inside");
            heights(region_of).into_iter().map(i64::from).collect::<Vec<_>>()
        };
        let reach = remainder_reach(config) as usize;
        let width = CELLS + 1 + 2 * reach;
        let around = first.map(|index| index - reach as i64);
        let coarse = made(Region { first: around, width: width as u32, coarser });
        let at = |x: usize, y: usize| coarse[y * width + x];
        let mut bent = 0;
        for (x, y) in (0..width).flat_map(|y| (0..width).map(move |x| (x, y))) {
            if x + 2 < width {
                bent = bent.max((at(x, y) - 2 * at(x + 1, y) + at(x + 2, y)).abs());
            }
            if y + 2 < width {
                bent = bent.max((at(x, y) - 2 * at(x, y + 1) + at(x, y + 2)).abs());
            }
            if x + 1 < width && y + 1 < width {
                bent = bent.max((at(x, y) + at(x + 1, y + 1) - at(x + 1, y) - at(x, y + 1)).abs());
            }
        }
        let step = 1_usize << coarser;
        let fine_width = CELLS * step + 1;
        let fine =
            made(Region { first: first.map(|index| index << coarser), width: fine_width as u32, coarser: 0 });
        let mut largest: f64 = 0.0;
        for (index, height) in fine.into_iter().enumerate() {
            let (x, y) = (index % fine_width, index / fine_width);
            let cell = [x, y].map(|fine| (fine / step).min(CELLS - 1));
            let [u, v] = [x - cell[0] * step, y - cell[1] * step].map(|part| part as f64 / step as f64);
            let corner = |dx: usize, dy: usize| at(reach + cell[0] + dx, reach + cell[1] + dy) as f64;
            let (north_east, south_west) = (corner(1, 0), corner(0, 1));
            let triangle = if u + v <= 1.0 {
                corner(0, 0) * (1.0 - u - v) + north_east * u + south_west * v
            } else {
                corner(1, 1) * (u + v - 1.0) + north_east * (1.0 - v) + south_west * (1.0 - u)
            };
            largest = largest.max((height as f64 - triangle).abs());
        }
        (bent, largest)
    }

    /// On 200 random nodes of each generator, no sample is further from the triangles than the bound.
    #[test]
    fn random_nodes_are_within_the_bound() {
        use HeightGenerator::{DiamondSquare, Fbm, Ridged, Simplex};
        use HeightInterpolation::{Linear, Smooth};
        for (generator, interpolation) in [
            (DiamondSquare, Linear),
            (DiamondSquare, Smooth),
            (Fbm, Linear),
            (Ridged, Linear),
            (Simplex, Linear),
        ] {
            let mut loose = Vec::new();
            for node in 0..200_u32 {
                let (words, more) = threefry2x32([node, 0x1001], [0, 1, 2, 3, 4, 5, 6, 7], [0; 8]);
                let config = TerrainConfig {
                    generator,
                    interpolation,
                    coarse_levels: words[0] % 4,
                    roughness: [1.0, 0.8, 3.0, 0.5][words[1] as usize % 4],
                    ..TerrainConfig::new(if node % 2 == 0 { 65 } else { 257 }, 40.0, &format!("node {node}"))
                        .expect("valid")
                };
                config.validate().expect("valid");
                let coarser = 1 + words[2] % 5;
                let first = [words[3], more[3]].map(|word| i64::from(word % 20_001) - 10_000);
                let heights = |of: Region| region(&config, &Features::default(), of);
                let (bent, largest) = exact(&config, heights, coarser, first);
                let bound = remainder(&config, coarser, bent);
                assert!(
                    largest <= bound as f64,
                    "{generator:?} {interpolation:?} {coarser}: {largest} > {bound}"
                );
                loose.push(bound as f64 / largest);
            }
            loose.sort_by(f64::total_cmp);
            println!(
                "{generator:?} {interpolation:?}: bound / actual at least {:.2}, median {:.2}, at most {:.2}",
                loose[0], loose[100], loose[199]
            );
        }
    }

    /// Nothing is left out of the finest region, and a flat terrain has a bound of rounding alone.
    #[test]
    fn trivial_remainders() {
        for generator in [
            HeightGenerator::DiamondSquare,
            HeightGenerator::Fbm,
            HeightGenerator::Ridged,
            HeightGenerator::Simplex,
        ] {
            let config = TerrainConfig { generator, ..TerrainConfig::new(65, 40.0, "").expect("valid") };
            assert_eq!(remainder(&config, 0, 1 << 30), 0);
            let flat = TerrainConfig { scale_factor: 0.0, ..config };
            assert!(remainder(&flat, 6, 0) < 100, "{generator:?}");
        }
    }

    /// Weights of the 25 second differences and twists around a coarse cell.
    type Weights = [f64; 25];

    fn sum(terms: &[(f64, Weights)]) -> Weights {
        std::array::from_fn(|at| terms.iter().map(|(factor, weights)| factor * weights[at]).sum())
    }

    /// Second differences, twists and distances from the coarse triangles around a coarse cell, after some levels of linear
    /// interpolation without offsets. Each is a sum of the coarse second differences and twists. The cell has `cells`² fine cells;
    /// one more fine cell on each side is included.
    struct Bent {
        cells: i32,
        along_x: HashMap<[i32; 2], Weights>,
        along_y: HashMap<[i32; 2], Weights>,
        twists: HashMap<[i32; 2], Weights>,
        distances: HashMap<[i32; 2], Weights>,
    }

    fn points(x: RangeInclusive<i32>, y: RangeInclusive<i32>) -> impl Iterator<Item = [i32; 2]> {
        x.flat_map(move |x| y.clone().map(move |y| [x, y]))
    }

    impl Bent {
        fn coarse() -> Self {
            let unit = |at: usize| std::array::from_fn(|index| f64::from(u8::from(index == at)));
            let from = |first: usize, [x, y]: [RangeInclusive<i32>; 2]| {
                points(x, y).enumerate().map(|(at, place)| (place, unit(first + at))).collect()
            };
            Self {
                cells: 1,
                along_x: from(0, [0..=1, -1..=2]),
                along_y: from(8, [-1..=2, 0..=1]),
                twists: from(16, [-1..=1, -1..=1]),
                distances: points(0..=1, 0..=1).map(|place| (place, [0.0; 25])).collect(),
            }
        }

        /// The second difference along one axis at a point of the finer lattice. `x` runs along the axis, and `across` are the
        /// second differences along the other axis.
        fn along(
            along: impl Fn(i32, i32) -> Weights,
            across: impl Fn(i32, i32) -> Weights,
            [x, y]: [i32; 2],
        ) -> Weights {
            let [i, j] = [x, y].map(|fine| fine.div_euclid(2));
            match (x.rem_euclid(2), y.rem_euclid(2)) {
                (0, 0) => sum(&[
                    (0.5, along(i, j)),
                    (1.0 / 16.0, across(i - 1, j)),
                    (2.0 / 16.0, across(i, j)),
                    (1.0 / 16.0, across(i + 1, j)),
                ]),
                (1, 0) => sum(&[(-1.0 / 8.0, across(i, j)), (-1.0 / 8.0, across(i + 1, j))]),
                (0, _) => sum(&[(1.0 / 8.0, along(i, j)), (1.0 / 8.0, along(i, j + 1))]),
                _ => {
                    let four = [along(i, j), along(i + 1, j), along(i, j + 1), along(i + 1, j + 1)];
                    sum(&four.map(|weights| (1.0 / 16.0, weights)))
                }
            }
        }

        fn finer(&self) -> Self {
            let cells = 2 * self.cells;
            let (along_x, along_y) = (|x, y| self.along_x[&[x, y]], |x, y| self.along_y[&[x, y]]);
            let (turned_x, turned_y) = (|y, x| self.along_x[&[x, y]], |y, x| self.along_y[&[x, y]]);
            let twist = |[x, y]: [i32; 2]| {
                let [i, j] = [x, y].map(|fine| fine.div_euclid(2));
                let [right, below] = [x, y].map(|fine| fine.rem_euclid(2));
                let sign = if right == below { -1.0 / 16.0 } else { 1.0 / 16.0 };
                sum(&[
                    (0.25, self.twists[&[i, j]]),
                    (sign, along_y(i, j + below)),
                    (sign, along_y(i + 1, j + below)),
                    (sign, along_x(i + right, j)),
                    (sign, along_x(i + right, j + 1)),
                ])
            };
            let distance = |[x, y]: [i32; 2]| {
                let [i, j] = [x, y].map(|fine| fine.div_euclid(2));
                let old = |x, y| (0.5, self.distances[&[x, y]]);
                match [x, y].map(|fine| fine.rem_euclid(2)) {
                    [0, 0] => self.distances[&[i, j]],
                    [1, 0] => sum(&[
                        old(i, j),
                        old(i + 1, j),
                        (1.0 / 16.0, along_y(i, j)),
                        (1.0 / 16.0, along_y(i + 1, j)),
                    ]),
                    [0, _] => sum(&[
                        old(i, j),
                        old(i, j + 1),
                        (1.0 / 16.0, along_x(i, j)),
                        (1.0 / 16.0, along_x(i, j + 1)),
                    ]),
                    _ => sum(&[old(i + 1, j), old(i, j + 1), (0.25, self.twists[&[i, j]])]),
                }
            };
            Self {
                cells,
                along_x: points(0..=cells, -1..=cells + 1)
                    .map(|at| (at, Self::along(along_x, along_y, at)))
                    .collect(),
                along_y: points(-1..=cells + 1, 0..=cells)
                    .map(|[x, y]| ([x, y], Self::along(turned_y, turned_x, [y, x])))
                    .collect(),
                twists: points(-1..=cells, -1..=cells).map(|at| (at, twist(at))).collect(),
                distances: points(0..=cells, 0..=cells).map(|at| (at, distance(at))).collect(),
            }
        }

        /// Largest value under the constraint that no coarse second difference or twist exceeds 1.
        fn largest<'a>(weights: impl Iterator<Item = &'a Weights>) -> f64 {
            weights.map(|weights| weights.iter().map(|weight| weight.abs()).sum()).fold(0.0, f64::max)
        }
    }

    /// κ of linear interpolation: every distance is a sum of coarse second differences with weights that add up to at most κ.
    #[test]
    fn linear_interpolation_stays_near_the_triangles() {
        let fine = (0..4).fold(Bent::coarse(), |bent, _| bent.finer());
        let distance = Bent::largest(fine.distances.values());
        let bent = fine.along_x.values().chain(fine.along_y.values()).chain(fine.twists.values());
        let bent = Bent::largest(bent);
        println!("distance {distance}, second difference {bent}, bound {}", distance / (1.0 - bent));
        assert!(distance / (1.0 - bent) < 0.36);
    }
}
