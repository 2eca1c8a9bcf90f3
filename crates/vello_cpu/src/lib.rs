//! In the place of `vello_cpu`, what egui 0.37 uses of it: fills the outline of a letter in white.
//!
//! `vello_cpu` compiles two pipelines with all blends and paints for that, which is a fifth of the viewer's page. The root manifest
//! replaces the crate by this one (`[patch.crates-io]`), natively too, so that both draw the same letters. Programs that depend
//! on `relievo-viewer` from elsewhere have the original.

use ab_glyph_rasterizer::{Point, Rasterizer};
pub use color;
pub use kurbo;

/// A picture that a path is filled into.
#[derive(Debug)]
pub struct RenderContext {
    rasterizer: Rasterizer,
    transform: kurbo::Affine,
    width: usize,
}

/// What `vello_cpu` keeps between pictures: nothing here.
#[derive(Debug, Default)]
pub struct Resources;

/// Pixels of red, green, blue and alpha, multiplied by alpha.
#[derive(Debug)]
pub struct Pixmap(Vec<u8>);

impl RenderContext {
    /// An empty picture of so many pixels.
    pub fn new(width: u16, height: u16) -> Self {
        let [width, height] = [width, height].map(usize::from);
        Self { rasterizer: Rasterizer::new(width, height), transform: kurbo::Affine::IDENTITY, width }
    }

    /// The transform of paths into the picture.
    pub fn set_transform(&mut self, transform: kurbo::Affine) {
        self.transform = transform;
    }

    /// The colour of paths. Letters are white, and their colour comes later.
    pub fn set_paint(&mut self, _: color::OpaqueColor<color::Srgb>) {}

    /// Fills a path by the rule of non-zero winding. The picture has the fraction of each pixel that is inside.
    pub fn fill_path(&mut self, path: &kurbo::BezPath) {
        let at = |point: kurbo::Point| {
            let point = self.transform * point;
            Point { x: point.x as f32, y: point.y as f32 }
        };
        let (mut first, mut last) = (Point::default(), Point::default());
        for part in path.elements() {
            match *part {
                kurbo::PathEl::MoveTo(to) => {
                    self.rasterizer.draw_line(last, first);
                    first = at(to);
                    last = first;
                }
                kurbo::PathEl::LineTo(to) => {
                    let to = at(to);
                    self.rasterizer.draw_line(last, to);
                    last = to;
                }
                kurbo::PathEl::QuadTo(control, to) => {
                    let [control, to] = [control, to].map(at);
                    self.rasterizer.draw_quad(last, control, to);
                    last = to;
                }
                kurbo::PathEl::CurveTo(one, other, to) => {
                    let [one, other, to] = [one, other, to].map(at);
                    self.rasterizer.draw_cubic(last, one, other, to);
                    last = to;
                }
                kurbo::PathEl::ClosePath => {
                    self.rasterizer.draw_line(last, first);
                    last = first;
                }
            }
        }
        self.rasterizer.draw_line(last, first);
    }

    /// Writes the picture into a pixmap of the same size.
    pub fn render(&mut self, pixmap: &mut Pixmap, _: &mut Resources) {
        let width = self.width;
        self.rasterizer.for_each_pixel_2d(|x, y, inside| {
            let level = (255.0 * inside.clamp(0.0, 1.0)).round() as u8;
            pixmap.0[4 * (y as usize * width + x as usize)..][..4].fill(level);
        });
    }
}

impl Resources {
    /// Nothing.
    pub fn new() -> Self {
        Self
    }
}

impl Pixmap {
    /// Transparent pixels.
    pub fn new(width: u16, height: u16) -> Self {
        Self(vec![0; 4 * usize::from(width) * usize::from(height)])
    }

    /// The pixels, row by row.
    pub fn data_as_u8_slice(&self) -> &[u8] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_have_the_part_that_is_inside() {
        let mut context = RenderContext::new(4, 3);
        context.set_transform(kurbo::Affine::translate((-10.0, -20.0)));
        // From 1 to 3.5 across, from 0.5 to 2 down.
        context
            .fill_path(&kurbo::BezPath::from_svg("M11 20.5 L13.5 20.5 L13.5 22 L11 22 Z").expect("a path"));
        let mut pixels = Pixmap::new(4, 3);
        context.render(&mut pixels, &mut Resources::new());
        let alpha: Vec<u8> = pixels.data_as_u8_slice().iter().skip(3).step_by(4).copied().collect();
        assert_eq!(alpha, [0, 128, 128, 64, 0, 255, 255, 128, 0, 0, 0, 0]);
    }
}
