//! The controls of the panel that `controls` leaves out: addresses, examples, buttons of the status line, thresholds, gates, edges,
//! and the experiment of thesis A.

use std::sync::Arc;
use std::time::Duration;

use egui::{Event, Key, PointerButton, TouchPhase, vec2};
use relievo_viewer::{Drag, Memory, Request, Theme};

use crate::controls::crowd;
use crate::driver::{Driver, creature, different};
use crate::inputs::SCENE;

/// A viewer with two rocks.
fn rocks(size: [u32; 2]) -> Driver {
    let mut driver = Driver::new(size);
    let scene = SCENE.replace(r#", "path": null"#, "");
    driver.viewer.open("rocks.json", Arc::new(Memory::default().with("rocks.json", scene.into_bytes())));
    driver.settle();
    driver
}

#[test]
fn addresses_are_written_and_examples_are_chosen() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let rock = relievo_samples::rock().expect("built in").to_glb().expect("written");
    let path = folder.path().join("rock.glb");
    std::fs::write(&path, rock).expect("written");
    let mut driver = rocks([640, 700]);
    driver.click("text");
    driver.write(&path.display().to_string());
    driver.key(Key::Enter);
    driver.settle();
    assert_eq!((driver.viewer.notice(), driver.shown().name.as_str()), (None, "rock.glb"));
    // The same by the button, with another name.
    driver.click("text");
    driver.key(Key::End);
    driver.write(".gone");
    driver.click("Open");
    driver.settle();
    assert!(driver.viewer.notice().expect("told").contains("rock.glb.gone"));
    let notice = driver.viewer.notice().expect("told").to_owned();
    driver.click("Copy");
    assert!(driver.requests.contains(&Request::Copy(notice)));
    driver.click("Close");
    for (title, name) in [("A creature of 153 bones", "creature.json"), ("A crowd of 100", "crowd.json")] {
        driver.choose("Examples and recent files", title);
        driver.settle();
        // The examples' creature lies beside a page; natively the viewer has it built in.
        assert_eq!((driver.viewer.notice(), driver.shown().name.as_str()), (None, name));
        assert!(driver.triangles() > 100.0);
    }
    let recent = path.display().to_string();
    driver.choose("Examples and recent files", &recent);
    driver.settle();
    assert_eq!(driver.shown().name, "rock.glb");
}

#[test]
fn buttons_and_themes_of_the_panel_work() {
    let mut driver = rocks([640, 700]);
    driver.click("Keys");
    driver.frames(4);
    let keys = driver.window();
    driver.key(Key::Escape);
    driver.frames(4);
    assert!(different(&driver.window(), &keys) > 2000, "the list of keys was shown");
    driver.click("Hide panel");
    driver.frames(30);
    assert!(!driver.viewer.settings().panel);
    driver.click("Show panel");
    driver.frames(30);
    assert!(driver.viewer.settings().panel);
    for (name, theme) in [("light", Theme::Light), ("dark", Theme::Dark), ("system", Theme::System)] {
        driver.click(name);
        driver.frames(10);
        let window = driver.window();
        let brightness = window.get_pixel(window.width() - 4, window.height() - 40).0[0];
        assert_eq!((driver.viewer.settings().theme, brightness > 128), (theme, theme == Theme::Light));
    }
    driver.key(Key::B);
    assert!(driver.viewer.settings().bones);
    driver.key(Key::B);
    for (key, is_farther) in [(Key::Plus, false), (Key::Minus, true)] {
        let before = driver.shown().eye.distance;
        driver.hold(key, 10);
        let after = driver.shown().eye.distance;
        assert!(if is_farther { after > before } else { after < before }, "{key:?}: {before} {after}");
    }
    for key in [Key::A, Key::S, Key::D, Key::Q, Key::E, Key::ArrowUp, Key::ArrowDown, Key::ArrowRight] {
        let before = driver.shown().eye;
        driver.hold(key, 5);
        assert!(driver.shown().eye != before, "{key:?}");
    }
}

