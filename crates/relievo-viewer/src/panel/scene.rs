//! The section of the scene: opening, saving, and what arrived.

use egui::Ui;

use super::{EXAMPLES, grouped, list, section};
use crate::settings::Theme;
use crate::shown::Shown;
use crate::viewer::{Request, Viewer};

/// Bits a second at which files may arrive, with their names.
const THROTTLES: [(Option<f64>, &str); 3] =
    [(None, "no limit"), (Some(2e6), "2 Mbit/s"), (Some(15.91e6), "15.91 Mbit/s")];

/// Number of transfers that are listed.
const TRANSFERS: usize = 12;

pub fn show(viewer: &mut Viewer, ui: &mut Ui) {
    section(ui, "Scene", true, |ui| {
        open(viewer, ui);
        save(viewer, ui);
        ui.horizontal(|ui| {
            ui.label("Theme");
            for (theme, name) in Theme::ALL {
                if ui.selectable_value(&mut viewer.settings.theme, theme, name).clicked() {
                    ui.ctx().set_theme(theme.preference());
                }
            }
        });
        // Below what can be pressed, since its length changes with the scene.
        summary(viewer, ui);
    });
    section(ui, "Network", false, |ui| network(viewer, ui));
}

/// The name of the scene, and what is in it.
fn summary(viewer: &Viewer, ui: &mut Ui) {
    let Some(shown) = &viewer.shown else { return };
    ui.label(egui::RichText::new(&shown.name).strong());
    let world = &shown.stage.world;
    let objects = world.objects.iter().map(|object| {
        let count = world.scene.instances(object.object).map_or(0, |all| all.len());
        let kind = format!("{:?}", object.kind).to_lowercase();
        let name = match object.model {
            Some(_) => object.name.clone(),
            None => format!("\"{}\"", object.name),
        };
        match world.scene.terrain_statistics(object.object) {
            Ok(land) => format!("endless terrain {name}: {} nodes", land.nodes),
            Err(_) => format!("{kind} {name} × {count}"),
        }
    });
    for line in objects {
        ui.add(egui::Label::new(egui::RichText::new(line).small()).truncate());
    }
}

fn open(viewer: &mut Viewer, ui: &mut Ui) {
    let mut wanted = None;
    ui.horizontal(|ui| {
        let field = egui::TextEdit::singleline(&mut viewer.address).hint_text("file or address");
        let response = ui.add(field.desired_width((ui.available_width() - 60.0).max(60.0)));
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if (ui.button("Open").clicked() || entered) && !viewer.address.trim().is_empty() {
            wanted = Some(viewer.address.trim().to_owned());
        }
        if entered {
            // Keys are letters of the address until somebody clicks elsewhere.
            response.request_focus();
        }
    });
    egui::ComboBox::from_id_salt("examples")
        .selected_text("Examples and recent files")
        .width(ui.available_width())
        .show_ui(ui, |ui| {
            for (at, (_, _, title)) in EXAMPLES.iter().enumerate() {
                if ui.selectable_label(false, *title).clicked() {
                    viewer.open_example(at);
                }
            }
            #[cfg(target_arch = "wasm32")]
            for (name, address) in crate::web::offered(ui.ctx()) {
                if ui.selectable_label(false, format!("{name}, from this server")).clicked() {
                    wanted = Some(address);
                }
            }
            let is_example = |name: &String| EXAMPLES.iter().any(|(example, ..)| example == name);
            for name in viewer.settings.recent.iter().filter(|name| !is_example(name)) {
                if ui.selectable_label(false, name).clicked() {
                    wanted = Some(name.clone());
                }
            }
        });
    if let Some(name) = wanted {
        viewer.open_address(&name);
    }
    ui.small("Files dropped onto the window open too.");
}

fn save(viewer: &mut Viewer, ui: &mut Ui) {
    ui.add_enabled_ui(viewer.shown.is_some(), |ui| {
        ui.horizontal_wrapped(|ui| {
            if ui.button("Save picture").clicked() {
                viewer.save_picture();
            }
            if ui.button("Save scene").on_hover_text("The scene file as it now is").clicked() {
                viewer.save_scene();
            }
            let hint = "The command that draws this picture, and the address of the page that shows it";
            if ui.button("Copy command").on_hover_text(hint).clicked()
                && let Some(command) = viewer.command()
            {
                viewer.request(Request::Copy(command));
            }
        });
    });
}

/// What arrived, and what is waited for.
fn network(viewer: &mut Viewer, ui: &mut Ui) {
    let throttle = &mut viewer.settings.throttle;
    let named = THROTTLES.iter().find(|(rate, _)| rate == throttle).map_or("other", |(_, name)| name);
    list(ui, "throttle", named, |ui| {
        for (rate, name) in THROTTLES {
            ui.selectable_value(throttle, rate, name);
        }
    });
    if let Some((bytes, seconds)) = viewer.first_picture {
        ui.label(format!("first picture after {} bytes, {seconds:.2} s", grouped(bytes as u64)));
    }
    let total = viewer.bytes();
    ui.label(format!("{} bytes in {} transfers", grouped(total as u64), viewer.arrivals.len()));
    if let Some(shown) = &viewer.shown {
        site(shown, ui);
    }
    egui::Grid::new("arrivals").num_columns(3).striped(true).show(ui, |ui| {
        for title in ["the last transfers", "bytes", "time"] {
            ui.label(egui::RichText::new(title).small());
        }
        ui.end_row();
        for arrival in viewer.arrivals.iter().rev().take(TRANSFERS) {
            ui.add(egui::Label::new(short(&arrival.name)));
            ui.label(grouped(arrival.bytes as u64));
            ui.label(format!("{:.0} ms", 1e3 * arrival.seconds));
            ui.end_row();
        }
    });
}

/// What is there of the packages of a site, and what it is asked for.
fn site(shown: &Shown, ui: &mut Ui) {
    let Some(streaming) = &shown.streaming else { return };
    if let Some((why, seconds)) = streaming.waits() {
        ui.colored_label(ui.visuals().warn_fg_color, format!("waiting {seconds:.0} s: {why}"));
    }
    let traffic = streaming.traffic();
    ui.label(format!("cached: {} bytes", grouped(traffic.kept)));
    egui::Grid::new("packages").num_columns(3).striped(true).show(ui, |ui| {
        for title in ["package", "levels", "images"] {
            ui.label(egui::RichText::new(title).small());
        }
        ui.end_row();
        for package in streaming.packages() {
            ui.add(egui::Label::new(short(&package.name)));
            for [here, all] in [package.levels, package.images] {
                ui.label(format!("{here} of {all}"));
            }
            ui.end_row();
        }
    });
    for asked in streaming.asked() {
        let name = short(&asked.name);
        let of = match &asked.range {
            Some(range) if range.end < u64::MAX => format!(" of {}", grouped(range.end - range.start)),
            _ => String::new(),
        };
        ui.label(format!("asked for: {name}, {}{of} bytes", grouped(asked.bytes as u64)));
    }
    if shown.is_streaming() {
        ui.spinner();
    } else {
        ui.label("nothing is missing that this picture needs");
    }
}

/// The end of a long name.
fn short(name: &str) -> String {
    let count = name.chars().count();
    if count <= 24 {
        name.to_owned()
    } else {
        format!("…{}", name.chars().skip(count - 23).collect::<String>())
    }
}
