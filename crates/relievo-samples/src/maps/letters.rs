//! Lines of text as distances to the letters' outlines. With distances, edges can have any width at any resolution.

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider as _};

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
        let font = FontRef::new(LETTERS).expect("the font of the crate");
        let (glyph_of, outlines) = (font.charmap(), font.outline_glyphs());
        let sizes = font.glyph_metrics(Size::unscaled(), LocationRef::default());
        let glyph = |letter: char| glyph_of.map(letter).unwrap_or_default();
        let advance = |letter| f64::from(sizes.advance_width(glyph(letter)).unwrap_or_default());
        // In units of the font.
        let outline = |letter| {
            let mut pen = Pen::default();
            let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
            if let Some(outline) = outlines.get(glyph(letter)) {
                outline.draw(settings, &mut pen).expect("an outline of the font of the crate");
            }
            pen.curves
        };
        let scale = width / text.chars().map(advance).sum::<f64>();
        let capital = outline('H').iter().flatten().map(|point| point[1]).fold(0.0, f64::max);
        let mut pen = middle[0] - 0.5 * width;
        let mut glyphs = Vec::new();
        for letter in text.chars() {
            let position =
                |[x, y]: [f64; 2]| [pen + scale * x, middle[1] + stretch * scale * (0.5 * capital - y)];
            let edges = outline(letter).iter().flat_map(|curve| edges(curve, position)).collect();
            glyphs.extend(Glyph::new(edges));
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

/// Collects the curves of an outline: two points of a line, three of a quadratic curve, or four of a cubic one.
#[derive(Default)]
struct Pen {
    start: [f64; 2],
    at: [f64; 2],
    curves: Vec<Vec<[f64; 2]>>,
}

impl Pen {
    fn to<const N: usize>(&mut self, points: [[f32; 2]; N]) {
        let points = points.map(|point| point.map(f64::from));
        self.curves.push([&[self.at], &points[..]].concat());
        self.at = points[N - 1];
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.start = [x, y].map(f64::from);
        self.at = self.start;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.to([[x, y]]);
    }

    fn quad_to(&mut self, bx: f32, by: f32, x: f32, y: f32) {
        self.to([[bx, by], [x, y]]);
    }

    fn curve_to(&mut self, bx: f32, by: f32, cx: f32, cy: f32, x: f32, y: f32) {
        self.to([[bx, by], [cx, cy], [x, y]]);
    }

    fn close(&mut self) {
        if self.at != self.start {
            self.curves.push(vec![self.at, self.start]);
        }
    }
}

/// Approximates a curve by straight segments.
fn edges(curve: &[[f64; 2]], position: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let points: Vec<[f64; 2]> = curve.iter().map(|point| position(*point)).collect();
    // A quadratic curve is converted to an equal cubic curve.
    let controls = match points[..] {
        [a, b, c] => {
            let third = |end: [f64; 2]| [0, 1].map(|axis| (end[axis] + 2.0 * b[axis]) / 3.0);
            [a, third(a), third(c), c]
        }
        [a, b, c, d] => [a, b, c, d],
        _ => return vec![[points[0], points[1]]],
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
