//! Height map of a brick wall in running bond: every second course is shifted by half a brick.

use super::noise::{Noise, cell, random};
use super::{Pattern, Sample, blend, blend_color, shade, smooth_step};

/// Number of courses (rows of bricks) per tile. It must be even, so that courses also alternate across the tile's seam.
const COURSES: usize = 8;

/// Number of bricks per course.
const BRICKS: usize = 4;

/// Width of a joint, width of a brick's rounded edge, and radius of a brick's rounded corner, in tiles.
const JOINT: f64 = 0.015;
const BEVEL: f64 = 0.011;
const CORNER: f64 = 0.010;

/// Colours of burnt clay from dark to light, in sRGB, 0 to 255.
const CLAY: [[f64; 3]; 3] = [[112.0, 54.0, 44.0], [153.0, 75.0, 56.0], [180.0, 101.0, 73.0]];
const MORTAR: [f64; 3] = [171.0, 163.0, 149.0];

pub struct Bricks {
    wobble: [Noise; 2],
    wear: Noise,
    grain: Noise,
    stain: Noise,
}

impl Bricks {
    pub fn new() -> Self {
        Self {
            wobble: [Noise::new(1, 10, 2), Noise::new(2, 10, 2)],
            wear: Noise::new(3, 24, 3),
            grain: Noise::new(4, 64, 2),
            stain: Noise::new(5, 6, 5),
        }
    }
}

/// Brick at a point: the column and course of its cell, and the point relative to the brick's center, in tiles.
fn brick(u: f64, v: f64) -> ([usize; 2], [f64; 2]) {
    let (course, y) = cell(v * COURSES as f64, COURSES);
    let shift = 0.5 * (course % 2) as f64;
    let (column, x) = cell(u * BRICKS as f64 - shift, BRICKS);
    ([column, course], [(x - 0.5) / BRICKS as f64, (y - 0.5) / COURSES as f64])
}

/// Distance by which a point lies inside a rectangle with rounded corners; negative outside. `half` are half its edges.
fn depth_inside(offset: [f64; 2], half: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis| offset[axis].abs() - half[axis] + CORNER);
    let (beyond_x, beyond_y) = (x.max(0.0), y.max(0.0));
    CORNER - (beyond_x * beyond_x + beyond_y * beyond_y).sqrt() - x.max(y).min(0.0)
}

impl Pattern for Bricks {
    fn at(&self, u: f64, v: f64) -> Sample {
        let [du, dv] = [0, 1].map(|axis| 0.003 * self.wobble[axis].signed(u, v));
        let (id, offset) = brick(u + du, v + dv);
        let ([tone, rise], [tilt_x, tilt_y], [shrink_x, shrink_y]) =
            (random(11, id), random(12, id), random(13, id));
        let half = [0.5 / BRICKS as f64, 0.5 / COURSES as f64];
        let half = [half[0] - 0.5 * JOINT - 0.002 * shrink_x, half[1] - 0.5 * JOINT - 0.0015 * shrink_y];
        let (wear, grain) = (self.wear.signed(u, v), self.grain.signed(u, v));
        // Edges of bricks crumble where the wear is strongest.
        let inside = depth_inside(offset, half) - 0.006 * (wear - 0.25).max(0.0);
        let fraction = (inside / BEVEL).clamp(0.0, 1.0);
        let tilt = 0.5 * ((tilt_x - 0.5) * offset[0] + (tilt_y - 0.5) * offset[1]);
        let top = 0.86 + 0.08 * (rise - 0.5) + tilt + 0.045 * wear + 0.025 * grain;
        let joint = 0.24 + 0.05 * wear + 0.05 * grain;
        let height = blend(joint, top, fraction * (2.0 - fraction));

        let stain = self.stain.at(u, v);
        let clay = blend_color(CLAY[0], CLAY[1], 2.0 * tone);
        let clay = blend_color(clay, CLAY[2], 2.0 * tone - 1.0);
        let clay = shade(clay, 0.82 + 0.36 * stain + 0.07 * grain + 0.05 * wear);
        let mortar = shade(MORTAR, 0.85 + 0.25 * stain + 0.10 * grain);
        Sample { height, color: blend_color(mortar, clay, smooth_step(0.0, 0.35, fraction)) }
    }
}
