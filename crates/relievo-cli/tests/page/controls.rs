//! Every control of the page, moved by pointer or keys. A viewer without a window gets the same events, and its widgets tell where they
//! are; afterwards the controls of both have to say the same. What each control does to pictures and counts, the viewer's own suite
//! tests.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, TouchPhase, vec2};
use relievo::ops::animation::priority::TERMS;
use relievo_viewer::{Shown, Start};
use serde_json::{Value, json};

#[allow(dead_code, reason = "the suite of the viewer uses the rest")]
#[path = "../../../relievo-viewer/tests/viewer/driver.rs"]
mod driver;

use driver::Driver;

/// Width and height of the window: high enough for all sections.
pub const SIZE: [u32; 2] = [580, 1400];

/// The same for the experiment, which draws the window all the time.
pub const SMALL: [u32; 2] = [580, 420];

/// A crowd before a camera that has a path.
pub const CROWD: &str = r#"{
  "characters": [{ "file": "creature.rlv", "clip": "walk", "scatter": { "count": 6, "seed": "crowd", "area": [[-4, -8], [4, 0]] } }],
  "light": { "direction": [0.4, 0.8, 0.6] },
  "camera": { "path": [{ "time": 0, "at": [0, 3, 10], "look": [0, 1, 0] }, { "time": 4, "at": [6, 3, 10], "look": [0, 1, 0] }] },
  "background": [0.2, 0.22, 0.25]
}"#;

/// Largest relative difference of numbers, and what is added for numbers near 0: both viewers compute them from the same events.
const SAME: f64 = 1e-3;
const NEAR_ZERO: f64 = 1e-6;

