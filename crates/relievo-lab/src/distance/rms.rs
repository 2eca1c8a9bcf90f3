//! The root mean square of distances, by a quadrature of every triangle.

use glam::DVec3;
use rayon::prelude::*;

use crate::distance::Surface;
use crate::distance::tree::Tree;

/// The number of triangles that are sampled one after another.
const CHUNK: usize = 256;

/// The distances at samples.
pub(super) struct Sampled {
    pub rms: f64,
    /// The largest difference between `rms` and the surface's.
    pub within: f64,
    /// The largest distance of a sample.
    pub largest: f64,
}

/// Sums over samples.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// Of squares of distances, times areas.
    squares: f64,
    /// Of bounds of the mean squares of the ways to samples, times areas.
    ways: f64,
    /// Of squares of distances, and of samples.
    plain: [f64; 2],
    /// The largest square of a distance.
    largest: f64,
}

/// Samples all triangles of a surface, at `least` points at least.
pub(super) fn sampled(surface: &Surface, tree: &Tree, least: usize) -> Sampled {
    let areas: Vec<f64> = surface.corners.iter().map(area).collect();
    let all: f64 = areas.iter().sum();
    let divisions = |area: f64| {
        let wanted = least as f64 / 3.0 * area / all;
        // Comparisons with NaN are false: a surface without area is divided no further.
        if wanted > 1.0 { wanted.sqrt().ceil() as u32 } else { 1 }
    };
    let chunks: Vec<Sums> = (surface.corners.par_chunks(CHUNK).zip(areas.par_chunks(CHUNK)))
        .map(|(triangles, areas)| {
            let mut sums = Sums::default();
            let mut hint = 0;
            for (corners, area) in triangles.iter().zip(areas) {
                sums.add(corners, *area, divisions(*area), tree, &mut hint);
            }
            sums
        })
        .collect();
    // One after another, so that rounding does not depend on threads.
    let mut sums = Sums::default();
    for chunk in chunks {
        sums.squares += chunk.squares;
        sums.ways += chunk.ways;
        sums.plain = [0, 1].map(|at| sums.plain[at] + chunk.plain[at]);
        sums.largest = sums.largest.max(chunk.largest);
    }
    let (mean, way) = match all > 0.0 {
        true => (sums.squares / all, sums.ways / all),
        false => (sums.plain[0] / sums.plain[1], extent_squared(surface)),
    };
    Sampled { rms: mean.sqrt(), within: way.sqrt(), largest: sums.largest.sqrt() }
}

/// The square of the longest edge: what bounds the error where there is no area.
fn extent_squared(surface: &Surface) -> f64 {
    surface.corners.iter().map(edges_squared).fold(0.0, f64::max)
}

fn area([a, b, c]: &[DVec3; 3]) -> f64 {
    (*b - *a).cross(*c - *a).length() / 2.0
}

/// The sum of the squares of the edges.
fn edges_squared([a, b, c]: &[DVec3; 3]) -> f64 {
    a.distance_squared(*b) + b.distance_squared(*c) + c.distance_squared(*a)
}

impl Sums {
    /// Adds the samples of a triangle that is divided into `divisions`² equal ones.
    fn add(&mut self, corners: &[DVec3; 3], area: f64, divisions: u32, tree: &Tree, hint: &mut u32) {
        let n = f64::from(divisions);
        let [a, b, c] = *corners;
        let (right, up) = ((b - a) / n, (c - a) / n);
        let weight = area / (3.0 * n * n);
        let mut sample = |point: DVec3| {
            let near = tree.nearest(point, *hint);
            *hint = near.triangle;
            self.squares += weight * near.squared;
            self.plain = [self.plain[0] + near.squared, self.plain[1] + 1.0];
            self.largest = self.largest.max(near.squared);
        };
        for row in 0..divisions {
            for column in 0..divisions - row {
                let corner = a + f64::from(column) * right + f64::from(row) * up;
                // The points (2/3, 1/6, 1/6) of the triangle at this corner, and of the one that completes the cell.
                let mut three = |corner: DVec3, right: DVec3, up: DVec3| {
                    for [x, y] in [[1.0, 1.0], [4.0, 1.0], [1.0, 4.0]] {
                        sample(corner + x / 6.0 * right + y / 6.0 * up);
                    }
                };
                three(corner, right, up);
                if column + row + 1 < divisions {
                    three(corner + right + up, -right, -up);
                }
            }
        }
        self.ways += area * edges_squared(corners) / (108.0 * n * n);
    }
}