#[test]
fn fingers_move_and_pinch() {
    let mut driver = rocks([640, 500]);
    let middle = driver.rect("picture").center();
    let before = driver.shown().eye;
    let finger = |driver: &mut Driver, id: u64, phase: TouchPhase, at: egui::Pos2| {
        let device_id = egui::TouchDeviceId(1);
        driver.event(Event::Touch { device_id, id: egui::TouchId(id), phase, pos: at, force: None });
        if id == 1 {
            driver.event(Event::PointerMoved(at));
            if phase == TouchPhase::Start {
                let (button, modifiers) = (PointerButton::Primary, egui::Modifiers::NONE);
                driver.event(Event::PointerButton { pos: at, button, pressed: true, modifiers });
            }
        }
    };
    finger(&mut driver, 1, TouchPhase::Start, middle - vec2(20.0, 0.0));
    finger(&mut driver, 2, TouchPhase::Start, middle + vec2(20.0, 0.0));
    driver.frames(2);
    for step in 1..=8 {
        let way = vec2(20.0 + 8.0 * step as f32, 0.0);
        finger(&mut driver, 1, TouchPhase::Move, middle - way);
        finger(&mut driver, 2, TouchPhase::Move, middle + way);
        driver.frame();
    }
    let after = driver.shown().eye;
    assert!(after.distance < 0.8 * before.distance, "{} {}", before.distance, after.distance);
    assert!(!driver.shown().clock.follows && after.yaw == before.yaw);
}

#[test]
fn edges_are_those_of_the_level_that_is_drawn() {
    let mut driver = rocks([640, 900]);
    let plain = driver.picture();
    driver.click("edges of triangles");
    driver.frames(8);
    let drawn = driver.triangles();
    assert_eq!(driver.viewer.wires().triangles as f64, drawn, "{:?}", driver.viewer.wires());
    let lines = different(&driver.picture(), &plain);
    assert!(lines > 300, "{lines} pixels of edges");
    driver.save("edges");
    // A coarser level has fewer edges, still those that are drawn; or none, where the scene made the level.
    driver.choose("levels by", "one level");
    driver.slide("level", 0.6);
    driver.frames(20);
    let coarse = driver.triangles();
    assert!(coarse < drawn, "{coarse} of {drawn} at level {}", driver.shown().levels.level);
    let wires = driver.viewer.wires();
    let is_told = wires.triangles == 0 && wires.left_out.len() == 1;
    assert!(wires.triangles as f64 == coarse || is_told, "{wires:?} of {coarse}");
    driver.slide("level", 1.0);
    driver.frames(20);
    let coarsest = driver.triangles();
    let wires = driver.viewer.wires();
    let is_told = wires.triangles == 0 && wires.left_out.len() == 1;
    assert!(wires.triangles as f64 == coarsest || is_told, "{wires:?} of {coarsest}");
    driver.key(Key::M);
    assert!(!driver.viewer.settings().wires);

    // Objects of which several levels are in view are left out, and told.
    let mut driver = crowd();
    driver.click("edges of triangles");
    driver.frames(8);
    let wires = driver.viewer.wires().clone();
    let is_mixed = wires.left_out.iter().any(|why| why.contains("several levels"));
    assert!(is_mixed || wires.triangles as f64 == driver.triangles(), "{wires:?}");
    driver.choose("levels by", "one level");
    driver.slide("level", 0.5);
    driver.frames(30);
    let drawn = driver.triangles();
    let wires = driver.viewer.wires();
    let is_told = wires.triangles == 0 && wires.left_out.len() == 1;
    assert!(wires.triangles as f64 == drawn || is_told, "{wires:?} of {drawn}");
}

/// The lines of a character's edges lie on the character, whose bones the device has in another pose than at rest.
#[test]
fn edges_follow_a_character_that_walks() {
    let mut driver = Driver::new([900, 700]);
    let scene = r#"{
        "characters": [{ "file": "creature.rlv", "clip": "walk", "gate": "off", "instances": [{ "at": [0, 0, 0] }] }],
        "camera": { "at": [0, 1, 4], "look": [0, 0.7, 0] }, "background": [0, 0, 0]
    }"#;
    driver.viewer.open(
        "walk.json",
        Arc::new(Memory::default().with("walk.json", scene.as_bytes()).with("creature.rlv", creature())),
    );
    driver.settle();
    driver.frames(40);
    driver.click("Pause");
    driver.frames(8);
    let plain = driver.picture();
    driver.key(Key::M);
    driver.frames(8);
    let lined = driver.picture();
    driver.save("edges-walk");
    let background = *plain.get_pixel(2, 2);
    let is_near = |x: u32, y: u32| {
        let around = |at: u32, most: u32| at.saturating_sub(2)..(at + 3).min(most);
        around(y, plain.height())
            .any(|y| around(x, plain.width()).any(|x| *plain.get_pixel(x, y) != background))
    };
    let changed = plain.enumerate_pixels().filter(|(x, y, pixel)| lined.get_pixel(*x, *y) != *pixel);
    let changed: Vec<bool> = changed.map(|(x, y, _)| is_near(x, y)).collect();
    let outside = changed.iter().filter(|near| !**near).count();
    assert!(changed.len() > 500 && outside * 200 < changed.len(), "{outside} of {} pixels", changed.len());
}

