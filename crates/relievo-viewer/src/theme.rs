//! The look of the panel: one typeface, and quiet colours, light and dark.

use std::sync::Arc;

use egui::{Color32, CornerRadius, FontData, FontDefinitions, FontFamily, Stroke, Theme, Visuals};

use crate::settings;

/// Letters of the typeface Inter (SIL Open Font License: `fonts/Inter-LICENSE.txt`): Latin, Greek, and the signs of the panel. All of
/// its letters would be a tenth of the page.
const LETTERS: &[u8] = include_bytes!("../fonts/Inter-letters.otf");

/// The colour of what is active: links, sliders, selected text.
pub const ACCENT: Color32 = Color32::from_rgb(0x3d, 0x8b, 0xd6);

/// Colours of the series of plots.
pub const SERIES: [Color32; 6] = [
    Color32::from_rgb(0x3d, 0x8b, 0xd6),
    Color32::from_rgb(0xe0, 0x8a, 0x2e),
    Color32::from_rgb(0x4c, 0xa8, 0x5b),
    Color32::from_rgb(0xd6, 0x4f, 0x6a),
    Color32::from_rgb(0x9a, 0x6f, 0xd0),
    Color32::from_rgb(0x2f, 0xa5, 0xa5),
];

/// Sets typeface, colours and sizes of a context.
pub fn dress(egui: &egui::Context, theme: settings::Theme) {
    egui.set_fonts(fonts());
    egui.set_theme(theme.preference());
    for theme in [Theme::Light, Theme::Dark] {
        egui.set_visuals_of(theme, visuals(theme));
        egui.style_mut_of(theme, |style| {
            style.spacing.item_spacing = egui::vec2(8.0, 6.0);
            style.spacing.slider_width = 120.0;
            style.spacing.interact_size.y = 20.0;
            style.interaction.tooltip_delay = 0.6;
        });
    }
}

fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    let name = "letters".to_owned();
    let letters = FontData::from_static(LETTERS);
    fonts.font_data.insert(name.clone(), Arc::new(letters));
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.insert(family, vec![name.clone()]);
    }
    fonts
}

fn visuals(theme: Theme) -> Visuals {
    let gray = Color32::from_gray;
    let mut visuals = match theme {
        Theme::Dark => Visuals::dark(),
        Theme::Light => Visuals::light(),
    };
    let (panel, text, line) = match theme {
        Theme::Dark => (Color32::from_rgb(0x1e, 0x21, 0x26), gray(0xd6), gray(0x38)),
        Theme::Light => (Color32::from_rgb(0xf6, 0xf7, 0xf9), gray(0x22), gray(0xd0)),
    };
    visuals.panel_fill = panel;
    visuals.window_fill = panel;
    visuals.override_text_color = Some(text);
    visuals.hyperlink_color = ACCENT;
    visuals.selection.bg_fill = ACCENT.gamma_multiply(0.55);
    visuals.selection.stroke = Stroke::new(1.0, text);
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, line);
    visuals.slider_trailing_fill = true;
    for widget in [&mut visuals.widgets.inactive, &mut visuals.widgets.hovered, &mut visuals.widgets.active] {
        widget.corner_radius = CornerRadius::same(4);
        widget.expansion = 0.0;
    }
    visuals
}
