//! The sections of controls: detail, bones, what is shown, light, and time.

use egui::{Slider, SliderClamping, Ui};
use relievo::ops::animation::priority::TERMS;
use relievo::scene::Transition;
use relievo::shared::render::output_levels::LEVEL_COLORS;
use relievo_scene_file::WorldKind;

use super::{grouped, list, section};
use crate::controls::{Drag, GateBy, LevelsBy};
use crate::shown::Shown;
use crate::stage::Colors;
use crate::viewer::Viewer;

pub fn show(viewer: &mut Viewer, ui: &mut Ui) {
    if viewer.shown.is_none() {
        return;
    }
    section(ui, "Detail", true, |ui| detail(viewer, ui));
    let has_characters = viewer.shown.as_ref().is_some_and(|shown| {
        shown.stage.world.objects.iter().any(|object| object.kind == WorldKind::Character)
    });
    if has_characters {
        section(ui, "Bones", false, |ui| bones(viewer, ui));
    }
    section(ui, "Time and camera", true, |ui| time(viewer, ui));
    section(ui, "Light", false, |ui| light(viewer, ui));
}

fn detail(viewer: &mut Viewer, ui: &mut Ui) {
    let Viewer { shown: Some(shown), compares, settings, wires, .. } = viewer else { return };
    let quality = &mut shown.quality;
    let pixels = Slider::new(&mut quality.pixels, 0.0..=64.0).logarithmic(true).smallest_positive(0.05);
    ui.add(decimals(pixels, 2).text("pixels off"))
        .on_hover_text("By how many pixels anything may be off; 0 is full detail");
    limit(ui, "triangles", &mut quality.has_triangles, |ui| {
        ui.add(
            Slider::new(&mut quality.triangles, 100..=5_000_000)
                .logarithmic(true)
                .clamping(SliderClamping::Edits),
        )
    });
    limit(ui, "milliseconds", &mut quality.has_milliseconds, |ui| {
        ui.add(decimals(Slider::new(&mut quality.milliseconds, 1.0..=200.0).logarithmic(true), 1))
    });
    ui.checkbox(compares, "full detail beside it")
        .on_hover_text("Full detail to the left of a line that can be dragged (C)");
    ui.horizontal(|ui| {
        ui.label("colours");
        ui.selectable_value(&mut settings.colors, Colors::Shaded, "shaded");
        ui.selectable_value(&mut settings.colors, Colors::Levels, "levels")
            .on_hover_text("The level of detail of each instance, and of each part of endless terrain (L)");
    });
    if settings.colors == Colors::Levels {
        legend(ui);
    }
    ui.checkbox(&mut settings.bounds, "bounding boxes");
    ui.checkbox(&mut settings.wires, "edges of triangles")
        .on_hover_text("The edges of what is drawn, as far as they face the camera (M)");
    if settings.wires {
        for why in &wires.left_out {
            ui.label(egui::RichText::new(format!("no edges: {why}")).small());
        }
    }
    levels(shown, ui);
    costs(shown, ui);
}

/// The colours of levels with their numbers.
fn legend(ui: &mut Ui) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.label("finest ");
        for (level, [red, green, blue]) in LEVEL_COLORS.into_iter().enumerate() {
            let fill = egui::Color32::from(egui::Rgba::from_rgb(red, green, blue));
            let text = egui::RichText::new(level.to_string()).color(egui::Color32::WHITE);
            egui::Frame::NONE
                .fill(fill)
                .inner_margin(egui::Margin::symmetric(5, 1))
                .show(ui, |ui| ui.label(text));
        }
        ui.label(" coarsest");
    });
}

/// A limit that can be off.
fn limit(ui: &mut Ui, name: &str, is_on: &mut bool, slider: impl FnOnce(&mut Ui) -> egui::Response) {
    ui.horizontal(|ui| {
        ui.checkbox(is_on, name);
        ui.add_enabled_ui(*is_on, |ui| {
            let response = slider(ui);
            let name = format!("largest number of {name}");
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, *is_on, &name));
        });
    });
}

