//! Heights of a window onto the smooth surface: the CPU reference of `kernels/terrain/smooth.wgsl`. Each level is computed for
//! the whole window at once.

use crate::terrain::config::TerrainConfig;
use crate::terrain::features::Features;
use crate::terrain::fixed::{four_point, mean_of_two};
use crate::terrain::lattice::{Given, Subdivision, limited, subdivided};
use crate::terrain::window::{Region, SMOOTH_RIM};

/// Heights of a region, in rows of `region.width` samples. `given` heights replace those of their lattice, and finer ones follow. The
/// region must be valid, and `config.interpolation` must be `Smooth`.
pub(crate) fn smooth(
    config: &TerrainConfig,
    features: &Features,
    given: Option<&Given<'_>>,
    region: Region,
) -> Vec<i32> {
    subdivided(config, features, given, region, SMOOTH_RIM, |step, coarse| step.four_point(coarse))
}

/// A grid of values in rows of equal width.
struct Rows {
    width: usize,
    values: Vec<i32>,
}

impl Rows {
    fn row(&self, at: usize) -> &[i32] {
        &self.values[at * self.width..][..self.width]
    }

    /// Interpolates column by column between four rows, starting with row `first`. Results lie midway between the second and
    /// third of these rows.
    fn between(&self, first: usize) -> Vec<i32> {
        let [a, b, c, d] = [0, 1, 2, 3].map(|row| self.row(first + row));
        (0..self.width).map(|at| four_point(a[at], b[at], c[at], d[at])).collect()
    }

    /// Interpolates along a row: each result lies midway between the middle two of four consecutive values.
    fn along(row: &[i32]) -> Vec<i32> {
        row.windows(4).map(|values| four_point(values[0], values[1], values[2], values[3])).collect()
    }
}

impl Subdivision<'_> {
    /// Computes the finer lattice from the coarser one. Indices count from the first coarse point; cell i lies between points i
    /// and i + 1. In rows of `along` and `centers`, entry i belongs to cell i + 1.
    fn four_point(&self, coarse: &[i32]) -> Vec<i32> {
        let points = Rows { width: self.coarse[0].width(), values: coarse.to_vec() };
        let rows = self.coarse[1].width();
        let along = Rows {
            width: points.width - 3,
            values: (0..rows).flat_map(|row| Rows::along(points.row(row))).collect(),
        };
        let centers: Vec<i32> = (1..rows - 2).flat_map(|row| self.centers_below(&along, row)).collect();
        let centers = Rows { width: along.width, values: centers };
        let [first_x, first_y] = self.fine.map(|span| span.first);
        let mut fine = vec![0; self.fine[0].width() * self.fine[1].width()];
        for (at, heights) in fine.chunks_exact_mut(self.fine[0].width()).enumerate() {
            let y = first_y + at as i64;
            let row = (y.div_euclid(2) - self.coarse[1].first) as usize;
            let (even, odd) = match y.rem_euclid(2) {
                0 => (points.row(row).to_vec(), self.beside(&along, &centers, row)),
                _ => (self.below(&points, &centers, row), centers.row(row - 1).to_vec()),
            };
            // Entry 0 of `even` is at coarse column 0 in rows of coarse points, and at column 3 in rows between them. Entry 0 of
            // `odd` always belongs to cell 1.
            let skipped = if y.rem_euclid(2) == 0 { 0 } else { 3 };
            for (column, height) in heights.iter_mut().enumerate() {
                let x = first_x + column as i64;
                let cell = (x.div_euclid(2) - self.coarse[0].first) as usize;
                *height = if x.rem_euclid(2) == 0 { even[cell - skipped] } else { odd[cell - 1] };
            }
        }
        fine
    }

    /// Heights at the centers of the cells below coarse row `row`, from cell 1 on.
    fn centers_below(&self, along: &Rows, row: usize) -> Vec<i32> {
        self.finished(along.between(row - 1), self.range, [3, 2 * row as i64 + 1])
    }

    /// Heights of the fine points between neighbouring coarse points of row `row`, from cell 1 on.
    fn beside(&self, along: &Rows, centers: &Rows, row: usize) -> Vec<i32> {
        // Vertical interpolation between two rows of centers above the point and two rows below.
        let across = centers.between(row - 3);
        let means = along.row(row).iter().zip(across).map(|(one, other)| mean_of_two(*one, other));
        self.finished(means.collect(), self.edge_range, [3, 2 * row as i64])
    }

    /// Heights of the fine points midway below the coarse points of row `row`, from column 3 on.
    fn below(&self, points: &Rows, centers: &Rows, row: usize) -> Vec<i32> {
        let down = points.between(row - 1);
        let across = Rows::along(centers.row(row - 1));
        let means = down[3..].iter().zip(across).map(|(one, other)| mean_of_two(*one, other));
        self.finished(means.collect(), self.edge_range, [6, 2 * row as i64 + 1])
    }

    /// Clamps interpolated heights, adds random offsets, injects features, and clamps again. The heights belong to every other
    /// fine point of a row, starting at `at` (counted from the first coarse point).
    fn finished(&self, mut heights: Vec<i32>, range: u32, at: [i64; 2]) -> Vec<i32> {
        let [x, y] = [0, 1].map(|axis| 2 * self.coarse[axis].first + at[axis]);
        heights.iter_mut().for_each(|height| *height = limited(*height));
        self.draw_row(&mut heights, range, x, y);
        heights.iter_mut().for_each(|height| *height = limited(*height));
        heights
    }
}
