//! Every control, moved by pointer or keys.

use std::sync::Arc;

use egui::{Key, Modifiers, PointerButton, vec2};
use relievo_viewer::{Colors, Memory, Request};

use crate::driver::{Driver, creature, different};

/// A crowd of creatures before a camera that has a path.
pub const CROWD: &str = r#"{
  "characters": [{ "file": "creature.rlv", "clip": "walk", "scatter": { "count": 10, "seed": "crowd", "area": [[-6, -16], [6, 0]] } }],
  "light": { "direction": [0.4, 0.8, 0.6] },
  "camera": { "path": [{ "time": 0, "at": [0, 3, 14], "look": [0, 1, 0] }, { "time": 4, "at": [6, 3, 14], "look": [0, 1, 0] }] },
  "background": [0.2, 0.22, 0.25]
}"#;

/// A scene, and the package of its characters.
fn files(name: &str, scene: Vec<u8>) -> Memory {
    Memory::default().with(name, scene).with("creature.rlv", creature())
}

/// A viewer with the crowd, in a window that is high enough for all sections.
pub fn crowd() -> Driver {
    let mut driver = Driver::high([580, 1400]);
    driver.viewer.open("crowd.json", Arc::new(files("crowd.json", CROWD.as_bytes().to_vec())));
    driver.settle();
    assert_eq!(driver.viewer.notice(), None);
    driver.click("Pause");
    driver.frames(4);
    driver
}

#[test]
fn controls_of_detail_do_what_they_say() {
    let mut driver = crowd();
    let own = driver.triangles();
    let bound = |driver: &Driver| driver.viewer.history().last().and_then(|sample| sample.bound);
    assert!(bound(&driver).is_some_and(|bound| (bound - 1.0).abs() < 1e-6));

    driver.slide("pixels off", 0.9);
    let coarse = driver.triangles();
    let pixels = driver.shown().quality.pixels;
    assert!(pixels > 8.0 && coarse < 0.6 * own, "{pixels} px: {coarse} of {own} triangles");
    assert!(bound(&driver).is_some_and(|bound| (bound - f64::from(pixels)).abs() < 1e-3));
    driver.slide("pixels off", 0.0);
    let full = driver.triangles();
    assert!(driver.shown().quality.pixels == 0.0 && full > own, "{full} of {own}");

    driver.click("triangles");
    driver.slide("largest number of triangles", 0.45);
    let limit = f64::from(driver.shown().quality.triangles);
    let limited = driver.triangles();
    assert!(limited <= limit && limited < full, "{limited} of {limit}");
    driver.click("triangles");
    assert_eq!(driver.triangles(), full);

    driver.click("milliseconds");
    driver.slide("largest number of milliseconds", 0.0);
    assert_eq!(driver.shown().quality.quality().milliseconds, Some(1.0));
    driver.frames(60);
    let paced = driver.triangles();
    assert!(paced < full, "a frame of a software adapter takes more than a millisecond: {paced} of {full}");
    driver.click("milliseconds");
}

#[test]
fn levels_are_chosen_as_the_list_says() {
    let mut driver = crowd();
    let own = driver.triangles();
    driver.choose("levels by", "one level");
    driver.slide("level", 1.0);
    let coarsest = driver.triangles();
    driver.slide("level", 0.0);
    let finest = driver.triangles();
    assert!(coarsest < own && own < finest, "{coarsest} {own} {finest}");
    let bound = |driver: &Driver| driver.viewer.history().last().and_then(|sample| sample.bound);
    assert!(bound(&driver).is_some(), "the finest level has no error");

    driver.choose("levels by", "distance");
    driver.slide("from", 0.2);
    driver.slide("to", 0.3);
    let near = driver.triangles();
    driver.slide("to", 0.9);
    driver.slide("from", 0.8);
    let far = driver.triangles();
    assert!(near < far, "levels that begin near are coarser: {near} {far}");
    assert_eq!(bound(&driver), None, "a distance bounds no error");

    driver.choose("levels by", "size on the screen");
    driver.slide("below", 0.98);
    let large = driver.triangles();
    driver.slide("below", 0.05);
    assert!(large < driver.triangles());

    driver.choose("levels by", "ratio of triangles");
    let ratio = driver.triangles();
    driver.choose("levels by", "magnification");
    driver.slide("below", 0.98);
    let magnified = driver.triangles();
    driver.slide("below", 0.05);
    assert!(ratio > 0.0 && magnified < driver.triangles());

    driver.choose("levels by", "as the scene says");
    assert_eq!(driver.triangles(), own);
    driver.slide("bias", 0.95);
    assert!(driver.triangles() < own);
    driver.choose("transition", "dither");
    let text = driver.viewer.scene_text().expect("a scene");
    assert!(text.contains("\"transition\": \"dither\"") && text.contains("\"bias\""), "{text}");
}

