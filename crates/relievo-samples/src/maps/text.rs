//! Height map of a limestone slab with a raised word, a carved line of text below the word, and a carved frame.

use super::letters::Line;
use super::noise::Noise;
use super::{Pattern, Sample, blend, blend_color, shade, smooth_step};

/// Heights of the slab's face, of the tops of the letters, and of the bottom of the grooves, 0 to 1.
const FACE: f64 = 0.48;
const TOP: f64 = 0.97;
const GROUND: f64 = 0.12;

/// Width of the slanted edges of letters and grooves, in tiles.
const BEVEL: f64 = 0.008;

/// Widths by which the outlines of raised and carved letters are moved outwards, in tiles. Letters are bolder than the typeface.
const BOLDER: [f64; 2] = [0.008, 0.003];

/// Distances in tiles: from the tile's edge to the middle of the frame; half the frame's width; half the length of the rule, the
/// straight groove between the lines of text.
const FRAME: f64 = 0.045;
const FRAME_HALF: f64 = 0.008;
const RULE: f64 = 0.30;

const STONE: [f64; 3] = [201.0, 192.0, 174.0];
const RAISED: [f64; 3] = [58.0, 66.0, 82.0];
const INK: [f64; 3] = [44.0, 38.0, 34.0];

pub struct Text {
    raised: Line,
    cut: Line,
    tooling: Noise,
    grain: Noise,
    stain: Noise,
}

impl Text {
    pub fn new() -> Self {
        Self {
            raised: Line::new("RELIEVO", [0.5, 0.34], 0.80, 1.50),
            cut: Line::new("alto e basso", [0.5, 0.73], 0.80, 1.35),
            tooling: Noise::new(41, 24, 3),
            grain: Noise::new(42, 80, 2),
            stain: Noise::new(43, 4, 5),
        }
    }

    /// Distance in tiles by which a point lies inside a groove: the frame, the rule or a carved letter. Negative outside.
    fn groove(&self, [u, v]: [f64; 2]) -> f64 {
        let edge = [u, v].map(|along| along.min(1.0 - along));
        let frame = FRAME_HALF - (edge[0].min(edge[1]) - FRAME).abs();
        let rule = (RULE - (u - 0.5).abs()).min(0.75 * FRAME_HALF - (v - 0.565).abs());
        let letter = self.cut.depth_inside([u, v], 3.0 * BEVEL) + BOLDER[1];
        frame.max(rule).max(letter)
    }
}

impl Pattern for Text {
    fn at(&self, u: f64, v: f64) -> Sample {
        let point = [u - u.floor(), v - v.floor()];
        let (tooling, grain, stain) =
            (self.tooling.signed(u, v), self.grain.signed(u, v), self.stain.at(u, v));
        let raised = (self.raised.depth_inside(point, 3.0 * BEVEL) + BOLDER[0]) / BEVEL;
        let groove = self.groove(point) / BEVEL;
        let face = FACE + 0.022 * tooling + 0.012 * grain;
        let height = blend(face, TOP + 0.010 * tooling, smooth_step(0.0, 1.0, raised));
        let height = blend(height, GROUND + 0.02 * tooling, smooth_step(0.0, 1.0, groove));

        let stone = shade(STONE, 0.84 + 0.3 * stain + 0.06 * grain + 0.04 * tooling);
        let color = blend_color(stone, shade(RAISED, 0.9 + 0.2 * stain), smooth_step(0.3, 0.7, raised));
        Sample {
            height,
            color: blend_color(color, shade(INK, 1.0 + 0.1 * grain), smooth_step(0.2, 0.6, groove)),
        }
    }
}
