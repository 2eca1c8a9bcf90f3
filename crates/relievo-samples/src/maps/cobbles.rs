//! Height map of a pavement of rounded stones. Stones are the cells around jittered points (Worley 1996); corners between
//! neighbouring stones are rounded off.

use super::noise::{Noise, cell, random};
use super::{Pattern, Sample, blend, blend_color, shade, smooth_step};

/// Number of stones along an edge of the tile. It must be even, so that shifted rows also alternate across the tile's seam.
const STONES: usize = 10;

/// Distances in cells: the horizontal shift of a stone's center from its cell's center, alternating left and right by row; and
/// the largest random jitter on top of the shift.
const SHIFT: f64 = 0.25;
const JITTER: f64 = 0.24;

/// Half the width of the gap between stones, and the width of a stone's rounded rim, in cells.
const GAP: f64 = 0.035;
const RIM: f64 = 0.36;

/// Distance in cells below which two neighbouring borders are joined by a rounded corner.
const ROUNDING: f64 = 0.24;

const STONE: [[f64; 3]; 3] = [[96.0, 97.0, 102.0], [134.0, 131.0, 126.0], [150.0, 136.0, 118.0]];
const SOIL: [f64; 3] = [72.0, 63.0, 50.0];
const MOSS: [f64; 3] = [74.0, 82.0, 44.0];

pub struct Cobbles {
    middles: Vec<[f64; 2]>,
    wobble: [Noise; 2],
    bumps: Noise,
    grain: Noise,
    patches: Noise,
}

/// The stone that contains a point.
struct Stone {
    id: [usize; 2],
    /// Vector from the given point to the stone's center, in cells.
    offset: [f64; 2],
    /// Distance of the point from the stone's border, in cells.
    border: f64,
}

impl Cobbles {
    pub fn new() -> Self {
        let middle = |index: usize| {
            let [x, y] =
                random(21, [index % STONES, index / STONES]).map(|along| JITTER * (2.0 * along - 1.0));
            let shift = if (index / STONES).is_multiple_of(2) { SHIFT } else { -SHIFT };
            [0.5 + shift + x, 0.5 + y]
        };
        Self {
            middles: (0..STONES * STONES).map(middle).collect(),
            wobble: [Noise::new(22, 14, 3), Noise::new(23, 14, 3)],
            bumps: Noise::new(24, 20, 3),
            grain: Noise::new(25, 72, 2),
            patches: Noise::new(26, 5, 4),
        }
    }

    /// Index of the stone `step` cells away from cell `[x, y]`, and the vector from a point in that cell to the stone's center,
    /// in cells.
    fn towards(&self, [x, y]: [usize; 2], point: [f64; 2], step: [i32; 2]) -> ([usize; 2], [f64; 2]) {
        let wrapped =
            |index: usize, step: i32| (index + STONES).saturating_add_signed(step as isize) % STONES;
        let id = [wrapped(x, step[0]), wrapped(y, step[1])];
        let middle = self.middles[id[1] * STONES + id[0]];
        (id, [0, 1].map(|axis| f64::from(step[axis]) + middle[axis] - point[axis]))
    }

    fn stone(&self, u: f64, v: f64) -> Stone {
        let ((x, s), (y, t)) = (cell(u * STONES as f64, STONES), cell(v * STONES as f64, STONES));
        // Centers are away from the edges of their cells, so all neighbouring stones are within two cells.
        let steps = || (-2..=2).flat_map(|y| (-2..=2).map(move |x| [x, y]));
        let all = || steps().map(|step| self.towards([x, y], [s, t], step));
        let square = |[x, y]: [f64; 2]| x * x + y * y;
        let nearer =
            |a: &([usize; 2], [f64; 2]), b: &([usize; 2], [f64; 2])| square(a.1).total_cmp(&square(b.1));
        let (id, nearest) = all().min_by(nearer).unwrap_or_default();
        let mut border = f64::INFINITY;
        for (other, towards) in all() {
            if other == id {
                continue;
            }
            let between = [towards[0] - nearest[0], towards[1] - nearest[1]];
            let middle = [0.5 * (towards[0] + nearest[0]), 0.5 * (towards[1] + nearest[1])];
            let distance = (middle[0] * between[0] + middle[1] * between[1]) / square(between).sqrt();
            border = smooth_minimum(border, distance);
        }
        Stone { id, offset: nearest, border }
    }
}

/// Smooth minimum: less than both arguments if they differ by less than `ROUNDING`, otherwise the smaller argument.
fn smooth_minimum(a: f64, b: f64) -> f64 {
    let overlap = (ROUNDING - (a - b).abs()).max(0.0) / ROUNDING;
    a.min(b) - 0.25 * ROUNDING * overlap * overlap
}

impl Pattern for Cobbles {
    fn at(&self, u: f64, v: f64) -> Sample {
        let [du, dv] = [0, 1].map(|axis| 0.009 * self.wobble[axis].signed(u, v));
        let stone = self.stone(u + du, v + dv);
        let ([tone, warmth], [rise, _], [tilt_x, tilt_y]) =
            (random(27, stone.id), random(28, stone.id), random(29, stone.id));
        let (bumps, grain, patches) =
            (self.bumps.signed(u, v), self.grain.signed(u, v), self.patches.at(u, v));
        let fraction = ((stone.border - GAP) / RIM).clamp(0.0, 1.0);
        let tilt = 0.22 * ((tilt_x - 0.5) * stone.offset[0] + (tilt_y - 0.5) * stone.offset[1]);
        // Profile of a quarter circle: steep at the gap, flat at the top.
        let dome = (fraction * (2.0 - fraction)).sqrt();
        let top = 0.90 - 0.16 * rise + tilt + 0.05 * bumps + 0.018 * grain;
        let gap = 0.13 + 0.08 * bumps + 0.05 * grain;
        let height = blend(gap, top, dome);

        let granite = blend_color(STONE[0], STONE[1], tone);
        let granite = blend_color(granite, STONE[2], 0.8 * warmth * warmth);
        let granite = shade(granite, 0.86 + 0.22 * patches + 0.10 * grain + 0.08 * bumps);
        let ground = blend_color(SOIL, MOSS, smooth_step(0.45, 0.62, patches));
        let ground = shade(ground, 1.0 + 0.25 * grain);
        Sample { height, color: blend_color(ground, granite, smooth_step(0.0, 0.10, fraction)) }
    }
}
