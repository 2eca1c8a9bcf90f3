//! What the viewer shows: the panel at the side, the status line, and the picture with what pointer and keys do to it.

mod controls;
mod keys;
mod plots;
mod scene;

use egui::{
    Align2, CentralPanel, Color32, CornerRadius, Frame, Panel, PointerButton, Rect, Sense, Stroke, Ui, vec2,
};

use crate::controls::Drag;
use crate::overlay::{self, Projected};
use crate::theme::ACCENT;
use crate::viewer::{Picture, Viewer};
use crate::wires::paint_wires;

/// Names, texts and titles of the scenes that the viewer brings along.
pub const EXAMPLES: [(&str, &str, &str); 4] = [
    ("start.json", include_str!("examples/start.json"), "A creature in mountains without end"),
    ("mountains.json", include_str!("examples/mountains.json"), "Mountains without end"),
    ("creature.json", include_str!("examples/creature.json"), "A creature of 153 bones"),
    ("crowd.json", include_str!("examples/crowd.json"), "A crowd of 100"),
];

/// Width of the panel in points.
const WIDTH: f32 = 320.0;

/// Width of the window in points below which the panel lies under the picture, not beside it.
const NARROW: f32 = 560.0;

/// Lays out a frame.
pub fn show(viewer: &mut Viewer, ui: &mut Ui) {
    keys::take(viewer, ui.ctx());
    status_line(viewer, ui);
    let [width, height] = ui.available_size().into();
    let mut is_open = viewer.settings.panel;
    let panel = if width < NARROW && width < height {
        Panel::bottom("panel below").default_size(0.45 * height).size_range(0.2 * height..=0.8 * height)
    } else {
        let range = 220.0_f32.min(0.8 * width)..=(0.8 * width).max(221.0);
        Panel::right("panel").default_size(WIDTH.min(0.82 * width)).size_range(range)
    };
    panel.resizable(true).show_collapsible(ui, &mut is_open, |ui| {
        egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| sections(viewer, ui));
    });
    viewer.settings.panel = is_open;
    CentralPanel::no_frame().show(ui, |ui| picture(viewer, ui));
    keys::list(viewer, ui.ctx());
    hovered_files(ui);
}

/// The sections of the panel.
fn sections(viewer: &mut Viewer, ui: &mut Ui) {
    // The bar that scrolls has room beside them.
    Frame::new().inner_margin(egui::Margin { right: 8, top: 2, bottom: 12, left: 0 }).show(ui, |ui| {
        scene::show(viewer, ui);
        controls::show(viewer, ui);
        plots::show(viewer, ui);
    });
}

/// A section with a title that folds.
fn section<R>(ui: &mut Ui, title: &str, is_open: bool, content: impl FnOnce(&mut Ui) -> R) {
    egui::CollapsingHeader::new(egui::RichText::new(title).strong())
        .default_open(is_open)
        .show(ui, |ui| content(ui));
}

/// A list that folds out, with a name for those who do not see it.
fn list<R>(ui: &mut Ui, label: &str, selected: &str, content: impl FnOnce(&mut Ui) -> R) {
    let response = egui::ComboBox::from_label(label).selected_text(selected).show_ui(ui, content).response;
    response.widget_info(|| {
        let info = egui::WidgetInfo::labeled(egui::Role::ComboBox, true, label);
        egui::WidgetInfo { current_text_value: Some(selected.to_owned()), ..info }
    });
}

/// The line below: time of a frame, triangles, bound of the error.
fn status_line(viewer: &mut Viewer, ui: &mut Ui) {
    Panel::bottom("status").frame(Frame::side_top_panel(ui.style()).inner_margin(4)).show(ui, |ui| {
        ui.horizontal(|ui| {
            let label = if viewer.settings.panel { "Hide panel" } else { "Show panel" };
            if ui.small_button(label).on_hover_text("P").clicked() {
                viewer.settings.panel = !viewer.settings.panel;
            }
            if ui.small_button("Keys").on_hover_text("The keys of the viewer: ?").clicked() {
                viewer.shows_keys = !viewer.shows_keys;
            }
            ui.separator();
            ui.add(egui::Label::new(status(viewer)).truncate()).on_hover_text(BOUND);
        });
    });
}

