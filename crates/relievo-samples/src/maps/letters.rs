//! Lines of text as distances to the letters' outlines. With distances, edges can have any width at any resolution.

use ab_glyph::{Font, FontRef, OutlineCurve, Point};

/// Number of straight segments that replace a curve.
const PIECES: usize = 8;

/// The letters of the built-in lines, of the typeface Hack.
const LETTERS: &[u8] = include_bytes!("../../fonts/Hack-letters.ttf");

/// A line of text that is centered on a given point.
#[derive(Debug, Clone)]
pub struct Line {
    glyphs: Vec<Glyph>,
}

#[derive(Debug, Clone)]
struct Glyph {
    low: [f64; 2],
    high: [f64; 2],
    /// Straight segments of the glyph's closed outlines, each as its two end points.
    edges: Vec<[[f64; 2]; 2]>,
}

impl Line {
    /// Lays out `text`, `width` wide including the advances of all letters, and stretched vertically by `stretch`. Capital
    /// letters are centered on `middle`.
    pub fn new(text: &str, middle: [f64; 2], width: f64, stretch: f64) -> Self {
        let font = FontRef::try_from_slice(LETTERS).expect("the font of the crate");
        let advance = |letter| f64::from(font.h_advance_unscaled(font.glyph_id(letter)));
        let scale = width / text.chars().map(advance).sum::<f64>();
        let capital = font.outline(font.glyph_id('H')).map_or(0.0, |outline| {
            let bounds = outline.bounds;
            f64::from(bounds.min.y).max(f64::from(bounds.max.y))
        });
        let mut pen = middle[0] - 0.5 * width;
        let mut glyphs = Vec::new();
        for letter in text.chars() {
            let position = |point: Point| {
                let [x, y] = [point.x, point.y].map(f64::from);
                [pen + scale * x, middle[1] + stretch * scale * (0.5 * capital - y)]
            };
            if let Some(outline) = font.outline(font.glyph_id(letter)) {
                glyphs.extend(Glyph::new(
                    outline.curves.iter().flat_map(|curve| edges(curve, position)).collect(),
                ));
            }
            pen += scale * advance(letter);
        }
        Self { glyphs }
    }

    /// Distance from `position` to the nearest outline: positive inside letters, negative outside. The result is never below
    /// −`margin`.
    pub fn depth_inside(&self, position: [f64; 2], margin: f64) -> f64 {
        let near = |glyph: &&Glyph| {
            (0..2).all(|axis| {
                position[axis] > glyph.low[axis] - margin && position[axis] < glyph.high[axis] + margin
            })
        };
        self.glyphs.iter().filter(near).map(|glyph| glyph.depth_inside(position)).fold(-margin, f64::max)
    }
}

/// Approximates a curve by straight segments.
fn edges(curve: &OutlineCurve, position: impl Fn(Point) -> [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    // A quadratic curve is converted to an equal cubic curve.
    let controls = match *curve {
        OutlineCurve::Line(a, b) => return vec![[position(a), position(b)]],
        OutlineCurve::Quad(a, b, c) => {
            let [a, b, c] = [position(a), position(b), position(c)];
            let third = |end: [f64; 2]| [0, 1].map(|axis| (end[axis] + 2.0 * b[axis]) / 3.0);
            [a, third(a), third(c), c]
        }
        OutlineCurve::Cubic(a, b, c, d) => [position(a), position(b), position(c), position(d)],
    };
    let at = |piece: usize| {
        let t = piece as f64 / PIECES as f64;
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        [0, 1].map(|axis| (0..4).map(|index| weights[index] * controls[index][axis]).sum())
    };
    (0..PIECES).map(|piece| [at(piece), at(piece + 1)]).collect()
}

impl Glyph {
    /// Creates a glyph from its segments and computes its bounds. `None` if there are no segments.
    fn new(edges: Vec<[[f64; 2]; 2]>) -> Option<Self> {
        let points = || edges.iter().flatten();
        let bound = |pick: fn(f64, f64) -> f64, axis: usize| points().map(|point| point[axis]).reduce(pick);
        let low = [bound(f64::min, 0)?, bound(f64::min, 1)?];
        let high = [bound(f64::max, 0)?, bound(f64::max, 1)?];
        Some(Self { low, high, edges })
    }

    fn depth_inside(&self, [x, y]: [f64; 2]) -> f64 {
        let (mut nearest, mut winding) = (f64::INFINITY, 0);
        for [from, to] in &self.edges {
            let [along, towards] = [[to[0] - from[0], to[1] - from[1]], [x - from[0], y - from[1]]];
            let square = along[0] * along[0] + along[1] * along[1];
            let t = ((towards[0] * along[0] + towards[1] * along[1]) / square.max(1e-30)).clamp(0.0, 1.0);
            let [dx, dy] = [towards[0] - t * along[0], towards[1] - t * along[1]];
            nearest = nearest.min(dx * dx + dy * dy);
            let side = along[0] * towards[1] - along[1] * towards[0];
            if from[1] <= y && y < to[1] && side > 0.0 {
                winding += 1;
            } else if to[1] <= y && y < from[1] && side < 0.0 {
                winding -= 1;
            }
        }
        if winding == 0 { -nearest.sqrt() } else { nearest.sqrt() }
    }
}
