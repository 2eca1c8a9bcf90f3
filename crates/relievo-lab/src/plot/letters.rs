//! Text in pictures, in a typeface that is a part of the program, so that no font of the system is needed.

use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Ubuntu Light (Ubuntu font licence). plotters ignores the bearing of glyphs, which tears digits of monospaced type apart.
const NAME: &str = "Ubuntu Light";

/// Registers the typeface, which is needed before anything is written.
pub fn register() {
    // It fails for bytes that are no font.
    let _ = register_font(NAME, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
}

/// The style of a text of `size` pixels per em, which is centered vertically.
pub fn style(size: f64, side: HPos, color: RGBColor) -> TextStyle<'static> {
    let (font, pos) = ((NAME, 1.16 * size).into_font(), Pos::new(side, VPos::Center));
    TextStyle { font, pos, color: color.to_backend_color() }
}