/// The hint of the status line: it explains the bound of the error.
const BOUND: &str = "An upper bound for everything that is drawn. It is above the limit where memory or a budget coarsens levels, \
                     while detail is on its way, and very near to a model of a package, whose vertices are rounded.";

/// What the status line says.
fn status(viewer: &Viewer) -> String {
    if let Some(step) = viewer.step() {
        return format!("{step} …");
    }
    if let Some(said) = viewer.said() {
        return said.to_owned();
    }
    if let Some((why, seconds)) = viewer.shown.as_ref().and_then(crate::shown::Shown::waits) {
        return format!("the server does not answer; it is asked again in {seconds:.0} s ({why})");
    }
    if viewer.compares && viewer.shown.as_ref().is_some_and(|shown| shown.full.is_none()) {
        return "fetching full detail …".to_owned();
    }
    let history = &viewer.history;
    let Some(last) = history.last() else { return "nothing is open".to_owned() };
    let frame = history.median(30, |sample| (sample.frame > 0.0).then_some(sample.frame));
    let time = match frame {
        _ if viewer.is_resting() => "resting until something is pressed or moved · ".to_owned(),
        Some(frame) => format!("{frame:.1} ms a frame · "),
        None => String::new(),
    };
    let is_coming =
        viewer.shown.as_ref().is_some_and(|shown| shown.is_streaming() || shown.stage.ready() < 1.0);
    let bound = match last.bound {
        Some(pixels) => format!("at most {pixels:.2} px off"),
        None if is_coming => "detail is on its way".to_owned(),
        None => "no bound of the error".to_owned(),
    };
    let is_site = |shown: &crate::shown::Shown| shown.source.url(std::path::Path::new("")).is_some();
    let came = match viewer.shown.as_ref().is_some_and(is_site) {
        true => format!(" · {} bytes came", grouped(viewer.bytes() as u64)),
        false => String::new(),
    };
    // The device tells the number some frames later.
    let triangles = match last.triangles as u64 {
        0 => String::new(),
        count => format!("{} triangles · ", grouped(count)),
    };
    format!("{time}{triangles}{bound}{came}")
}

/// A whole number with commas between groups of three digits.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The picture of the scene.
fn picture(viewer: &mut Viewer, ui: &mut Ui) {
    let rect = ui.available_rect_before_wrap();
    let scale = ui.ctx().pixels_per_point();
    // Whole pixels, so that a pixel of the picture is one of the screen.
    let low = (rect.min.to_vec2() * scale).ceil();
    let size = ((rect.max.to_vec2() * scale).floor() - low).max(vec2(1.0, 1.0));
    let rect = Rect::from_min_size((low / scale).to_pos2(), size / scale);
    let size = [size.x as u32, size.y as u32];
    viewer.picture = Some(Picture { rect, size });
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "picture"));
    let wiper = wiper(viewer, ui, rect);
    move_camera(viewer, ui, &response, Picture { rect, size });
    paint_picture(viewer, ui, rect);
    if let Some(shown) = &mut viewer.shown {
        let painter = ui.painter_at(rect);
        let camera = shown.camera(size);
        let on = Projected { camera: &camera, rect };
        if viewer.settings.wires {
            let seen = shown.stage.seen().cloned();
            viewer.wires = paint_wires(&painter, on, &shown.stage.world, seen.as_ref());
        }
        if viewer.settings.bounds {
            overlay::paint_bounds(&painter, on, &shown.stage.world);
        }
        if let Some(chosen) = shown.chosen.as_ref().filter(|_| viewer.settings.bones) {
            chosen.paint(&painter, on);
        }
    }
    if let Some(at) = wiper {
        paint_wiper(viewer, ui, rect, at);
    }
    notice(viewer, ui, rect);
}

