//! Draws text into pictures, in a typeface that is a part of the program, so that no font of the system is
//! needed.

use ab_glyph::{Font as _, FontRef, Glyph, PxScale, ScaleFont as _, point};
use plotters::coord::Shift;
use plotters::prelude::*;

/// The result of drawing.
pub type Drawn<'a> = Result<(), DrawingAreaErrorKind<<BitMapBackend<'a> as DrawingBackend>::ErrorType>>;

/// Where a text lies relative to its position: to the right, centered, or to the left. Vertically it is
/// centered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    Left,
    Center,
    Right,
}

/// The typeface Hack (MIT and Bitstream Vera licences).
pub struct Letters(FontRef<'static>);

impl Letters {
    pub fn new() -> Self {
        Self(FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR).expect("the font of the program"))
    }

    fn scale(&self, size: f64) -> PxScale {
        let em = self.0.units_per_em().unwrap_or(1.0);
        PxScale::from(size as f32 * self.0.height_unscaled() / em)
    }

    /// Width of a text in pixels.
    pub fn width(&self, text: &str, size: f64) -> i32 {
        let font = self.0.as_scaled(self.scale(size));
        text.chars().map(|letter| font.h_advance(font.glyph_id(letter))).sum::<f32>().ceil() as i32
    }

    /// Draws a text of `size` pixels per em; `upwards` turns it by 90 degrees, to be read from below upwards.
    pub fn write<'b>(
        &self,
        area: &DrawingArea<BitMapBackend<'b>, Shift>,
        text: &str,
        (x, y): (i32, i32),
        (size, align, upwards): (f64, Align, bool),
        color: RGBColor,
    ) -> Drawn<'b> {
        let scale = self.scale(size);
        let font = self.0.as_scaled(scale);
        let width = self.width(text, size) as f32;
        let mut pen = match align {
            Align::Left => 0.0,
            Align::Center => -0.5 * width,
            Align::Right => -width,
        };
        // Capitals of Hack are 0.73 em high: half of it centers them.
        let baseline = 0.365 * size as f32;
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            let glyph: Glyph = id.with_scale_and_position(scale, point(pen, baseline));
            pen += font.h_advance(id);
            let Some(outline) = self.0.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            let mut drawn = Ok(());
            outline.draw(|column, row, coverage| {
                let (across, down) = (corner.x as i32 + column as i32, corner.y as i32 + row as i32);
                let pixel = if upwards { (x + down, y - across) } else { (x + across, y + down) };
                let done = area.draw_pixel(pixel, &color.mix(f64::from(coverage.min(1.0))));
                drawn = std::mem::replace(&mut drawn, Ok(())).and(done);
            });
            drawn?;
        }
        Ok(())
    }
}