/// How levels of detail are chosen and change.
fn levels(shown: &mut Shown, ui: &mut Ui) {
    let levels = &mut shown.levels;
    choice(ui, "levels by", &LevelsBy::ALL, &mut levels.by);
    match levels.by {
        LevelsBy::Distance | LevelsBy::Ratio => {
            let [near, far] = &mut levels.distances;
            ui.add(wide(near).text("from"));
            ui.add(wide(far).text("to"));
            *far = far.max(1.01 * *near);
        }
        LevelsBy::Size => {
            let [first, last] = &mut levels.sizes;
            let part = |value| decimals(Slider::new(value, 1e-5..=1.0).logarithmic(true), 5);
            ui.add(part(first).text("below"));
            ui.add(part(last).text("coarsest below"));
            *last = last.min(0.99 * *first);
        }
        LevelsBy::Magnification => {
            let [first, last] = &mut levels.magnifications;
            ui.add(wide(first).text("below"));
            ui.add(wide(last).text("coarsest below"));
            *last = last.min(0.99 * *first);
        }
        LevelsBy::Forced => {
            ui.add(Slider::new(&mut levels.level, 0..=7).text("level"));
        }
        LevelsBy::Scene | LevelsBy::Error => {}
    }
    let name = levels.transition.map_or("as the scene says", |at| Transition::NAMES[at].0);
    list(ui, "transition", name, |ui| {
        ui.selectable_value(&mut levels.transition, None, "as the scene says");
        for (at, (name, _)) in Transition::NAMES.iter().enumerate() {
            ui.selectable_value(&mut levels.transition, Some(at), *name);
        }
    });
    ui.add(decimals(Slider::new(&mut levels.bias, 0.1..=10.0).logarithmic(true), 2).text("bias"))
        .on_hover_text("Factor of the metric by which levels are chosen; above 1, everything is coarser");
    ui.add(decimals(Slider::new(&mut levels.hysteresis, 0.0..=0.5), 2).text("hysteresis"));
}

/// What the view draws of each object, level by level.
fn costs(shown: &mut Shown, ui: &mut Ui) {
    let names: Vec<String> = shown.stage.world.objects.iter().map(|object| object.name.clone()).collect();
    let Some(seen) = shown.stage.seen() else { return };
    if let Some(budget) = seen.budget {
        let missed = if budget.is_missed { "; the limit is missed" } else { "" };
        ui.label(format!("the limit coarsens by a factor of {:.2}{missed}", budget.factor));
    }
    egui::Grid::new("costs").num_columns(3).striped(true).show(ui, |ui| {
        for title in ["object: level", "instances", "triangles"] {
            ui.label(egui::RichText::new(title).small()).on_hover_text(LEVELS);
        }
        ui.end_row();
        for (object, name) in seen.objects.iter().zip(&names) {
            let drawn = object.levels.iter().enumerate().filter(|(_, level)| level.instances > 0);
            for (level, of) in drawn {
                let short: String =
                    name.chars().rev().take(16).collect::<Vec<_>>().into_iter().rev().collect();
                ui.label(format!("{short}: {level}"));
                ui.label(of.instances.to_string());
                ui.label(grouped(of.triangles));
                ui.end_row();
            }
        }
    });
}

/// The hint of the table: it explains the numbers of levels.
const LEVELS: &str = "Level 0 is the finest that is there; a finer one that arrives becomes level 0. At most 8 of a package's levels are used.";

/// A choice of one of several values.
fn choice<T: Copy + PartialEq>(ui: &mut Ui, label: &str, all: &[(T, &str)], value: &mut T) {
    let name = all.iter().find(|(other, _)| other == value).map_or("", |(_, name)| name);
    list(ui, label, name, |ui| {
        for (other, name) in all {
            ui.selectable_value(value, *other, *name);
        }
    });
}

/// A slider over a wide range.
fn wide(value: &mut f32) -> Slider<'_> {
    decimals(Slider::new(value, 0.01..=1e5).logarithmic(true), 2)
}