#[test]
fn full_detail_is_shown_beside_behind_a_wiper() {
    let mut driver = crowd();
    driver.slide("pixels off", 0.97);
    driver.frames(4);
    let coarse = driver.picture();
    driver.click("full detail beside it");
    driver.settle();
    assert!(driver.viewer.compares());
    let compared = driver.picture();
    let half = |picture: &image::RgbaImage, right: bool| {
        let width = picture.width() / 2 - 24;
        let x = if right { picture.width() / 2 + 24 } else { 0 };
        image::imageops::crop_imm(picture, x, 60, width, picture.height() - 60).to_image()
    };
    assert_eq!(different(&half(&compared, true), &half(&coarse, true)), 0, "the present detail to the right");
    assert!(different(&half(&compared, false), &half(&coarse, false)) > 50, "full detail to the left");
    // In full detail, the left half is the picture at 0 pixels.
    let wiper = driver.rect("wiper").center();
    driver.drag(wiper, wiper + vec2(80.0, 0.0), PointerButton::Primary);
    let moved = driver.rect("wiper").center();
    assert!((moved.x - wiper.x - 80.0).abs() < 12.0, "{wiper} {moved}");
    driver.key(Key::C);
    driver.frames(4);
    assert!(!driver.viewer.compares());
    assert_eq!(different(&driver.picture(), &coarse), 0);
}

#[test]
fn colours_boxes_and_bones_are_painted() {
    let mut driver = crowd();
    let shaded = driver.picture();
    driver.click("levels");
    assert_eq!(driver.viewer.settings().colors, Colors::Levels);
    driver.frames(3);
    let levels = driver.picture();
    assert!(different(&levels, &shaded) > 500);
    driver.key(Key::L);
    driver.frames(3);
    assert_eq!(different(&driver.picture(), &shaded), 0);
    driver.click("bounding boxes");
    let boxes = different(&driver.picture(), &shaded);
    assert!(boxes > 300, "{boxes} pixels of boxes");
    driver.click("bounding boxes");

    driver.click("Bones");
    driver.click("show the bones of a character");
    driver.frames(10);
    assert!(different(&driver.picture(), &shaded) > 40, "lines of bones");
    let [all, active] = driver.shown().chosen.as_ref().expect("chosen").counts();
    assert_eq!((all, active), (153, 0), "nothing is sampled while the time stands still");
    driver.click("Play");
    driver.frames(20);
    let chosen = driver.shown().chosen.as_ref().expect("chosen");
    assert!(chosen.counts()[1] > 10, "{:?}", chosen.counts());
    let off = chosen.displacement().expect("measured");
    assert!(off <= 1.0, "{off} px, though a pixel is allowed");
}

/// Endless terrain has the colours of its levels: red near the camera, others farther away.
#[test]
fn endless_terrain_has_the_colours_of_its_levels() {
    let mut driver = Driver::new([640, 480]);
    let scene = r#"{
      "terrain": { "config": { "patchSize": 17, "scaleFactor": 60, "seed": "levels", "coarseLevels": 6 }, "endless": true, "view": 500 },
      "camera": { "at": [0, 80, 0], "look": [90, 50, 60], "far": 900 },
      "quality": { "pixels": 24 }
    }"#;
    driver.viewer.open("land.json", Arc::new(Memory::default().with("land.json", scene.as_bytes())));
    driver.settle();
    driver.key(Key::L);
    driver.frames(60);
    assert_eq!(driver.shown().stage.ready(), 1.0);
    driver.save("levels-endless");
    let picture = driver.picture();
    let part = |is: &dyn Fn([u8; 4]) -> bool| {
        picture.pixels().filter(|pixel| is(pixel.0)).count() as f64 / picture.pixels().len() as f64
    };
    let red = part(&|[red, green, blue, _]| red / 2 > green.max(blue));
    let green = part(&|[red, green, blue, _]| green > red.max(blue).saturating_add(10));
    assert!(red > 0.02 && green > 0.02, "{red} {green}");
}

