//! Pictures of every section of the panel, light and dark, wide and narrow, in `target/viewer/panels`: for somebody to look at.
//!
//! `make looks` runs this. Each sheet has one theme and one width.

use std::sync::Arc;
use std::time::Duration;

use egui::Key;
use image::RgbaImage;
use image::imageops::overlay;
use relievo_viewer::{Memory, Settings, Theme};

use crate::driver::{Driver, creature, gpu, settings};

/// The example with a crowd, whose characters come from a package.
const CROWD: &str = include_str!("../../src/examples/crowd.json");

const SECTIONS: [&str; 8] =
    ["Scene", "Network", "Detail", "Bones", "Time and camera", "Light", "Plots", "Experiment"];

/// Sections that are open at first.
const OPEN: [&str; 3] = ["Scene", "Detail", "Time and camera"];

/// Sizes of the window: wide and narrow, high enough for the longest section.
const SIZES: [(&str, [u32; 2]); 2] = [("wide", [1100, 760]), ("narrow", [420, 760])];

fn crowd(theme: Theme, size: [u32; 2]) -> Driver {
    let mut driver = Driver::with(gpu(), size, 1.0, Settings { theme, ..settings() });
    let scene = CROWD.as_bytes();
    let files = Memory::default().with("crowd.json", scene).with("creature.rlv", creature());
    driver.viewer.open("crowd.json", Arc::new(files));
    driver.settle();
    assert_eq!(driver.viewer.notice(), None);
    driver
}

/// Puts pictures beside each other.
fn sheet(pictures: &[RgbaImage], columns: u32) -> RgbaImage {
    let (width, height) = pictures[0].dimensions();
    let rows = (pictures.len() as u32).div_ceil(columns);
    let mut sheet = RgbaImage::new(columns * width, rows * height);
    for (at, picture) in pictures.iter().enumerate() {
        let [x, y] = [at as u32 % columns * width, at as u32 / columns * height];
        overlay(&mut sheet, picture, i64::from(x), i64::from(y));
    }
    sheet
}

#[test]
#[ignore = "makes pictures to look at: `make looks`"]
fn every_section_light_and_dark_wide_and_narrow() {
    let folder = relievo_testing::root().join("target/viewer/panels");
    std::fs::create_dir_all(&folder).expect("writable");
    for theme in [Theme::Dark, Theme::Light] {
        for (width, size) in SIZES {
            let mut driver = crowd(theme, size);
            driver.frames(30);
            let mut pictures = Vec::new();
            // As it is at first.
            pictures.push(driver.window());
            for section in OPEN {
                driver.click(section);
            }
            for section in SECTIONS {
                driver.click(section);
                if section == "Bones" {
                    driver.choose("gate", "skip-period");
                    driver.settle();
                    driver.click("show the bones of a character");
                    driver.frames(20);
                }
                if section == "Experiment" && width == "wide" && theme == Theme::Light {
                    driver.experiment("Run", Duration::from_secs(600));
                }
                driver.frames(30);
                pictures.push(driver.window());
                if section == "Bones" {
                    driver.click("show the bones of a character");
                    driver.choose("gate", "as the scene says");
                    driver.settle();
                }
                driver.click(section);
            }
            driver.event(egui::Event::Text("?".to_owned()));
            driver.frames(6);
            pictures.push(driver.window());
            driver.key(Key::Escape);
            driver.click("Detail");
            driver.slide("pixels off", 0.95);
            driver.key(Key::M);
            driver.key(Key::C);
            driver.settle();
            pictures.push(driver.window());
            driver.key(Key::M);
            driver.key(Key::C);
            driver.key(Key::L);
            driver.viewer.open_address("no/such/file.glb");
            driver.settle();
            pictures.push(driver.window());
            let name = format!("{}-{width}.png", if theme == Theme::Dark { "dark" } else { "light" });
            sheet(&pictures, if width == "wide" { 3 } else { 6 }).save(folder.join(name)).expect("writable");
        }
    }
}

/// The experiment of thesis A with all its distances, as the button draws it.
#[test]
#[ignore = "takes minutes: `make looks`"]
fn the_whole_experiment_as_the_button_draws_it() {
    let mut driver = Driver::with(gpu(), [1000, 2100], 1.0, Settings { theme: Theme::Light, ..settings() });
    driver.viewer.open(
        "stone.json",
        Arc::new(
            Memory::default()
                .with("stone.json", crate::inputs::SCENE.replace(r#", "path": null"#, "").into_bytes()),
        ),
    );
    driver.settle();
    for section in OPEN {
        driver.click(section);
    }
    driver.click("Experiment");
    let edge = driver.rect("picture").right() + 2.0;
    let middle = driver.rect("picture").center().y;
    driver.drag(egui::pos2(edge, middle), egui::pos2(edge - 400.0, middle), egui::PointerButton::Primary);
    driver.experiment("Run all distances", Duration::from_secs(1800));
    driver.save("experiment-whole");
    driver.click("Save report");
    for request in &driver.requests {
        if let relievo_viewer::Request::Save { name, bytes } = request {
            std::fs::write(relievo_testing::root().join("target/viewer").join(name), bytes)
                .expect("writable");
        }
    }
}

/// The picture of README.md: a creature 8 pixels off with the edges of its triangles, beside full detail.
#[test]
#[ignore = "makes a picture to look at: `make looks`"]
fn the_picture_of_the_readme() {
    let mut driver = Driver::new([900, 560]);
    let scene = r#"{
        "characters": [{ "file": "creature.rlv", "clip": "walk", "instances": [{ "at": [0, 0, 0], "turn": 0.3 }] }],
        "light": { "direction": [0.45, 0.8, 0.65], "color": [1.2, 1.17, 1.1], "ambient": 0.3 },
        "camera": { "at": [0, 1.45, 2.1], "look": [0, 1.15, 0], "near": 0.01 }, "background": [0.2, 0.22, 0.25]
    }"#;
    let files = Memory::default().with("creature.json", scene.as_bytes()).with("creature.rlv", creature());
    driver.viewer.open("creature.json", Arc::new(files));
    driver.settle();
    driver.click("Pause");
    driver.slide("pixels off", 0.68);
    driver.key(Key::M);
    driver.key(Key::C);
    driver.settle();
    driver.frames(10);
    let picture = image::DynamicImage::ImageRgba8(driver.window()).into_rgb8();
    let path = relievo_testing::root().join("target/viewer/readme.jpg");
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
    picture.save(path).expect("writable");
}
