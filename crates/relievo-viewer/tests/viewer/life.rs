//! The life of a viewer: resizing, keys alone, rest, a lost device, two at once, themes and settings.

use std::sync::Arc;
use std::time::Duration;

use egui::{Key, Modifiers};
use relievo::gpu::{Gpu, Options};
use relievo_viewer::{Memory, Request, Theme, Viewer};

use crate::driver::{Driver, creature, different, settings};
use crate::inputs::SCENE;

fn rocks(driver: &mut Driver) {
    let scene = SCENE.replace(r#", "path": null"#, "");
    driver.viewer.open("rocks.json", Arc::new(Memory::default().with("rocks.json", scene.into_bytes())));
    driver.settle();
    assert_eq!(driver.viewer.notice(), None);
}

#[test]
fn a_window_may_have_any_size_and_scale() {
    let mut driver = Driver::new([640, 400]);
    rocks(&mut driver);
    for (size, scale) in
        [([300, 220], 1.0), ([900, 500], 1.0), ([450, 300], 2.0), ([101, 77], 1.5), ([640, 400], 1.0)]
    {
        driver.resize(size, scale);
        driver.frames(4);
        let window = driver.window();
        assert_eq!([window.width(), window.height()], size.map(|edge| (edge as f32 * scale) as u32));
        let picture = driver.picture();
        let background = *picture.get_pixel(1, 1);
        let rocks = picture.pixels().filter(|pixel| **pixel != background).count();
        assert!(rocks > 10, "{size:?} × {scale}: {rocks} pixels");
    }
}

#[test]
fn keys_alone_reach_everything() {
    let mut driver = Driver::new([640, 700]);
    rocks(&mut driver);
    // Tab goes from control to control; the arrows move a slider.
    let mut reached = Vec::new();
    while driver.focused.as_deref() != Some("pixels off") && reached.len() < 60 {
        driver.key(Key::Tab);
        reached.extend(driver.focused.clone());
    }
    for name in ["Save picture", "Save scene", "Copy command", "pixels off"] {
        assert!(reached.iter().any(|reached| reached == name), "{name} among {reached:?}");
    }
    let pixels = driver.shown().quality.pixels;
    driver.key(Key::ArrowRight);
    driver.key(Key::ArrowRight);
    assert!(driver.shown().quality.pixels > pixels);
    driver.key(Key::Escape);
    driver.frames(2);
    // Space presses the button that has the focus, and plays and pauses otherwise.
    let plays = driver.shown().clock.plays;
    driver.key(Key::Space);
    assert!(driver.shown().clock.plays != plays);
    let before = driver.shown().quality.pixels;
    driver.key(Key::CloseBracket);
    assert!(driver.shown().quality.pixels > before);
    driver.key(Key::OpenBracket);
    driver.key(Key::P);
    driver.frames(30);
    assert!(!driver.viewer.settings().panel && driver.rect("picture").width() > 600.0);
    driver.event(egui::Event::Text("?".to_owned()));
    driver.frames(4);
    driver.save("keys");
    driver.key_with(Key::P, Modifiers::NONE);
    driver.frames(30);
    assert!(driver.viewer.settings().panel && driver.rect("picture").width() < 450.0);
}

#[test]
fn nothing_is_drawn_while_nothing_changes() {
    let mut driver = Driver::new([640, 400]);
    rocks(&mut driver);
    driver.frames(60);
    // Rocks do not move: the next frame waits for an event.
    assert!(driver.wait.is_none_or(|wait| wait > Duration::from_secs(1)), "{:?}", driver.wait);
    let crowd = r#"{"characters": [{"file": "creature.rlv", "instances": [{"at": [0, 0, 0]}]}],
        "camera": {"at": [0, 1, 4], "look": [0, 1, 0]}}"#;
    driver.viewer.open(
        "one.json",
        Arc::new(Memory::default().with("one.json", crowd.as_bytes()).with("creature.rlv", creature())),
    );
    driver.settle();
    assert_eq!(driver.wait, Some(Duration::ZERO), "a creature walks");
    let drawn = driver.shown().stage.world.scene.frames();
    driver.frame_after(61.0).expect("painted");
    driver.frames(10);
    assert!(driver.viewer.is_resting() && driver.wait.is_none());
    assert_eq!(driver.shown().stage.world.scene.frames(), drawn, "no frame after 60 s without input");
    driver.hover(egui::pos2(100.0, 100.0));
    driver.frames(2);
    assert!(!driver.viewer.is_resting());
    assert!(driver.shown().stage.world.scene.frames() > drawn);
}

#[test]
fn a_lost_device_is_replaced() {
    let open = || Gpu::headless(&Options::default()).expect("the suite needs an adapter");
    let mut driver = Driver::with(open(), [640, 400], 1.0, settings());
    rocks(&mut driver);
    let (picture, window) = (driver.picture(), driver.window());
    driver.viewer.gpu().device().destroy();
    let error = driver.frame_after(0.02).expect_err("it is lost");
    assert!(matches!(error, relievo::Error::Gpu(_)), "{error}");
    let gpu = open();
    gpu.block_on(driver.viewer.rebuild(gpu.clone())).expect("rebuilt");
    driver.resize([640, 400], 1.0);
    driver.frames(4);
    assert_eq!(different(&driver.picture(), &picture), 0);
    let letters = different(&driver.window(), &window);
    // The status line and the plots have other times.
    assert!(letters < 5000, "{letters} pixels of the panel differ");
    driver.slide("pixels off", 0.9);
    assert!(driver.shown().quality.pixels > 4.0 && driver.viewer.notice().is_none());
}

#[test]
fn two_viewers_share_a_device() {
    let [mut one, mut other] = [0, 1].map(|_| Driver::new([640, 400]));
    rocks(&mut one);
    rocks(&mut other);
    one.slide("pixels off", 0.95);
    for _ in 0..10 {
        one.frame();
        other.frame();
    }
    assert!(one.triangles() < other.triangles());
}

#[test]
fn themes_and_settings_are_remembered() {
    let mut driver = Driver::new([640, 400]);
    rocks(&mut driver);
    let panel = |driver: &mut Driver| {
        let window = driver.window();
        window.get_pixel(window.width() - 4, window.height() - 40).0[0]
    };
    assert!(panel(&mut driver) < 60);
    driver.click("light");
    driver.frames(10);
    assert!(panel(&mut driver) > 200, "{}", panel(&mut driver));
    let remembered = driver.requests.iter().rev().find_map(|request| match request {
        Request::Remember(settings) => Some(settings.clone()),
        _ => None,
    });
    let remembered = remembered.expect("remembered");
    assert_eq!(remembered.theme, Theme::Light);
    let again = Driver::with(driver.viewer.gpu().clone(), [640, 400], 1.0, remembered.clone());
    assert_eq!(again.viewer.settings(), &remembered);
    let _: &Viewer = &again.viewer;
}