#[test]
fn gates_of_bones_change_the_work() {
    let mut driver = crowd();
    driver.click("Bones");
    driver.click("Play");
    let bones = |driver: &mut Driver, gate: &str| {
        driver.choose("gate", gate);
        driver.settle();
        driver.frames(20);
        assert_eq!(driver.viewer.notice(), None, "{gate}");
        driver.viewer.history().median(15, |sample| Some(sample.bones)).expect("counted")
    };
    let off = bones(&mut driver, "off");
    let bounded = bones(&mut driver, "bounded");
    let uniform = bones(&mut driver, "uniform");
    let budget = bones(&mut driver, "budget");
    assert!(bounded < off && uniform < off, "{off} {bounded} {uniform}");
    assert!(budget <= f64::from(driver.shown().bones.bones), "{budget}");
    bones(&mut driver, "skip-period");
    driver.slide("period in seconds", 0.0);
    driver.settle();
    driver.slide("rotation", 0.1);
    driver.settle();
    driver.slide("none beyond", 0.4);
    driver.settle();
    let text = driver.viewer.scene_text().expect("a scene");
    assert!(text.contains("\"skip-period\"") && text.contains("\"weights\""), "{text}");
    let skipped = driver.viewer.history().median(15, |sample| Some(sample.bones)).expect("counted");
    assert!(skipped < off, "{skipped} of {off}");
    driver.choose("gate", "as the scene says");
    driver.settle();
    assert!(!driver.viewer.scene_text().expect("a scene").contains("skip-period"));
}

#[test]
fn time_stands_still_steps_and_runs_slowly() {
    let mut driver = crowd();
    let time = |driver: &Driver| driver.shown().time();
    let still = time(&driver);
    let picture = driver.picture();
    driver.frames(5);
    assert_eq!((time(&driver), different(&driver.picture(), &picture)), (still, 0));
    driver.click("Step");
    assert!((time(&driver) - still - 1.0 / 60.0).abs() < 1e-6);
    driver.key(Key::Period);
    assert!((time(&driver) - still - 2.0 / 60.0).abs() < 1e-6);
    driver.slide("speed", 0.0);
    let speed = f64::from(driver.shown().clock.speed);
    driver.key(Key::Space);
    let from = time(&driver);
    driver.frames(30);
    let way = time(&driver) - from;
    assert!((way - 0.5 * speed).abs() < 0.02 && speed < 0.1, "{way} s at {speed}");
    // The scene's camera has a path of 4 seconds.
    let at = |driver: &Driver| driver.shown().camera([300, 200]).world();
    assert!(driver.shown().clock.follows);
    driver.slide("seconds of the path", 0.99);
    assert!(time(&driver) > 3.0 && at(&driver).x > 4.0, "{} {}", time(&driver), at(&driver));
    driver.click("follow the scene's camera");
    assert!(!driver.shown().clock.follows);
}