type Step = (&'static str, fn(&mut Driver));

/// What a user does, and its name. Each step but those of `UNSEEN` changes what the controls say.
const STEPS: &[Step] = &[
    ("pixels", |user| user.slide("pixels off", 0.8)),
    ("limit of triangles", |user| user.click("triangles")),
    ("number of triangles", |user| user.slide("largest number of triangles", 0.3)),
    ("no limit of triangles", |user| user.click("triangles")),
    ("limit of milliseconds", |user| user.click("milliseconds")),
    ("number of milliseconds", |user| user.slide("largest number of milliseconds", 0.9)),
    ("no limit of milliseconds", |user| user.click("milliseconds")),
    ("full detail", |user| user.click("full detail beside it")),
    ("wiper", |user| {
        let at = user.rect("wiper").center();
        user.drag(at, at - vec2(60.0, 0.0), PointerButton::Primary);
    }),
    ("no full detail, by a key", |user| user.key(Key::C)),
    ("colours of levels", |user| user.click("levels")),
    ("shaded, by a key", |user| user.key(Key::L)),
    ("boxes", |user| user.click("bounding boxes")),
    ("edges", |user| user.click("edges of triangles")),
    ("no edges, by a key", |user| user.key(Key::M)),
    ("one level", |user| user.choose("levels by", "one level")),
    ("level", |user| user.slide("level", 0.5)),
    ("distance", |user| user.choose("levels by", "distance")),
    ("first distance", |user| user.slide("from", 0.4)),
    ("last distance", |user| user.slide("to", 0.8)),
    ("size", |user| user.choose("levels by", "size on the screen")),
    ("first size", |user| user.slide("below", 0.9)),
    ("last size", |user| user.slide("coarsest below", 0.3)),
    ("magnification", |user| user.choose("levels by", "magnification")),
    ("first magnification", |user| user.slide("below", 0.8)),
    ("last magnification", |user| user.slide("coarsest below", 0.3)),
    ("ratio", |user| user.choose("levels by", "ratio of triangles")),
    ("near end of the ratio", |user| user.slide("from", 0.3)),
    ("error", |user| user.choose("levels by", "error in pixels")),
    ("transition", |user| user.choose("transition", "dither")),
    ("bias", |user| user.slide("bias", 0.8)),
    ("hysteresis", |user| user.slide("hysteresis", 0.8)),
    ("one level again", |user| user.choose("levels by", "one level")),
    ("levels of the scene", |user| user.choose("levels by", "as the scene says")),
    ("a step of time", |user| user.click("Step")),
    ("a step of time, by a key", |user| user.key(Key::Period)),
    ("speed", |user| user.slide("speed", 0.2)),
    ("time of the path", |user| user.slide("seconds of the path", 0.6)),
    ("own camera", |user| user.click("follow the scene's camera")),
    ("orbit", |user| over_picture(user, PointerButton::Primary)),
    ("pan", |user| over_picture(user, PointerButton::Secondary)),
    ("zoom", |user| {
        let middle = user.rect("picture").center();
        user.hover(middle);
        let (unit, phase) = (MouseWheelUnit::Line, TouchPhase::Move);
        let (source, modifiers) = (egui::MouseWheelSource::Wheel, Modifiers::NONE);
        user.event(Event::MouseWheel { unit, delta: vec2(0.0, 3.0), phase, source, modifiers });
        user.frames(40);
    }),
    ("drag flies", |user| user.click("fly")),
    ("look around", |user| over_picture(user, PointerButton::Primary)),
    ("bookmark", |user| user.click("4")),
    ("bookmark, by a key", |user| user.key_with(Key::Num2, Modifiers::SHIFT)),
    ("drag moves the sun", |user| user.click("sun")),
    ("sun by dragging", |user| over_picture(user, PointerButton::Primary)),
    ("drag orbits", |user| user.click("orbit")),
    ("elsewhere", |user| over_picture(user, PointerButton::Primary)),
    ("back at the bookmark", |user| user.click("4")),
    ("home", |user| user.click("Home")),
    ("Light", |user| user.click("Light")),
    ("direction of the sun", |user| user.slide("sun, direction", 0.3)),
    ("height of the sun", |user| user.slide("sun, height", 0.3)),
    ("ambient", |user| user.slide("ambient", 0.7)),
    ("exposure", |user| user.slide("exposure", 0.7)),
    ("Light again", |user| user.click("Light")),
    ("Bones", |user| user.click("Bones")),
    ("bones painted", |user| user.click("show the bones of a character")),
    ("bones not painted, by a key", |user| user.key(Key::B)),
    ("gate off", |user| user.choose("gate", "off")),
    ("gate bounded", |user| user.choose("gate", "bounded")),
    ("gate budget", |user| user.choose("gate", "budget")),
    ("bones a frame", |user| user.slide("bones a frame", 0.4)),
    ("gate uniform", |user| user.choose("gate", "uniform")),
    ("all bones up to", |user| user.slide("all bones up to", 0.3)),
    ("no bones beyond", |user| user.slide("none beyond", 0.8)),
    ("gate skip-period", |user| user.choose("gate", "skip-period")),
    ("period", |user| user.slide("period in seconds", 0.3)),
    ("weight of the first term", |user| user.slide(TERMS[0], 0.2)),
    ("weight of the second term", |user| user.slide(TERMS[1], 0.3)),
    ("weight of the third term", |user| user.slide(TERMS[2], 0.4)),
    ("weight of the fourth term", |user| user.slide(TERMS[3], 0.5)),
    ("weight of the fifth term", |user| user.slide(TERMS[4], 0.6)),
    ("weight of the sixth term", |user| user.slide(TERMS[5], 0.7)),
    ("analysed weights", |user| user.click("weights from each clip")),
    ("gate of the scene", |user| user.choose("gate", "as the scene says")),
    ("Bones again", |user| user.click("Bones")),
    ("light theme", |user| user.click("light")),
    ("theme of the system", |user| user.click("system")),
    ("dark theme", |user| user.click("dark")),
    ("panel hidden", |user| {
        user.click("Hide panel");
        user.frames(30);
    }),
    ("panel shown", |user| {
        user.click("Show panel");
        user.frames(30);
    }),
    ("list of keys", |user| user.click("Keys")),
    ("no list of keys, by a key", |user| user.key(Key::Escape)),
    ("Network", |user| user.click("Network")),
    ("throttle", |user| user.choose("throttle", "15.91 Mbit/s")),
    ("no throttle", |user| user.choose("throttle", "no limit")),
    ("Network again", |user| user.click("Network")),
    ("picture saved", |user| user.click("Save picture")),
    ("scene saved", |user| user.click("Save scene")),
    ("command copied", |user| user.click("Copy command")),
    ("time goes on", |user| user.click("Play")),
    ("time stands still", |user| user.click("Pause")),
];

/// Steps after which the controls say what they said before: sections that fold, and what goes out.
const UNSEEN: [&str; 9] = [
    "Light",
    "Light again",
    "Bones",
    "Bones again",
    "Network",
    "Network again",
    "picture saved",
    "scene saved",
    "command copied",
];

/// Steps during which the time of the scene goes on by the clock.
const TIMED: [&str; 2] = ["time goes on", "time stands still"];

/// Drags the pointer over the picture.
fn over_picture(user: &mut Driver, button: PointerButton) {
    let middle = user.rect("picture").center();
    user.drag(middle, middle + vec2(40.0, 25.0), button);
}

/// The steps for the page: their names, what happens frame by frame, and what the controls say afterwards. The scene is that of a
/// server.
pub fn recorded(scene: &str) -> Vec<Value> {
    let mut user = Driver::new(SIZE);
    user.viewer.begin(Start { scene: Some(scene.to_owned()), time: Some(0.0), ..Start::default() });
    settle(&mut user);
    assert_eq!(user.viewer.notice(), None);
    let mut steps = vec![json!({ "name": "opened", "frames": [], "controls": user.viewer.controls() })];
    for (name, act) in STEPS {
        let log = user.recorded(|user| {
            act(user);
            settle(user);
        });
        let (before, after) = (steps[steps.len() - 1]["controls"].clone(), user.viewer.controls());
        let changed = differences(name, &after, &before);
        assert_eq!(changed.is_empty(), UNSEEN.contains(name), "{name}: {changed:?}");
        steps.push(json!({ "name": name, "frames": frames(&log), "controls": after }));
    }
    // An address, and a scene of the list, which the viewer without a window does not wait for.
    let log = user.recorded(|user| user.click("text"));
    steps.push(
        json!({ "name": "address", "frames": frames(&log), "types": "/corner.obj", "opens": "corner.obj" }),
    );
    let log = user.recorded(|user| user.choose("Examples and recent files", "A creature of 153 bones"));
    steps.push(json!({ "name": "example", "frames": frames(&log), "opens": "creature.json" }));
    steps
}

/// Waits until all of the scene is there that the picture needs.
fn settle(user: &mut Driver) {
    user.settle();
    let start = Instant::now();
    while user.viewer.shown().is_none_or(Shown::is_streaming) {
        assert!(start.elapsed() < Duration::from_secs(60), "{:?}", user.viewer.notice());
        std::thread::sleep(Duration::from_millis(5));
        user.frame();
    }
    user.frames(8);
}

/// The steps that open the section of the experiment of thesis A, start it, and cancel it.
pub fn experiment(folder: &Path) -> Vec<Value> {
    let mut user = Driver::new(SMALL);
    user.open(&folder.join("rock.rlv"));
    let mut step = |names: &[&str]| {
        let log = user.recorded(|user| names.iter().for_each(|name| user.click(name)));
        json!({ "frames": frames(&log) })
    };
    let opened = step(&["Scene", "Detail", "Time and camera", "Experiment"]);
    vec![opened, step(&["Run"]), step(&["Cancel"])]
}

/// Events frame by frame as the page replays them; a number is that of frames without events.
fn frames(log: &[Vec<Event>]) -> Value {
    let mut frames: Vec<Value> = Vec::new();
    for events in log {
        match (frames.last().and_then(Value::as_u64), events.is_empty()) {
            (Some(count), true) => *frames.last_mut().expect("a number") = json!(count + 1),
            (None, true) => frames.push(json!(1)),
            (_, false) => frames.push(events.iter().filter_map(replayed).collect()),
        }
    }
    frames.into()
}

/// An event as the page's script knows it.
fn replayed(event: &Event) -> Option<Value> {
    Some(match event {
        Event::PointerMoved(at) => json!({ "moves": [at.x, at.y] }),
        Event::PointerButton { pos, button, pressed, .. } => {
            json!({ "button": *button as usize * 2, "pressed": pressed, "at": [pos.x, pos.y] })
        }
        // The page gets the modifiers with the keys.
        Event::Key { key, pressed, modifiers, .. } => {
            let (code, name) = match key {
                Key::Space => ("Space".to_owned(), " ".to_owned()),
                Key::Period => ("Period".to_owned(), ".".to_owned()),
                Key::Escape => ("Escape".to_owned(), "Escape".to_owned()),
                key if key.name().parse::<u8>().is_ok() => {
                    (format!("Digit{}", key.name()), key.name().to_owned())
                }
                key => (format!("Key{}", key.name()), key.name().to_lowercase()),
            };
            json!({ "code": code, "key": name, "pressed": pressed, "shift": modifiers.shift })
        }
        // A line of the wheel is 40 points natively.
        Event::MouseWheel { delta, .. } => json!({ "wheel": -40.0 * delta.y }),
        _ => return None,
    })
}

/// Where what the page's controls say differs from what those of the viewer without a window say.
pub fn differences(step: &str, page: &Value, own: &Value) -> Vec<String> {
    let mut found = Vec::new();
    differ("", page, own, &mut found);
    found.retain(|path| !(path.starts_with("/time ") && TIMED.contains(&step)));
    found
}

fn differ(path: &str, page: &Value, own: &Value, found: &mut Vec<String>) {
    // Names of files that were opened are addresses in the page.
    if path == "/settings/recent" {
        return;
    }
    match (page, own) {
        (Value::Object(one), Value::Object(other)) => {
            for name in one.keys().chain(other.keys().filter(|name| !one.contains_key(*name))) {
                let [one, other] = [one, other].map(|all| all.get(name).unwrap_or(&Value::Null));
                differ(&format!("{path}/{name}"), one, other, found);
            }
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            for (at, (one, other)) in one.iter().zip(other).enumerate() {
                differ(&format!("{path}/{at}"), one, other, found);
            }
        }
        (Value::Number(one), Value::Number(other)) => {
            let [one, other] = [one, other].map(|number| number.as_f64().expect("finite"));
            if (one - other).abs() > SAME * one.abs().max(other.abs()) + NEAR_ZERO {
                found.push(format!("{path} {one} {other}"));
            }
        }
        _ if page == own => {}
        _ => found.push(format!("{path} {page} {own}")),
    }
}
