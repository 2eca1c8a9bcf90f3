//! Heights of a patch that wraps around onto itself: the CPU reference of `kernels/terrain/wrap.wgsl`.

use crate::terrain::config::{PATCH_EDGE, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::fixed::{Draw, inject, mean_of_four};
use crate::terrain::lattice::corners;
use crate::terrain::window::Lattice;

/// Heights of one patch, in rows of `patch_size` samples.
pub fn wrap(config: &TerrainConfig, features: &Features, patch: [i32; 2]) -> Vec<i32> {
    let size = config.patch_size as usize;
    let torus = Torus {
        last: size - 1,
        draw: Draw::new(config),
        origin: patch.map(|index| (i64::from(index) * PATCH_EDGE) as u32),
        spacing: config.sample_spacing() as u32,
        features: injected(config, features, patch),
        mode: features.mode,
    };
    let mut grid = vec![0; size * size];
    for (corner, height) in corners(config, features, patch).iter().enumerate() {
        grid[corner / 2 * torus.last * size + corner % 2 * torus.last] = *height;
    }
    for level in 0..config.levels() {
        torus.subdivide(&mut grid, config.level_range(level), torus.last >> level);
    }
    grid
}

fn injected(config: &TerrainConfig, features: &Features, patch: [i32; 2]) -> Vec<Option<i32>> {
    let size = config.patch_size;
    let lattice = Lattice { origin: [0, 0], width: size, spacing: config.sample_spacing() };
    let mut grid = vec![None; (size * size) as usize];
    for (x, y, height) in features.on_lattice(Features::world_of(config, patch), lattice, false) {
        grid[(y * size + x) as usize] = Some(height);
    }
    grid
}

struct Torus {
    last: usize,
    draw: Draw,
    origin: [u32; 2],
    spacing: u32,
    features: Vec<Option<i32>>,
    mode: crate::terrain::fixed::FeatureMode,
}

impl Torus {
    fn subdivide(&self, grid: &mut [i32], range: u32, step: usize) {
        let (size, half) = (self.last + 1, step / 2);
        for y in (half..size).step_by(step) {
            for x in (half..size).step_by(step) {
                let at = |x: usize, y: usize| grid[y * size + x];
                let mean = mean_of_four(
                    at(x - half, y - half),
                    at(x + half, y - half),
                    at(x - half, y + half),
                    at(x + half, y + half),
                );
                grid[y * size + x] = self.drawn(x, y, range, mean);
            }
        }
        for y in (0..size).step_by(half) {
            let first = if (y / half).is_multiple_of(2) { half } else { 0 };
            for x in (first..size).step_by(step) {
                let at = |x: usize, y: usize| grid[y * size + x];
                // Neighbours wrap around: the left neighbour of column 0 is column `last` − half.
                let before = |i: usize| if i == 0 { self.last - half } else { i - half };
                let after = |i: usize| if i == self.last { half } else { i + half };
                let mean = mean_of_four(at(before(x), y), at(after(x), y), at(x, before(y)), at(x, after(y)));
                grid[y * size + x] = self.drawn(x, y, range, mean);
            }
        }
    }

    fn drawn(&self, x: usize, y: usize, range: u32, mean: i32) -> i32 {
        let world = |i: usize, origin: u32| origin.wrapping_add((i % self.last) as u32 * self.spacing);
        let mut height = [mean];
        self.draw.add_row(&mut height, range, world(x, self.origin[0]), 0, world(y, self.origin[1]));
        self.injected(x, y, height[0])
    }

    fn injected(&self, x: usize, y: usize, height: i32) -> i32 {
        self.features[y * (self.last + 1) + x].map_or(height, |feature| inject(self.mode, height, feature))
    }
}