/// A slider that shows so many decimals. A value that it shows stays as it is, while egui's own `max_decimals` rounds it.
fn decimals(slider: Slider<'_>, count: usize) -> Slider<'_> {
    slider.clamping(SliderClamping::Edits).custom_formatter(move |value, _| {
        let text = format!("{value:.count$}");
        // No sign before zeros.
        match text.strip_prefix('-').filter(|digits| digits.chars().all(|digit| "0.".contains(digit))) {
            Some(digits) => digits.to_owned(),
            None => text,
        }
    })
}

fn bones(viewer: &mut Viewer, ui: &mut Ui) {
    let Viewer { shown: Some(shown), settings, .. } = viewer else { return };
    let bones = &mut shown.bones;
    choice(ui, "gate", &GateBy::ALL, &mut bones.gate);
    let distance = |value| decimals(Slider::new(value, 0.1..=1e5).logarithmic(true), 1);
    match bones.gate {
        GateBy::Uniform | GateBy::SkipPeriod => {
            let [near, far] = &mut bones.range;
            ui.add(distance(near).text("all bones up to"));
            ui.add(distance(far).text("none beyond"));
            *far = far.max(1.01 * *near);
        }
        GateBy::Budget => {
            let bones = Slider::new(&mut bones.bones, 1..=100_000).logarithmic(true);
            ui.add(bones.clamping(SliderClamping::Edits).text("bones a frame"));
        }
        GateBy::Scene | GateBy::Bounded | GateBy::Off => {}
    }
    if bones.gate == GateBy::SkipPeriod {
        let period = Slider::new(&mut bones.period, 0.02..=10.0).logarithmic(true);
        ui.add(decimals(period, 2).text("period in seconds"));
        ui.checkbox(&mut bones.analyzed, "weights from each clip");
        ui.add_enabled_ui(!bones.analyzed, |ui| {
            for (weight, term) in bones.weights.iter_mut().zip(TERMS) {
                ui.add(decimals(Slider::new(weight, 0.0..=1.0), 2).text(term));
            }
        });
    }
    ui.checkbox(&mut settings.bones, "show the bones of a character").on_hover_text(
        "Bright bones were sampled in the last frame. Click on another character to choose it (B)",
    );
    if let Some(chosen) = shown.chosen.as_ref().filter(|_| settings.bones) {
        let [all, active] = chosen.counts();
        ui.label(format!("{active} of {all} bones sampled in the last frame"));
        if let Some(pixels) = chosen.displacement() {
            ui.label(format!("largest displacement {pixels:.3} px"));
        }
    }
    if let Some(all) = shown.stage.world.scene.statistics() {
        let bones: u32 = all.characters.iter().map(|character| character.bones).sum();
        ui.label(format!("bones interpolated in all: {}", grouped(bones.into())));
    }
}

fn time(viewer: &mut Viewer, ui: &mut Ui) {
    let Viewer { shown: Some(shown), settings, steps, bookmarks, .. } = viewer else { return };
    ui.horizontal(|ui| {
        let label = if shown.clock.plays { "Pause" } else { "Play" };
        if ui.button(label).on_hover_text("Space").clicked() {
            shown.clock.plays = !shown.clock.plays;
        }
        if ui.button("Step").on_hover_text("A sixtieth of a second (.)").clicked() {
            (shown.clock.plays, *steps) = (false, true);
        }
        ui.label(format!("{:.2} s", shown.time()));
    });
    ui.add(decimals(Slider::new(&mut shown.clock.speed, 0.05..=4.0).logarithmic(true), 2).text("speed"));
    let end = shown.path_end();
    if end > 0.0 {
        ui.checkbox(&mut shown.clock.follows, "follow the scene's camera");
        let mut time = shown.time().min(end);
        if ui.add(Slider::new(&mut time, 0.0..=end).text("seconds of the path")).changed() {
            let way = time - shown.time();
            // The slider's numbers are finite.
            let _ = shown.advance(way as f32);
        }
    }
    ui.horizontal(|ui| {
        ui.label("drag");
        for (drag, name) in [(Drag::Orbit, "orbit"), (Drag::Fly, "fly"), (Drag::Sun, "sun")] {
            ui.selectable_value(&mut settings.drag, drag, name);
        }
        if ui.button("Home").on_hover_text("H").clicked() {
            shown.go_home();
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("bookmarks");
        for (at, place) in bookmarks.iter_mut().enumerate() {
            let label = (at + 1).to_string();
            let hint = match place {
                Some(_) => "Click: go there. Click with Shift: put it here",
                None => "Click: put it here",
            };
            if ui.selectable_label(place.is_some(), label).on_hover_text(hint).clicked() {
                let is_shift = ui.input(|input| input.modifiers.shift);
                shown.take_camera();
                match place {
                    Some(place) if !is_shift => shown.eye = *place,
                    place => *place = Some(shown.eye),
                }
            }
        }
    });
}

fn light(viewer: &mut Viewer, ui: &mut Ui) {
    let Viewer { shown: Some(shown), .. } = viewer else { return };
    let direction = shown.light.direction.normalize_or(glam::Vec3::Y);
    let (mut around, mut above) =
        (direction.x.atan2(direction.z).to_degrees(), direction.y.asin().to_degrees());
    let turned =
        ui.add(decimals(Slider::new(&mut around, -180.0..=180.0).suffix("°"), 0).text("sun, direction"));
    let raised = ui.add(decimals(Slider::new(&mut above, 1.0..=89.0).suffix("°"), 0).text("sun, height"));
    if turned.changed() || raised.changed() {
        let (yaw, pitch) = (around.to_radians(), above.to_radians());
        shown.light.direction =
            glam::Vec3::new(yaw.sin() * pitch.cos(), pitch.sin(), yaw.cos() * pitch.cos());
    }
    ui.add(decimals(Slider::new(&mut shown.light.ambient, 0.0..=1.0), 2).text("ambient"));
    ui.add(decimals(Slider::new(&mut shown.exposure, -4.0..=4.0), 1).suffix(" EV").text("exposure"));
}