fn paint_picture(viewer: &Viewer, ui: &Ui, rect: Rect) {
    let painter = ui.painter_at(rect);
    if viewer.shown.is_none() {
        painter.rect_filled(rect, 0, ui.visuals().extreme_bg_color);
        let text =
            viewer.step().map_or("Drop a file here, or choose a scene in the panel.".to_owned(), |step| {
                format!("{step} …")
            });
        let font = egui::FontId::proportional(16.0);
        painter.text(rect.center(), Align2::CENTER_CENTER, text, font, ui.visuals().text_color());
        return;
    }
    let paint = |texture: egui::TextureId, from: f32, to: f32| {
        let part = Rect::from_x_y_ranges(
            rect.left() + from * rect.width()..=rect.left() + to * rect.width(),
            rect.y_range(),
        );
        let uv = Rect::from_min_max(egui::pos2(from, 0.0), egui::pos2(to, 1.0));
        painter.image(texture, part, uv, Color32::WHITE);
    };
    match (viewer.texture(false), viewer.texture(true).filter(|_| viewer.compares())) {
        (Some(now), Some(full)) => {
            paint(full, 0.0, viewer.wiper);
            paint(now, viewer.wiper, 1.0);
        }
        (Some(now), None) => paint(now, 0.0, 1.0),
        (None, _) => {}
    }
}

/// The handle between full detail and the present one. Returns where it is, in points.
fn wiper(viewer: &mut Viewer, ui: &mut Ui, rect: Rect) -> Option<f32> {
    if !viewer.compares() {
        return None;
    }
    let at = rect.left() + viewer.wiper * rect.width();
    let handle = Rect::from_center_size(egui::pos2(at, rect.center().y), vec2(14.0, rect.height()));
    let response = ui.interact(handle, ui.scope_id().with("wiper"), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(viewer.wiper), "wiper"));
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
    }
    if response.dragged() {
        viewer.wiper = (viewer.wiper + response.drag_delta().x / rect.width()).clamp(0.02, 0.98);
    }
    Some(rect.left() + viewer.wiper * rect.width())
}

fn paint_wiper(viewer: &Viewer, ui: &Ui, rect: Rect, at: f32) {
    let painter = ui.painter_at(rect);
    painter.vline(at, rect.y_range(), Stroke::new(3.0, Color32::from_black_alpha(120)));
    painter.vline(at, rect.y_range(), Stroke::new(1.5, Color32::WHITE));
    painter.circle(egui::pos2(at, rect.center().y), 7.0, ACCENT, Stroke::new(1.5, Color32::WHITE));
    let font = egui::FontId::proportional(13.0);
    let pixels = viewer.shown.as_ref().map_or(0.0, |shown| shown.quality.pixels);
    let right = format!("{pixels} px");
    for (align, x, text) in
        [(Align2::RIGHT_TOP, at - 10.0, "full detail"), (Align2::LEFT_TOP, at + 10.0, right.as_str())]
    {
        let galley = painter.layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE);
        let place = align.anchor_size(egui::pos2(x, rect.top() + 8.0), galley.size());
        painter.rect_filled(place.expand2(vec2(5.0, 3.0)), 3, Color32::from_black_alpha(150));
        painter.galley(place.min, galley, Color32::WHITE);
    }
}

/// A message over the picture, until it is closed.
fn notice(viewer: &mut Viewer, ui: &mut Ui, rect: Rect) {
    let Some(notice) = viewer.notice.clone() else { return };
    let width = (rect.width() - 24.0).min(520.0);
    let area = egui::Area::new(egui::Id::unique("notice")).fixed_pos(rect.left_top() + vec2(12.0, 12.0));
    let closed = area.show(ui.ctx(), |ui| {
        let frame = Frame::popup(ui.style()).stroke(Stroke::new(1.0, Color32::from_rgb(0xd6, 0x4f, 0x4f)));
        frame
            .corner_radius(CornerRadius::same(4))
            .show(ui, |ui| {
                ui.set_width(width);
                ui.label(&notice);
                ui.horizontal(|ui| {
                    let closed = ui.small_button("Close").clicked();
                    if ui.small_button("Copy").clicked() {
                        viewer.request(crate::viewer::Request::Copy(notice));
                    }
                    closed
                })
                .inner
            })
            .inner
    });
    if closed.inner {
        viewer.notice = None;
    }
}

