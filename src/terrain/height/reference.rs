//! Heights of a window onto the plane: the CPU reference of `kernels/terrain/height.wgsl`. It works on one row of coarse points
//! after another.

use crate::terrain::config::TerrainConfig;
use crate::terrain::features::Features;
use crate::terrain::fixed::mean_of_four;
use crate::terrain::lattice::{Given, Subdivision, subdivided};
use crate::terrain::window::Region;

/// Heights of a region, in rows of `region.width` samples. `given` heights replace those of their lattice, and finer ones follow. The
/// region must be valid.
pub(crate) fn height(
    config: &TerrainConfig,
    features: &Features,
    given: Option<&Given<'_>>,
    region: Region,
) -> Vec<i32> {
    subdivided(config, features, given, region, 1, |step, coarse| step.diamond_square(coarse))
}

impl Subdivision<'_> {
    fn diamond_square(&self, coarse: &[i32]) -> Vec<i32> {
        let coarse_width = self.coarse[0].width();
        let coarse_row = |y: i64| {
            let start = (y - self.coarse[1].first) as usize * coarse_width;
            &coarse[start..start + coarse_width]
        };
        let width = self.fine[0].width();
        let mut fine = vec![0; width * self.fine[1].width()];
        let mut upper = vec![0; coarse_width - 1];
        let mut lower = upper.clone();
        let mut between = upper.clone();
        let mut beside = upper.clone();
        let x = self.coarse[0].first;
        // The first row of squares lies outside the window and has no diamonds above it. That row is computed but not stored.
        for y in self.coarse[1].first..self.coarse[1].last {
            let (here, below) = (coarse_row(y), coarse_row(y + 1));
            self.diamonds(here, below, x, y, &mut lower);
            for (i, point) in between.iter_mut().enumerate() {
                *point = mean_of_four(here[i], here[i + 1], upper[i], lower[i]);
            }
            self.draw_row(&mut between, self.range, 2 * x + 1, 2 * y);
            for (i, point) in beside[1..].iter_mut().enumerate() {
                *point = mean_of_four(here[i + 1], below[i + 1], lower[i], lower[i + 1]);
            }
            self.draw_row(&mut beside[1..], self.range, 2 * x + 2, 2 * y + 1);
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
        self.draw_row(centers, self.range, 2 * x + 1, 2 * y + 1);
    }

    /// Interleaves the rows `even` and `odd`, which start at (x, y), and stores the points that lie in the window.
    fn store_row(&self, fine: &mut [i32], y: i64, x: i64, even: &[i32], odd: &[i32]) {
        if !(self.fine[1].first..=self.fine[1].last).contains(&y) {
            return;
        }
        let width = self.fine[0].width();
        let row = &mut fine[(y - self.fine[1].first) as usize * width..][..width];
        let skip = (self.fine[0].first - x) as usize;
        let even_first = skip.is_multiple_of(2);
        let (mut evens, mut odds) = (even[skip.div_ceil(2)..].iter(), odd[skip / 2..].iter());
        for (i, height) in row.iter_mut().enumerate() {
            let source = if (i % 2 == 0) == even_first { evens.next() } else { odds.next() };
            *height = source.copied().unwrap_or_default();
        }
    }
}