#[test]
fn the_camera_follows_pointer_and_keys() {
    let mut driver = crowd();
    let eye = |driver: &Driver| driver.shown().eye;
    let middle = driver.rect("picture").center();
    let to = middle + vec2(60.0, 20.0);
    driver.drag(middle, to, PointerButton::Primary);
    let orbited = eye(&driver);
    assert!(!driver.shown().clock.follows, "it leaves the path");
    driver.drag(middle, to, PointerButton::Primary);
    let again = eye(&driver);
    assert!(again.yaw < orbited.yaw && again.pitch < orbited.pitch && again.focus == orbited.focus);
    driver.drag(middle, to, PointerButton::Secondary);
    assert!(eye(&driver).focus != again.focus && eye(&driver).yaw == again.yaw);
    driver.hover(middle);
    let before = eye(&driver).distance;
    driver.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: vec2(0.0, 3.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    driver.frames(20);
    assert!(eye(&driver).distance < 0.95 * before, "{} {before}", eye(&driver).distance);

    driver.click("fly");
    let position = eye(&driver).position();
    driver.drag(middle, to, PointerButton::Primary);
    assert!(
        eye(&driver).position().distance(position) < 1e-6 && eye(&driver).focus().distance(position) > 0.1
    );
    let from = eye(&driver).position();
    driver.hold(Key::W, 10);
    let way = eye(&driver).position() - from;
    assert!(way.dot(eye(&driver).ahead()) > 0.1, "{way}");
    driver.hold(Key::ArrowLeft, 5);
    driver.hold(Key::Plus, 5);

    // A bookmark, by keys and by a click.
    let kept = eye(&driver);
    driver.key_with(Key::Num3, Modifiers::SHIFT);
    driver.hold(Key::D, 10);
    assert!(eye(&driver) != kept);
    driver.key(Key::Num3);
    assert_eq!(eye(&driver), kept);
    driver.hold(Key::E, 10);
    driver.click("3");
    assert_eq!(eye(&driver), kept);
    let text = driver.viewer.scene_text().expect("a scene");
    assert!(!text.contains("\"path\""), "the camera that was moved is in the file: {text}");
    driver.click("Home");
    assert!(
        driver.shown().clock.follows && driver.viewer.scene_text().expect("a scene").contains("\"path\"")
    );

    // A double click looks at what is there.
    driver.click("orbit");
    let picture = driver.picture();
    let background = *picture.get_pixel(2, 2);
    let is_inside =
        |x: u32, y: u32| (0..25).all(|at| *picture.get_pixel(x + at % 5 - 2, y + at / 5 - 2) != background);
    let all = picture.enumerate_pixels().map(|(x, y, _)| (x, y));
    let inner = all
        .filter(|(x, y)| (20..picture.width() - 20).contains(x) && (60..picture.height() - 60).contains(y));
    let (x, y) = inner.into_iter().find(|(x, y)| is_inside(*x, *y)).expect("a creature");
    let spot = driver.point(x, y);
    let focus = eye(&driver).focus;
    // Long after the last click.
    driver.frames(30);
    driver.hover(spot);
    for _ in 0..2 {
        driver.press(spot, PointerButton::Primary, true);
        driver.press(spot, PointerButton::Primary, false);
    }
    driver.frames(3);
    assert!(eye(&driver).focus != focus);
}

#[test]
fn the_sun_and_the_exposure_change_the_picture() {
    let mut driver = crowd();
    let mean = |driver: &mut Driver| {
        let picture = driver.picture();
        let sum: f64 = picture.pixels().map(|pixel| f64::from(pixel.0[0])).sum();
        sum / picture.pixels().len() as f64
    };
    driver.click("Light");
    let before = (mean(&mut driver), driver.picture());
    driver.slide("exposure", 0.75);
    driver.frames(3);
    assert!(mean(&mut driver) > 1.2 * before.0);
    assert!((driver.shown().exposure - 2.0).abs() < 0.4, "{}", driver.shown().exposure);
    driver.slide("exposure", 0.5);
    driver.slide("ambient", 1.0);
    driver.frames(3);
    assert!(different(&driver.picture(), &before.1) > 300);
    driver.slide("ambient", 0.0);
    driver.frames(3);
    let lit = driver.picture();
    driver.slide("sun, direction", 0.05);
    driver.frames(3);
    assert!(different(&driver.picture(), &lit) > 300);
    driver.slide("sun, height", 0.2);
    let low = driver.shown().light.direction.normalize().y;
    assert!(low < 0.5, "{low}");
    driver.click("sun");
    let direction = driver.shown().light.direction;
    let middle = driver.rect("picture").center();
    driver.drag(middle, middle + vec2(50.0, -30.0), PointerButton::Primary);
    assert!(
        driver.shown().light.direction.y > direction.y && driver.shown().light.direction.x != direction.x
    );
}

#[test]
fn pictures_scenes_and_commands_are_handed_out() {
    let mut driver = crowd();
    driver.slide("pixels off", 0.8);
    driver.click("Save picture");
    driver.frames(3);
    driver.click("Save scene");
    driver.click("Copy command");
    let requests = std::mem::take(&mut driver.requests);
    let saved = |ending: &str| {
        let found = requests.iter().find_map(|request| match request {
            Request::Save { name, bytes } if name.ends_with(ending) => Some((name.clone(), bytes.clone())),
            _ => None,
        });
        found.unwrap_or_else(|| panic!("nothing that ends in {ending}"))
    };
    let (name, bytes) = saved(".png");
    let picture = image::load_from_memory(&bytes).expect("a picture").into_rgba8();
    assert_eq!((name.as_str(), different(&picture, &driver.picture())), ("crowd.png", 0));
    let (name, bytes) = saved(".json");
    assert_eq!(name, "crowd-view.json");
    let file =
        relievo_scene_file::SceneFile::from_json(str::from_utf8(&bytes).expect("text")).expect("a scene");
    assert_eq!(file.quality().pixels, driver.shown().quality.pixels);
    let command = requests.iter().find_map(|request| match request {
        Request::Copy(text) => Some(text.clone()),
        _ => None,
    });
    let command = command.expect("copied");
    assert!(
        command.starts_with("relievo view 'crowd.json' --pixels=") && command.contains(" --at="),
        "{command}"
    );

    // The scene that was saved shows the same picture.
    let mut other = Driver::high([580, 1400]);
    other.viewer.open("crowd-view.json", Arc::new(files("crowd-view.json", bytes)));
    other.settle();
    other.click("Pause");
    let time = driver.shown().time() - other.shown().time();
    assert!(time.abs() < 3.0);
}

#[test]
fn sections_open_and_plots_have_points() {
    let mut driver = crowd();
    driver.click("Detail");
    driver.click("Time and camera");
    driver.click("Scene");
    driver.click("Plots");
    driver.frames(30);
    driver.save("plots");
    let history = driver.viewer.history();
    for value in [
        |sample: &relievo_viewer::Sample| Some(sample.frame),
        |sample: &relievo_viewer::Sample| sample.device,
        |sample: &relievo_viewer::Sample| sample.bound,
        |sample: &relievo_viewer::Sample| sample.stages.map(|stages| stages[0]),
    ] {
        assert!(history.points(value).len() > 10);
    }
}