#[test]
fn thresholds_have_two_ends() {
    let mut driver = crowd();
    for (by, slider, parts) in [
        ("distance", "to", [0.2, 0.9]),
        ("size on the screen", "coarsest below", [0.9, 0.1]),
        ("magnification", "coarsest below", [0.9, 0.1]),
        ("ratio of triangles", "to", [0.3, 0.9]),
    ] {
        driver.choose("levels by", by);
        let [coarse, fine] = parts.map(|part| {
            driver.slide(slider, part);
            driver.frames(10);
            driver.triangles()
        });
        assert!(coarse <= fine, "{by}: {coarse} {fine}");
        let levels = driver.shown().levels;
        for [first, last] in [levels.distances, levels.sizes, levels.magnifications] {
            assert!(first != last, "{by}");
        }
    }
    driver.slide("hysteresis", 0.9);
    assert!((driver.shown().levels.hysteresis - 0.45).abs() < 0.05);
    assert!(driver.viewer.scene_text().is_some_and(|text| text.contains("\"hysteresis\": 0.4")));
}

#[test]
fn gates_have_their_parts() {
    let mut driver = crowd();
    driver.click("Detail");
    driver.click("Bones");
    driver.click("Play");
    let bones = |driver: &mut Driver| {
        driver.settle();
        driver.frames(20);
        assert_eq!(driver.viewer.notice(), None);
        driver.viewer.history().median(15, |sample| Some(sample.bones)).expect("counted")
    };
    driver.choose("gate", "budget");
    driver.slide("bones a frame", 0.3);
    let few = bones(&mut driver);
    let most = f64::from(driver.shown().bones.bones);
    driver.slide("bones a frame", 0.95);
    let many = bones(&mut driver);
    assert!(few <= most && few < many, "{few} of {most}, {many}");
    driver.choose("gate", "uniform");
    driver.slide("all bones up to", 0.9);
    let near = bones(&mut driver);
    driver.slide("all bones up to", 0.1);
    driver.slide("none beyond", 0.3);
    let far = bones(&mut driver);
    assert!(far < near, "{far} {near}");
    driver.choose("gate", "skip-period");
    driver.settle();
    let weights = driver.shown().bones.weights;
    for term in ["rotation", "depth"] {
        if driver.find(term).is_some() {
            driver.slide(term, 0.2);
        }
    }
    assert!(driver.shown().bones.weights != weights);
    driver.settle();
    driver.click("weights from each clip");
    driver.settle();
    assert!(driver.viewer.scene_text().is_some_and(|text| text.contains("\"analyze\"")));
    // A click on a character chooses it.
    driver.click("show the bones of a character");
    driver.frames(10);
    let first = driver.shown().chosen.as_ref().expect("chosen").instance;
    driver.click("Pause");
    let picture = driver.picture();
    let background = *picture.get_pixel(2, 2);
    let mut others = Vec::new();
    for (x, y) in (10..picture.width() - 10)
        .step_by(6)
        .flat_map(|x| (40..picture.height() - 40).step_by(6).map(move |y| (x, y)))
    {
        if *picture.get_pixel(x, y) != background && others.is_empty() {
            driver.click_at(driver.point(x, y));
            if let Some(chosen) = driver.shown().chosen.as_ref().filter(|chosen| chosen.instance != first) {
                others.push(chosen.instance);
            }
        }
    }
    assert!(!others.is_empty(), "another character was chosen");
    // It stays chosen when another gate builds the scene anew.
    let place = |driver: &Driver| {
        let shown = driver.shown();
        let (world, chosen) = (&shown.stage.world, shown.chosen.as_ref().expect("chosen").instance);
        let all = world.objects.iter().filter_map(|object| world.scene.instances(object.object).ok());
        all.flatten().position(|instance| instance == chosen)
    };
    let before = place(&driver);
    driver.choose("gate", "bounded");
    driver.settle();
    assert_eq!(place(&driver), before);
    assert_eq!(driver.viewer.settings().drag, Drag::Orbit);
}

