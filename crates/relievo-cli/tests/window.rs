//! The viewer's window on a display without a screen (Xvfb): what it shows, and what keys, pointer, resizing and closing do.

#![cfg(target_os = "linux")]

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt as _, CreateWindowAux, EventMask,
    ImageFormat, InputFocus, PropMode, SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, WindowClass,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// A program that is killed with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A display without a screen, and its number.
fn display() -> (Running, String) {
    let mut command = Command::new("Xvfb");
    command.args(["-displayfd", "1", "-screen", "0", "1000x700x24", "-nolisten", "tcp"]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
    let mut child =
        child.expect("the suite needs Xvfb: run `scripts/setup.sh browser` (Debian: apt-get install xvfb)");
    let mut number = String::new();
    let output = child.stdout.take().expect("piped");
    BufReader::new(output).read_line(&mut number).expect("its number");
    (Running(child), format!(":{}", number.trim()))
}

/// The screen's pixels: blue, green, red and one more.
struct Screen {
    x: RustConnection,
    root: u32,
}

impl Screen {
    fn pixels(&self, [x, y, width, height]: [u16; 4]) -> Vec<u8> {
        let image =
            self.x.get_image(ImageFormat::Z_PIXMAP, self.root, x as i16, y as i16, width, height, u32::MAX);
        image.expect("asked").reply().expect("an image").data
    }

    /// Waits until a condition holds.
    fn wait(&self, what: &str, holds: impl Fn(&Self) -> bool) {
        let start = Instant::now();
        while !holds(self) {
            assert!(start.elapsed() < Duration::from_secs(60), "no {what}: see {}", self.saved());
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Saves the screen for whoever wants to know why a test fails.
    fn saved(&self) -> String {
        let [width, height] = [1000, 700];
        let bytes = self.pixels([0, 0, width, height]);
        let pixels = bytes.chunks(4).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect();
        let picture = image::RgbImage::from_raw(width.into(), height.into(), pixels).expect("whole");
        let path = relievo_testing::root().join("target/image-reports/window.png");
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
        picture.save(&path).expect("writable");
        path.display().to_string()
    }

    fn key(&self, keysym: u32) {
        let setup = self.x.setup();
        let [low, high] = [setup.min_keycode, setup.max_keycode];
        let map = self.x.get_keyboard_mapping(low, high - low + 1).expect("asked").reply().expect("a map");
        let per = usize::from(map.keysyms_per_keycode);
        let at = map.keysyms.chunks(per).position(|all| all[0] == keysym).expect("such a key");
        for kind in [2, 3] {
            self.x.xtest_fake_input(kind, low + at as u8, 0, self.root, 0, 0, 0).expect("sent");
        }
        self.x.flush().expect("sent");
    }

    fn pointer(&self, kind: u8, detail: u8, [x, y]: [i16; 2]) {
        self.x.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).expect("sent");
        self.x.flush().expect("sent");
        std::thread::sleep(Duration::from_millis(150));
    }

    fn atom(&self, name: &str) -> u32 {
        self.x.intern_atom(false, name.as_bytes()).expect("asked").reply().expect("an atom").atom
    }

    /// Drops a file onto a window as another program does (the protocol XDND).
    fn drop_file(&self, window: u32, path: &Path) {
        let source = self.x.generate_id().expect("a number");
        let (class, aux) = (WindowClass::INPUT_ONLY, CreateWindowAux::new());
        self.x.create_window(0, source, self.root, 0, 0, 1, 1, 0, class, 0, &aux).expect("asked");
        let [selection, list, copy] =
            ["XdndSelection", "text/uri-list", "XdndActionCopy"].map(|name| self.atom(name));
        self.x.set_selection_owner(source, selection, x11rb::CURRENT_TIME).expect("asked");
        let send = |name: &str, data: [u32; 4]| {
            let [a, b, c, d] = data;
            let message = ClientMessageEvent::new(32, window, self.atom(name), [source, a, b, c, d]);
            self.x.send_event(false, window, EventMask::NO_EVENT, message).expect("sent");
            self.x.flush().expect("sent");
        };
        send("XdndEnter", [5 << 24, list, 0, 0]);
        send("XdndPosition", [0, 100 << 16 | 100, 0, copy]);
        let text = format!("file://{}\r\n", path.display());
        let (status, finished) = (self.atom("XdndStatus"), self.atom("XdndFinished"));
        let start = Instant::now();
        loop {
            assert!(start.elapsed() < Duration::from_secs(30), "the window does not take the file");
            match self.x.poll_for_event().expect("connected") {
                // The window asks for the name of the file.
                Some(Event::SelectionRequest(asked)) => {
                    let (own, property) = (asked.requestor, asked.property);
                    let bytes = text.as_bytes();
                    let length = bytes.len() as u32;
                    let mode = PropMode::REPLACE;
                    self.x.change_property(mode, own, property, list, 8, length, bytes).expect("sent");
                    let notice = SelectionNotifyEvent {
                        response_type: SELECTION_NOTIFY_EVENT,
                        sequence: 0,
                        time: asked.time,
                        requestor: own,
                        selection: asked.selection,
                        target: asked.target,
                        property,
                    };
                    self.x.send_event(false, own, EventMask::NO_EVENT, notice).expect("sent");
                    self.x.flush().expect("sent");
                }
                Some(Event::ClientMessage(message)) if message.type_ == status => {
                    assert!(message.data.as_data32()[1] & 1 == 1, "the window refuses the file");
                    send("XdndDrop", [0, 0, 0, 0]);
                }
                Some(Event::ClientMessage(message)) if message.type_ == finished => return,
                Some(_) => {}
                None => std::thread::sleep(Duration::from_millis(20)),
            }
        }
    }

    /// The viewer's window.
    fn window(&self) -> Option<u32> {
        let tree = self.x.query_tree(self.root).ok()?.reply().ok()?;
        tree.children.into_iter().find(|window| {
            let name = self.x.get_property(false, *window, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64);
            let name =
                name.ok().and_then(|name| name.reply().ok()).map(|name| name.value).unwrap_or_default();
            name.starts_with(b"relievo")
        })
    }
}

/// Pixels that differ.
fn different(one: &[u8], other: &[u8]) -> usize {
    let far = |(a, b): (&[u8], &[u8])| a.iter().zip(b).take(3).any(|(a, b)| a.abs_diff(*b) > 8);
    one.chunks(4).zip(other.chunks(4)).filter(|pair| far(*pair)).count()
}

#[test]
fn the_window_shows_the_scene_and_obeys() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = r#"{
        "meshes": [{ "file": "builtin:wall", "instances": [{ "at": [0, 0, 0], "scale": 2 }] }],
        "camera": { "at": [0, 2, 6], "look": [0, 0.8, 0] }, "background": [0, 0, 1]
    }"#;
    std::fs::write(folder.path().join("scene.json"), scene).expect("written");
    let (_server, number) = display();
    let (x, screen) = x11rb::connect(Some(&number)).expect("connected");
    let root = x.setup().roots[screen].root;
    let screen = Screen { x, root };
    let settings = folder.path().join("config/relievo/viewer.json");
    let viewer = open(folder.path(), &number);
    let mut viewer = Running(viewer);

    // The background is blue, and the panel is not.
    let is_blue = |pixel: &[u8]| pixel[0] > 200 && pixel[1] < 40 && pixel[2] < 40;
    let part = [20, 20, 300, 340];
    screen.wait("picture of the scene", |screen| {
        let pixels = screen.pixels(part);
        let blue = pixels.chunks(4).filter(|pixel| is_blue(pixel)).count();
        let all = pixels.len() / 4;
        (all / 20..all - 200).contains(&blue)
    });
    let shaded = screen.pixels(part);

    // Without a window manager, nobody gives a window the keys.
    let window = screen.window().expect("the viewer's window");
    screen.x.set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME).expect("asked");
    screen.pointer(6, 0, [200, 300]);
    screen.key(u32::from(b'l'));
    screen.wait("colours by level", |screen| different(&screen.pixels(part), &shaded) > 500);
    let levels = screen.pixels(part);
    screen.pointer(4, 1, [200, 300]);
    screen.pointer(6, 0, [260, 290]);
    screen.pointer(6, 0, [300, 280]);
    screen.pointer(5, 1, [300, 280]);
    screen.wait("turned scene", |screen| different(&screen.pixels(part), &levels) > 500);

    // A file that is dropped opens: its background is green.
    let green = scene.replace("[0, 0, 1]", "[0, 1, 0]");
    std::fs::write(folder.path().join("green.json"), green).expect("written");
    screen.drop_file(window, &folder.path().join("green.json"));
    screen.key(u32::from(b'l'));
    screen.wait("dropped scene", |screen| {
        let pixels = screen.pixels(part);
        let is_green = |pixel: &&[u8]| pixel[1] > 200 && pixel[0] < 40 && pixel[2] < 40;
        pixels.chunks(4).filter(is_green).count() > pixels.len() / 4 / 20
    });
    screen.key(u32::from(b'l'));

    // A larger window has its panel elsewhere.
    let corner = [900, 500, 60, 60];
    let outside = screen.pixels(corner);
    screen.x.configure_window(window, &ConfigureWindowAux::new().width(980).height(620)).expect("asked");
    screen.x.flush().expect("sent");
    screen.wait("larger window", |screen| different(&screen.pixels(corner), &outside) > 1000);

    let [protocols, delete] = ["WM_PROTOCOLS", "WM_DELETE_WINDOW"].map(|name| screen.atom(name));
    let close = ClientMessageEvent::new(32, window, protocols, [delete, 0, 0, 0, 0]);
    screen.x.send_event(false, window, EventMask::NO_EVENT, close).expect("sent");
    screen.x.flush().expect("sent");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = viewer.0.try_wait().expect("known") {
            break status;
        }
        assert!(start.elapsed() < Duration::from_secs(30), "it does not close");
        std::thread::sleep(Duration::from_millis(50));
    };
    assert!(status.success(), "{status}");
    let settings = std::fs::read_to_string(settings).expect("remembered");
    assert!(settings.contains("\"colors\": \"levels\""), "{settings}");
}

fn open(folder: &Path, display: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_relievo"));
    command.current_dir(folder).args(["view", "scene.json", "--size", "800x500"]);
    command
        .env("DISPLAY", display)
        .env("XDG_CONFIG_HOME", folder.join("config"))
        .env_remove("WAYLAND_DISPLAY");
    command.stdin(Stdio::null()).spawn().expect("started")
}

#[test]
fn without_a_display_the_error_is_one_line() {
    let output = Command::new(env!("CARGO_BIN_EXE_relievo"))
        .arg("view")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .output()
        .expect("started");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.code() == Some(1) && error.lines().count() == 1 && error.contains("no window"),
        "{error}"
    );
}
