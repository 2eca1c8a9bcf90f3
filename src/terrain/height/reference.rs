//! Heights of a window onto the plane: the CPU reference of `kernels/terrain/height.wgsl`. It works on one row of coarse points
//! after another.

use crate::terrain::config::TerrainConfig;
use crate::terrain::features::Features;
use crate::terrain::fixed::{Draw, mean_of_four};
use crate::terrain::lattice::{Given, Injected, base_lattice, world};
use crate::terrain::window::{Region, Span};

/// Heights of a region, in rows of `region.width` samples. `given` heights replace those of their lattice, and finer ones follow. The
/// region must be valid.
pub(crate) fn height(
    config: &TerrainConfig,
    features: &Features,
    given: Option<&Given<'_>>,
    region: Region,
) -> Vec<i32> {
    let levels = region.levels(config);
    let draw = Draw::new(config);
    let base_spacing = config.sample_spacing() << config.levels();
    let mut grid = base_lattice(config, features, levels[0]);
    for (level, pair) in levels.windows(2).enumerate() {
        let lattice = Fine {
            features,
            draw: &draw,
            spans: pair[1],
            spacing: base_spacing >> (level + 1),
            range: config.level_range(level as u32),
            injected: Injected::new(features, pair[1], base_spacing >> (level + 1), 1, true),
        };
        grid = lattice.subdivide(&grid, pair[0]);
        Given::replace(given, config.levels() - level as u32 - 1, pair[1], &mut grid);
    }
    grid
}

/// One subdivision, from a coarser lattice to the lattice with half its spacing.
struct Fine<'a> {
    features: &'a Features,
    draw: &'a Draw,
    spans: [Span; 2],
    spacing: i64,
    range: u32,
    injected: Injected,
}

impl Fine<'_> {
    fn subdivide(&self, coarse: &[i32], coarse_spans: [Span; 2]) -> Vec<i32> {
        let coarse_width = coarse_spans[0].width();
        let coarse_row = |y: i64| {
            let start = (y - coarse_spans[1].first) as usize * coarse_width;
            &coarse[start..start + coarse_width]
        };
        let width = self.spans[0].width();
        let mut fine = vec![0; width * self.spans[1].width()];
        let mut upper = vec![0; coarse_width - 1];
        let mut lower = upper.clone();
        let mut between = upper.clone();
        let mut beside = upper.clone();
        let x = coarse_spans[0].first;
        // The first row of squares lies outside the window and has no diamonds above it. That row is computed but not stored.
        for y in coarse_spans[1].first..coarse_spans[1].last {
            let (here, below) = (coarse_row(y), coarse_row(y + 1));
            self.diamonds(here, below, x, y, &mut lower);
            for (i, point) in between.iter_mut().enumerate() {
                *point = mean_of_four(here[i], here[i + 1], upper[i], lower[i]);
            }
            self.draw_row(&mut between, 2 * x + 1, 2 * y);
            for (i, point) in beside[1..].iter_mut().enumerate() {
                *point = mean_of_four(here[i + 1], below[i + 1], lower[i], lower[i + 1]);
            }
            self.draw_row(&mut beside[1..], 2 * x + 2, 2 * y + 1);
            self.store_row(&mut fine, 2 * y, 2 * x, here, &between);
            self.store_row(&mut fine, 2 * y + 1, 2 * x, &beside, &lower);
            std::mem::swap(&mut upper, &mut lower);
        }
        fine
    }

    /// Heights at the centers of the cells between two coarse rows, `above` and `below`. The first cell starts at coarse point
    /// (x, y).
    fn diamonds(&self, above: &[i32], below: &[i32], x: i64, y: i64, centers: &mut [i32]) {
        for (i, center) in centers.iter_mut().enumerate() {
            *center = mean_of_four(above[i], above[i + 1], below[i], below[i + 1]);
        }
        self.draw_row(centers, 2 * x + 1, 2 * y + 1);
    }

    /// Adds random offsets to the heights of the points (x, y), (x + 2, y), …, and injects features.
    fn draw_row(&self, heights: &mut [i32], x: i64, y: i64) {
        let step = 2 * self.spacing as u32;
        self.draw.add_row(heights, self.range, world(x, self.spacing), step, world(y, self.spacing));
        self.injected.inject_row(self.features, y, x, 2, heights);
    }

    /// Interleaves the rows `even` and `odd`, which start at (x, y), and stores the points that lie in the window.
    fn store_row(&self, fine: &mut [i32], y: i64, x: i64, even: &[i32], odd: &[i32]) {
        if !(self.spans[1].first..=self.spans[1].last).contains(&y) {
            return;
        }
        let width = self.spans[0].width();
        let row = &mut fine[(y - self.spans[1].first) as usize * width..][..width];
        let skip = (self.spans[0].first - x) as usize;
        let even_first = skip.is_multiple_of(2);
        let (mut evens, mut odds) = (even[skip.div_ceil(2)..].iter(), odd[skip / 2..].iter());
        for (i, height) in row.iter_mut().enumerate() {
            let source = if (i % 2 == 0) == even_first { evens.next() } else { odds.next() };
            *height = source.copied().unwrap_or_default();
        }
    }
}
