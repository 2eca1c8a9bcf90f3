//! Stone textures: soil with loose stones, and a slope of broken stones (scree).

use super::apart;
use crate::terrain::texture::field::{made, mixed, ramp, stretched, texels as shaded};
use crate::terrain::texture::noise::{Noise, cell, random, smoothstep};

/// The stone at a point of the texture, if there is one.
struct Stone {
    /// Height above the surrounding ground; 0 where there is no stone.
    height: f32,
    /// Brightness and hue, 0 to 1.
    look: [f32; 2],
}

/// Stones of one size.
struct Stones {
    key: u32,
    /// Number of places for stones along each edge of the texture.
    places: u32,
    /// Fraction of the places that have a stone.
    density: f32,
    /// Factor of the stones' heights.
    size: f32,
    /// Noise that bends the edges of the stones.
    bends: [Noise; 2],
}

impl Stones {
    fn new(key: u32, places: u32, density: f32, size: f32) -> Self {
        let bends = [1, 2].map(|axis| Noise::octave(key + axis, [2 * places; 2]));
        Self { key, places, density, size, bends }
    }

    /// The stone at texture coordinates.
    fn at(&self, at: [f32; 2]) -> Stone {
        let bend = 0.16 / self.places as f32;
        let bent = [at[0] + bend * self.bends[0].at(at), at[1] + bend * self.bends[1].at(at)];
        let cell = cell(self.key, [self.places; 2], bent);
        let number = |use_of: u32| random(self.key + 3, [cell.word, use_of]);
        let gap = cell.distances[1] - cell.distances[0];
        // The top of a stone is a tilted plane, cut off by two other planes.
        let face =
            |first: u32| cell.offset[0] * (number(first) - 0.5) + cell.offset[1] * (number(first + 1) - 0.5);
        let top =
            (0.55 + 0.45 * number(0) + 0.7 * face(1)).min(0.8 + 1.6 * face(3)).min(0.85 + 1.6 * face(5));
        let is_there = number(7) < self.density;
        let height = if is_there { smoothstep(0.02, 0.22, gap) * top.max(0.1) } else { 0.0 };
        Stone { height, look: [number(8), number(9)] }
    }
}

/// Colour of a stone. `look` is its brightness and hue, 0 to 1; `tone` is added to the brightness.
fn rock(look: [f32; 2], tone: f32) -> [f32; 3] {
    let grey = ramp(&[[0.36, 0.34, 0.32], [0.52, 0.50, 0.47], [0.66, 0.64, 0.60]], look[0] + tone);
    mixed(grey, [grey[0] * 1.12, grey[1] * 0.98, grey[2] * 0.82], look[1])
}

/// Generates the texels of a slope of broken stones, large ones over small ones.
pub fn scree() -> Vec<u8> {
    let grains = Noise::new(301, [60, 60], 3, 0.6);
    let layers =
        [Stones::new(311, 44, 0.9, 0.36), Stones::new(331, 24, 0.8, 0.62), Stones::new(351, 13, 0.55, 1.0)];
    let (heights, colors) = apart(made(|at| {
        let grain = grains.at(at);
        let mut found =
            (0.06 + 0.03 * grain, [0.27, 0.25, 0.22].map(|channel| channel * (1.0 + 0.3 * grain)));
        for stones in &layers {
            let stone = stones.at(at);
            let height = stones.size * stone.height;
            if stone.height > 0.05 && height > found.0 {
                found = (height + 0.02 * grain, rock(stone.look, 0.16 * grain + 0.15 * (stone.height - 0.6)));
            }
        }
        found
    }));
    shaded(&stretched(heights), colors, 1.0)
}

/// Generates the texels of soil: crumbs of earth with a few stones.
pub fn soil() -> Vec<u8> {
    let (crumbling, damps) = (Noise::new(401, [14, 14], 6, 0.68), Noise::new(421, [7, 7], 3, 0.5));
    let layers = [Stones::new(431, 64, 0.12, 0.45), Stones::new(451, 29, 0.06, 0.7)];
    let (heights, colors) = apart(made(|at| {
        let crumbs = crumbling.at(at);
        let clod = cell(411, [37; 2], at);
        let lump = 1.0 - clod.distances[0];
        let damp = damps.at(at);
        let earth = 0.30 + 0.26 * crumbs + 0.14 * lump;
        let color = ramp(
            &[[0.19, 0.14, 0.10], [0.33, 0.25, 0.18], [0.45, 0.36, 0.27]],
            0.45 + 0.5 * crumbs + 0.2 * (lump - 0.6) - 0.12 * damp,
        );
        let mut found = (earth, color);
        for stones in &layers {
            let stone = stones.at(at);
            let height = 0.12 + stones.size * stone.height;
            if stone.height > 0.05 && height > found.0 {
                found = (height, mixed(rock(stone.look, 0.1 * crumbs - 0.1), color, 0.5));
            }
        }
        found
    }));
    shaded(&stretched(heights), colors, 1.0)
}