/// Controls that are shown change no value: here values have many digits, or lie beyond the ends of sliders.
#[test]
fn sections_that_open_change_nothing() {
    let mut driver = Driver::high([640, 2400]);
    let scene = r#"{
      "characters": [{ "file": "creature.rlv", "instances": [{ "at": [0, 0, 0] }],
        "gate": { "mode": "skip-period", "range": [1.23456, 31.23456], "period": 0.123456 } }],
      "light": { "direction": [0.41805, -0.1, 0.7193], "ambient": 0.33333 },
      "camera": { "at": [0, 1, 4], "look": [0, 0, 0] },
      "quality": { "pixels": 77.77777, "triangles": 17, "milliseconds": 333.33333 }
    }"#;
    let files = Memory::default().with("odd.json", scene.as_bytes()).with("creature.rlv", creature());
    driver.viewer.open("odd.json", Arc::new(files));
    driver.settle();
    assert_eq!(driver.viewer.notice(), None);
    // "Detail" is open from the beginning.
    let before = driver.viewer.scene_text().expect("a scene");
    for number in ["77.7777", "\"triangles\": 17", "333.3333", "0.41804", "-0.1000", "0.3333"] {
        assert!(before.contains(number), "{number} in {before}");
    }
    for section in ["Bones", "Light", "Plots", "Experiment", "Network"] {
        driver.click(section);
        driver.frames(3);
        assert_eq!(driver.viewer.scene_text().as_ref(), Some(&before), "{section}");
    }
    // The gate's own values, which come from the extent of the scene.
    driver.choose("gate", "skip-period");
    driver.settle();
    let gate = driver.viewer.scene_text();
    assert!(gate.as_ref().is_some_and(|text| text.contains("skip-period")));
    driver.frames(20);
    assert_eq!(driver.viewer.scene_text(), gate);
}

#[test]
fn full_detail_stays_beside_a_scene_until_another_one_is_there() {
    let mut driver = rocks([640, 2000]);
    driver.click("full detail beside it");
    driver.settle();
    driver.viewer.open_address("there/is/no.glb");
    driver.settle();
    assert!(driver.viewer.notice().is_some() && driver.viewer.compares());
    driver.viewer.open("creature.rlv", Arc::new(Memory::default().with("creature.rlv", creature())));
    driver.settle();
    assert!(driver.viewer.notice().is_none() && !driver.viewer.compares());
}

#[test]
fn the_experiment_can_be_cancelled() {
    let mut driver = rocks([640, 2000]);
    for section in ["Scene", "Detail", "Time and camera", "Experiment"] {
        driver.click(section);
    }
    driver.click("Run");
    assert!(driver.viewer.is_measuring() && driver.find("Run").is_none());
    driver.click("Cancel");
    assert!(!driver.viewer.is_measuring() && driver.find("Run").is_some());
    assert_eq!(driver.viewer.experiment_rows(), None);
    // Another one starts, with its own progress.
    driver.click("Run all distances");
    assert!(driver.viewer.is_measuring());
    driver.click("Cancel");
    driver.frames(3);
    assert_eq!((driver.viewer.is_measuring(), driver.viewer.experiment_rows()), (false, None));
}

#[test]
#[ignore = "measures for a minute, and alone: cargo test --test viewer -- --ignored press_of_a_button"]
fn the_experiment_of_thesis_a_runs_at_the_press_of_a_button() {
    let mut driver = rocks([640, 2000]);
    for section in ["Scene", "Detail", "Time and camera", "Experiment"] {
        driver.click(section);
    }
    driver.experiment("Run", Duration::from_secs(400));
    driver.save("experiment");
    driver.click("Save report");
    let saved = driver.requests.iter().find_map(|request| match request {
        Request::Save { name, bytes } if name == "sweep.json" => Some(bytes.clone()),
        _ => None,
    });
    let report: serde_json::Value = serde_json::from_slice(&saved.expect("saved")).expect("JSON");
    let layouts = report["layouts"].as_array().expect("a list");
    assert_eq!(layouts.len(), 2, "a grid, and at random in a cube");
    for layout in layouts {
        let rows = layout["rows"].as_array().expect("a list");
        let interpolated = |mode: &str, at: usize| {
            let row = rows.iter().filter(|row| row["mode"] == mode).nth(at).expect("a row");
            row["interpolated"].as_f64().expect("a number")
        };
        // The walk moves 113 of the 153 bones.
        assert_eq!(interpolated("off", 5), 100.0 * 113.0);
        for mode in ["skip-period", "uniform", "bounded"] {
            let far = interpolated(mode, 5);
            assert!(far < 0.7 * interpolated("off", 5), "{mode}: {far} bones at the farthest distance");
        }
    }
}
