//! In the place of `harfrust`, what egui 0.37 uses of it: a glyph for each character, as wide as the font says.
//!
//! The viewer writes Latin letters from left to right, and its typeface joins none of them. `harfrust` shapes every script, which
//! is a twentieth of the viewer's page. The root manifest replaces the crate by this one (`[patch.crates-io]`), natively too, so
//! that both write the same. Letters are not moved nearer in pairs (kerning), and marks do not move onto the letter before them.
//! Programs that depend on `relievo-viewer` from elsewhere have the original.

use std::ops::BitOrAssign;

use skrifa::instance::{Location, LocationRef, Size};
use skrifa::{FontRef, MetadataProvider as _, Tag};

/// Data of a font that shapers share. This crate needs none.
#[derive(Debug, Default)]
pub struct ShaperData;

impl ShaperData {
    /// The data of a font.
    pub fn new(_: &FontRef<'_>) -> Self {
        Self
    }

    /// Begins a shaper of a font.
    pub fn shaper<'a>(&'a self, font: &FontRef<'a>) -> ShaperBuilder<'a> {
        ShaperBuilder { font: font.clone(), at: LocationRef::default() }
    }
}

/// The place of a setting on an axis of a variable font.
#[derive(Debug, Clone, Copy)]
pub struct Variation {
    /// The axis.
    pub tag: Tag,
    /// The setting.
    pub value: f32,
}

/// The settings of a variable font.
#[derive(Debug)]
pub struct ShaperInstance(Location);

impl ShaperInstance {
    /// The settings of a font on some of its axes.
    pub fn from_variations(font: &FontRef<'_>, all: impl IntoIterator<Item = Variation>) -> Self {
        Self(font.axes().location(all.into_iter().map(|Variation { tag, value }| (tag, value))))
    }
}

/// A shaper that is being made.
pub struct ShaperBuilder<'a> {
    font: FontRef<'a>,
    at: LocationRef<'a>,
}

impl<'a> ShaperBuilder<'a> {
    /// With the settings of a variable font.
    pub fn instance(self, instance: Option<&'a ShaperInstance>) -> Self {
        Self { at: instance.map_or_else(LocationRef::default, |ShaperInstance(at)| at.into()), ..self }
    }

    /// The shaper.
    pub fn build(self) -> Shaper<'a> {
        Shaper(self)
    }
}

/// Finds the glyphs of a text.
pub struct Shaper<'a>(ShaperBuilder<'a>);

impl Shaper<'_> {
    /// The glyphs of a text, from left to right.
    pub fn shape(&self, text: UnicodeBuffer, _: ShapeOptions) -> GlyphBuffer {
        let Self(ShaperBuilder { font, at }) = self;
        let (glyph_of, sizes) = (font.charmap(), font.glyph_metrics(Size::unscaled(), *at));
        let UnicodeBuffer { text, mut infos, mut positions } = text;
        for (cluster, letter) in text.char_indices() {
            let glyph = glyph_of.map(letter).unwrap_or_default();
            let x_advance = match letter {
                // Nothing to see: marks of direction, of places to break, and of joints.
                '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{feff}' => 0,
                _ => sizes.advance_width(glyph).unwrap_or_default().round() as i32,
            };
            infos.push(GlyphInfo { glyph_id: glyph.to_u32(), cluster: cluster as u32 });
            positions.push(GlyphPosition { x_advance, ..GlyphPosition::default() });
        }
        GlyphBuffer(UnicodeBuffer { text, infos, positions })
    }
}

/// A text to shape.
#[derive(Debug, Default)]
pub struct UnicodeBuffer {
    text: String,
    infos: Vec<GlyphInfo>,
    positions: Vec<GlyphPosition>,
}

impl UnicodeBuffer {
    /// An empty text.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends to the text.
    pub fn push_str(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Letters do not depend on where the text begins and ends.
    pub fn set_flags(&mut self, _: BufferFlags) {}

    /// Script and direction: all text goes from left to right.
    pub fn guess_segment_properties(&mut self) {}
}

/// The glyphs of a text.
#[derive(Debug)]
pub struct GlyphBuffer(UnicodeBuffer);

impl GlyphBuffer {
    /// The glyphs.
    pub fn glyph_infos(&self) -> &[GlyphInfo] {
        &self.0.infos
    }

    /// Where the glyphs are.
    pub fn glyph_positions(&self) -> &[GlyphPosition] {
        &self.0.positions
    }

    /// The memory, for the next text.
    pub fn clear(self) -> UnicodeBuffer {
        let Self(mut buffer) = self;
        buffer.text.clear();
        buffer.infos.clear();
        buffer.positions.clear();
        buffer
    }
}

/// A glyph.
#[derive(Debug, Clone, Copy)]
pub struct GlyphInfo {
    /// The index in the font.
    pub glyph_id: u32,
    /// The first byte of the letter in the text.
    pub cluster: u32,
}

/// Where a glyph is, in units of the font.
#[derive(Debug, Clone, Copy, Default)]
pub struct GlyphPosition {
    /// The distance from the glyph's origin to the next glyph's origin.
    pub x_advance: i32,
    /// The vertical part of that distance: 0.
    pub y_advance: i32,
    /// The horizontal displacement of the glyph: 0.
    pub x_offset: i32,
    /// The vertical displacement of the glyph: 0.
    pub y_offset: i32,
}

/// Options of a shaper. This crate has none.
#[derive(Debug, Default)]
pub struct ShapeOptions;

impl ShapeOptions {
    /// The options.
    pub fn new() -> Self {
        Self
    }
}

/// Flags that tell whether a text begins or ends a paragraph.
#[derive(Debug, Clone, Copy)]
pub struct BufferFlags(u8);

impl BufferFlags {
    /// The text begins a paragraph.
    pub const BEGINNING_OF_TEXT: Self = Self(1);
    /// The text ends a paragraph.
    pub const END_OF_TEXT: Self = Self(2);

    /// Nothing.
    pub fn empty() -> Self {
        Self(0)
    }
}

impl BitOrAssign for BufferFlags {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}
