//! What keys do, and the list of them.

use egui::{Context, Key};

use crate::stage::Colors;
use crate::viewer::Viewer;

/// Keys and what they do.
const KEYS: [(&str, &str); 18] = [
    ("drag", "orbit, fly or turn the sun, as the panel says"),
    ("right drag, Shift + drag", "move sideways"),
    ("scroll, pinch", "come nearer, go farther"),
    ("double click", "look at that point"),
    ("W A S D Q E", "fly; with Shift faster"),
    ("arrows", "orbit"),
    ("+ −", "come nearer, go farther"),
    ("Space", "play, pause"),
    (".", "step by a sixtieth of a second"),
    ("H", "camera where it was at first"),
    ("1 to 9", "go to a bookmark; with Shift, put it here"),
    ("[ ]", "finer, coarser"),
    ("C", "full detail beside it"),
    ("L", "colours: shaded, levels"),
    ("M", "edges of triangles"),
    ("B", "bones of a character"),
    ("P", "panel"),
    ("Tab", "next control of the panel"),
];

/// Seconds that keys which are held count for, where the frame took longer.
const LONGEST: f32 = 0.1;

/// Does what the keys say that were pressed, unless somebody writes text.
pub fn take(viewer: &mut Viewer, egui: &Context) {
    if egui.egui_wants_keyboard_input() || egui.memory(|memory| memory.focused().is_some()) {
        return;
    }
    let pressed = |key: Key| egui.input(|input| input.key_pressed(key));
    let toggle = |key: Key, value: &mut bool| *value ^= pressed(key);
    toggle(Key::P, &mut viewer.settings.panel);
    toggle(Key::C, &mut viewer.compares);
    toggle(Key::M, &mut viewer.settings.wires);
    toggle(Key::B, &mut viewer.settings.bones);
    let is_asked =
        egui.input(|input| input.events.iter().any(|event| *event == egui::Event::Text("?".to_owned())));
    viewer.shows_keys ^= is_asked;
    if pressed(Key::Escape) {
        (viewer.shows_keys, viewer.notice) = (false, None);
    }
    if pressed(Key::L) {
        viewer.settings.colors = match viewer.settings.colors {
            Colors::Shaded => Colors::Levels,
            Colors::Levels => Colors::Shaded,
        };
    }
    let Some(shown) = &mut viewer.shown else { return };
    toggle(Key::Space, &mut shown.clock.plays);
    if pressed(Key::Period) {
        (shown.clock.plays, viewer.steps) = (false, true);
    }
    if pressed(Key::H) {
        shown.go_home();
    }
    let pixels = &mut shown.quality.pixels;
    if pressed(Key::OpenBracket) {
        *pixels = if *pixels < 0.08 { 0.0 } else { *pixels / 1.5 };
    }
    if pressed(Key::CloseBracket) {
        *pixels = if *pixels < 0.05 { 0.05 } else { (*pixels * 1.5).min(64.0) };
    }
    let digits =
        [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];
    for (place, key) in viewer.bookmarks.iter_mut().zip(digits) {
        // With Shift, a layout may have another letter on the key.
        let is_put = egui.input(|input| {
            input.events.iter().any(|event| {
                matches!(event, egui::Event::Key { physical_key, pressed: true, modifiers, .. }
                    if *physical_key == Some(key) && modifiers.shift)
            })
        });
        if is_put || (pressed(key) && egui.input(|input| input.modifiers.shift)) {
            shown.take_camera();
            *place = Some(shown.eye);
        } else if pressed(key)
            && let Some(place) = place
        {
            shown.take_camera();
            shown.eye = *place;
        }
    }
    held(shown, egui);
}

/// Moves the camera by keys that are held.
fn held(shown: &mut crate::shown::Shown, egui: &Context) {
    let (seconds, is_fast) = egui.input(|input| (input.stable_dt.min(LONGEST), input.modifiers.shift));
    let along = |to: Key, from: Key| {
        let down = |key| if egui.input(|input| input.key_down(key)) { 1.0 } else { 0.0 };
        down(to) - down(from)
    };
    let way = [along(Key::D, Key::A), along(Key::E, Key::Q), along(Key::W, Key::S)];
    let turn = [along(Key::ArrowLeft, Key::ArrowRight), along(Key::ArrowUp, Key::ArrowDown)];
    let zoom = along(Key::Minus, Key::Plus) + along(Key::Minus, Key::Equals);
    if way.iter().chain(&turn).all(|part| *part == 0.0) && zoom == 0.0 {
        return;
    }
    shown.take_camera();
    let step = f64::from(seconds) * if is_fast { 4.0 } else { 1.0 };
    let speed = 0.35 * shown.extent.max(shown.eye.distance * 0.1);
    shown.eye.fly(way.map(|part| part * step * speed));
    shown.eye.orbit(turn.map(|part| part * step * 0.5));
    shown.eye.zoom(2.0_f64.powf(zoom * step));
    egui.request_repaint();
}

/// The list of keys.
pub fn list(viewer: &mut Viewer, egui: &Context) {
    if !viewer.shows_keys {
        return;
    }
    egui::Window::new("Keys")
        .open(&mut viewer.shows_keys)
        .collapsible(false)
        .resizable(false)
        .default_size([520.0, 560.0])
        .anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0])
        .show(egui, |ui| {
            egui::ScrollArea::both().show(ui, |ui| {
                egui::Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
                    for (keys, what) in KEYS {
                        ui.label(egui::RichText::new(keys).strong());
                        ui.label(what);
                        ui.end_row();
                    }
                });
            });
        });
}