/// What pointer and touch do to the camera, the sun, and the chosen character.
fn move_camera(viewer: &mut Viewer, ui: &Ui, response: &egui::Response, picture: Picture) {
    let drag = viewer.settings.drag;
    let Some(shown) = &mut viewer.shown else { return };
    let Picture { rect, size } = picture;
    let height = f64::from(rect.height());
    let (shift, scroll, zoom, touch) = ui.input(|input| {
        (input.modifiers.shift, input.smooth_scroll_delta().y, input.zoom_delta(), input.multi_touch())
    });
    let delta = response.drag_delta();
    let part = [f64::from(delta.x) / height, f64::from(delta.y) / height];
    let tangent = shown.tangent();
    if let Some(touch) = touch {
        if response.dragged() {
            shown.take_camera();
            let way = touch.translation_delta;
            shown.eye.pan([f64::from(way.x) / height, f64::from(way.y) / height], tangent);
            shown.eye.zoom(1.0 / f64::from(touch.zoom_delta));
        }
    } else if delta != egui::Vec2::ZERO {
        let is_main = response.dragged_by(PointerButton::Primary);
        match drag {
            Drag::Sun if is_main => shown.turn_sun([2.0 * part[0] as f32, -2.0 * part[1] as f32]),
            _ if !is_main || shift => {
                shown.take_camera();
                shown.eye.pan(part, tangent);
            }
            Drag::Fly => {
                shown.take_camera();
                shown.eye.look(part);
            }
            _ => {
                shown.take_camera();
                shown.eye.orbit(part);
            }
        }
    }
    if response.hovered() && (scroll != 0.0 || zoom != 1.0) && touch.is_none() {
        shown.take_camera();
        let factor = (-0.0025 * f64::from(scroll)).exp() / f64::from(zoom);
        match drag {
            // The scroll wheel of somebody who flies goes ahead.
            Drag::Fly => shown.eye.fly([0.0, 0.0, (1.0 - factor) * shown.eye.distance]),
            _ => shown.eye.zoom(factor),
        }
    }
    let pixel = response.interact_pointer_pos().map(|at| {
        let part = (at - rect.min) / rect.size();
        [part.x * size[0] as f32, part.y * size[1] as f32]
    });
    if let Some(pixel) = pixel {
        if response.double_clicked() {
            if let Some(hit) = shown.hit(size, pixel) {
                shown.focus(hit.world());
            }
        } else if response.clicked() && viewer.settings.bones {
            let hit = shown.hit(size, pixel);
            if let Err(error) = shown.choose(hit) {
                viewer.notice = Some(error.to_string());
            }
        }
    }
}

/// Says that files can be dropped, while some are held over the viewer.
fn hovered_files(ui: &Ui) {
    if ui.input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let rect = ui.ctx().content_rect();
    let painter =
        ui.ctx().layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop")));
    painter.rect_filled(rect, 0, Color32::from_black_alpha(160));
    painter.rect_stroke(rect.shrink(12.0), 6, Stroke::new(2.0, ACCENT), egui::StrokeKind::Inside);
    let font = egui::FontId::proportional(20.0);
    painter.text(rect.center(), Align2::CENTER_CENTER, "Drop to open", font, Color32::WHITE);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped() {
        let all = [0, 999, 1000, 65_536, 1_234_567].map(grouped);
        assert_eq!(all, ["0", "999", "1,000", "65,536", "1,234,567"]);
    }
}
