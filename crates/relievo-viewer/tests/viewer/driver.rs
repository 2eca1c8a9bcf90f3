//! Drives the viewer without a window: events in, pixels and the tree of widgets out.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use egui::accesskit::{Node, NodeId, Role};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, pos2, vec2};
use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::render::{Offscreen, TargetFormat};
use relievo::wgpu;
use relievo_viewer::{Request, Settings, Viewer};

pub use relievo_testing::gpu;

/// The built-in creature as a package, which needs no simplification when it is opened.
pub fn creature() -> Arc<[u8]> {
    static PACKAGE: OnceLock<Arc<[u8]>> = OnceLock::new();
    let made = || {
        let mut model = relievo_samples::creature().expect("built in");
        relievo::scene::add_levels(&mut model, &[0], 9).expect("levels");
        let watch = &mut |_| std::ops::ControlFlow::Continue(());
        relievo::ops::skinning::cook(&model.into(), watch).expect("cooked").expect("not broken off").into()
    };
    PACKAGE.get_or_init(made).clone()
}

/// A viewer and its user.
pub struct Driver {
    pub viewer: Viewer,
    size: [u32; 2],
    scale: f32,
    time: f64,
    events: Vec<Event>,
    /// The events of each frame, if they are recorded.
    pub log: Option<Vec<Vec<Event>>>,
    nodes: HashMap<String, (Role, Rect)>,
    /// The name of the widget that has the focus.
    pub focused: Option<String>,
    /// The whole window.
    target: Offscreen,
    /// Its first pixels, which are all that a frame paints: the whole panel would take most of a frame's time.
    corner: Offscreen,
    /// Whether each frame paints the whole window.
    pub paints_all: bool,
    pub requests: Vec<Request>,
    /// What the last frame said of the next one.
    pub wait: Option<Duration>,
    dark: bool,
}

/// The settings of tests: everything at its default, and dark.
pub fn settings() -> Settings {
    Settings { theme: relievo_viewer::Theme::Dark, ..Settings::default() }
}

impl Driver {
    /// A viewer in a window of so many points, with one pixel a point.
    pub fn new(size: [u32; 2]) -> Self {
        Self::with(gpu(), size, 1.0, settings())
    }

    /// The same with half a pixel a point, for windows that are high enough for all sections.
    pub fn high(size: [u32; 2]) -> Self {
        Self::with(gpu(), size, 0.5, settings())
    }

    pub fn with(gpu: Gpu, size: [u32; 2], scale: f32, settings: Settings) -> Self {
        let pixels = size.map(|edge| (edge as f32 * scale) as u32);
        let viewer = Viewer::new(gpu.clone(), FORMAT, settings);
        viewer.egui().enable_accesskit();
        Self {
            viewer,
            size,
            scale,
            time: 1.0,
            events: Vec::new(),
            log: None,
            nodes: HashMap::new(),
            focused: None,
            target: target(&gpu, pixels),
            corner: target(&gpu, [8; 2]),
            paints_all: false,
            requests: Vec::new(),
            wait: None,
            dark: true,
        }
    }

    /// Resizes the window.
    pub fn resize(&mut self, size: [u32; 2], scale: f32) {
        (self.size, self.scale) = (size, scale);
        let pixels = size.map(|edge| (edge as f32 * scale) as u32);
        [self.target, self.corner] = [pixels, [8; 2]].map(|size| target(self.viewer.gpu(), size));
    }

    /// Draws one frame, a sixtieth of a second after the last one.
    pub fn frame(&mut self) {
        self.frame_after(1.0 / 60.0).expect("painted");
    }

    pub fn frame_after(&mut self, seconds: f64) -> Result<(), relievo::Error> {
        self.time += seconds;
        if let Some(log) = &mut self.log {
            log.push(self.events.clone());
        }
        let mut input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(
                Pos2::ZERO,
                vec2(self.size[0] as f32, self.size[1] as f32),
            )),
            time: Some(self.time),
            max_texture_side: Some(8192),
            events: std::mem::take(&mut self.events),
            system_theme: Some(if self.dark { egui::Theme::Dark } else { egui::Theme::Light }),
            ..Default::default()
        };
        input.viewports.entry(egui::ViewportId::ROOT).or_default().native_pixels_per_point = Some(self.scale);
        let output = self.viewer.frame(input);
        self.wait = output.wait;
        if let Some(tree) = output.platform.accesskit_update {
            let all: HashMap<_, _> = tree.nodes.iter().map(|(id, node)| (*id, node)).collect();
            // Of widgets with the same name, the highest one: legends of plots repeat names of controls.
            let mut widgets: Vec<_> = all.values().filter_map(|node| named(node, &all)).collect();
            widgets.sort_by(|(_, (_, one)), (_, (_, other))| other.top().total_cmp(&one.top()));
            self.nodes = widgets.into_iter().collect();
            self.focused = all.get(&tree.focus).and_then(|node| named(node, &all)).map(|(name, _)| name);
        }
        let target = if self.paints_all { &self.target } else { &self.corner };
        let painted = paint(&mut self.viewer, target);
        self.viewer.gpu().wait()?;
        self.requests.extend(self.viewer.requests());
        painted
    }

    /// The events of what a user does, frame by frame.
    #[allow(dead_code, reason = "the suite of the page records")]
    pub fn recorded(&mut self, act: impl FnOnce(&mut Self)) -> Vec<Vec<Event>> {
        self.log = Some(Vec::new());
        act(self);
        self.log.take().unwrap_or_default()
    }

    /// Draws so many frames.
    pub fn frames(&mut self, count: usize) {
        (0..count).for_each(|_| self.frame());
    }

    /// Draws frames until nothing is loaded any more, and the panel stands still.
    pub fn settle(&mut self) {
        let start = Instant::now();
        self.frame();
        while self.viewer.step().is_some() {
            assert!(start.elapsed() < Duration::from_secs(120), "{:?}", self.viewer.step());
            std::thread::sleep(Duration::from_millis(20));
            self.frame();
        }
        self.frames(8);
    }

    /// Presses a button of the experiment, and waits until it has ended.
    pub fn experiment(&mut self, button: &str, most: Duration) {
        let start = Instant::now();
        self.click(button);
        while self.find("Run").is_none() {
            assert!(start.elapsed() < most, "it does not end");
            std::thread::sleep(Duration::from_millis(50));
            self.frame();
        }
        self.frames(5);
        println!("the experiment took {:.0} s", start.elapsed().as_secs_f64());
    }

    /// Opens a file, and waits until it is there.
    pub fn open(&mut self, path: &Path) {
        self.viewer.open_address(&path.to_string_lossy());
        self.settle();
    }

    /// Where a widget is; its name may end in something that changes.
    pub fn find(&self, name: &str) -> Option<Rect> {
        self.nodes.get(name).map(|(_, rect)| *rect)
    }

    pub fn rect(&self, name: &str) -> Rect {
        let mut names: Vec<_> = self.nodes.keys().collect();
        names.sort();
        self.find(name).unwrap_or_else(|| panic!("no widget `{name}` among {names:?}"))
    }

    /// Moves the pointer, and draws a frame.
    pub fn hover(&mut self, at: Pos2) {
        self.events.push(Event::PointerMoved(at));
        self.frame();
    }

    pub fn press(&mut self, at: Pos2, button: PointerButton, pressed: bool) {
        self.events.push(Event::PointerMoved(at));
        self.events.push(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
        self.frame();
    }

    /// Clicks on a widget.
    pub fn click(&mut self, name: &str) {
        // Sections that fold move what is below them.
        let mut at = self.rect(name).center();
        for _ in 0..40 {
            self.frame();
            let now = self.rect(name).center();
            if std::mem::replace(&mut at, now) == now {
                break;
            }
        }
        self.click_at(at);
    }

    pub fn click_at(&mut self, at: Pos2) {
        self.hover(at);
        self.press(at, PointerButton::Primary, true);
        self.press(at, PointerButton::Primary, false);
        self.frames(5);
    }

    /// Drags the pointer.
    pub fn drag(&mut self, from: Pos2, to: Pos2, button: PointerButton) {
        self.hover(from);
        self.press(from, button, true);
        for step in 1..=3 {
            self.hover(from.lerp(to, step as f32 / 3.0));
        }
        self.press(to, button, false);
        self.frames(2);
    }

    /// Drags the handle of a slider to a fraction of its way.
    pub fn slide(&mut self, name: &str, part: f32) {
        let rect = self.rect(name);
        // A slider's number and name are to the right of its rail, whose ends keep half of the handle.
        let (half, rail) = (4.0, 120.0);
        let at = |part: f32| pos2(rect.left() + half + part * (rail - 2.0 * half), rect.center().y);
        self.drag(at(0.5), at(part), PointerButton::Primary);
        self.frames(2);
    }

    /// Chooses an entry of a list that folds out.
    pub fn choose(&mut self, list: &str, entry: &str) {
        self.click(list);
        self.click(entry);
    }

    pub fn key(&mut self, key: Key) {
        self.key_with(key, Modifiers::NONE);
    }

    pub fn key_with(&mut self, key: Key, modifiers: Modifiers) {
        for pressed in [true, false] {
            self.events.push(Event::ModifiersChanged(modifiers));
            self.events.push(Event::Key { key, physical_key: Some(key), pressed, repeat: false, modifiers });
            self.frame();
        }
        self.events.push(Event::ModifiersChanged(Modifiers::NONE));
        self.frames(3);
    }

    /// Holds a key for some frames.
    pub fn hold(&mut self, key: Key, frames: usize) {
        for pressed in [true, false] {
            let modifiers = Modifiers::NONE;
            self.events.push(Event::Key { key, physical_key: Some(key), pressed, repeat: false, modifiers });
            self.frames(if pressed { frames } else { 2 });
        }
    }

    /// Writes text into the widget that has the focus.
    pub fn write(&mut self, text: &str) {
        self.events.push(Event::Text(text.to_owned()));
        self.frames(2);
    }

    pub fn event(&mut self, event: Event) {
        self.events.push(event);
    }

    /// The whole window, which is painted for it.
    pub fn window(&mut self) -> RgbaImage {
        paint(&mut self.viewer, &self.target).expect("painted");
        let gpu = self.viewer.gpu();
        let bytes = gpu.block_on(self.target.read_color(gpu, 0, FORMAT)).expect("read");
        let [width, height] = self.target.size();
        RgbaImage::from_raw(width, height, bytes).expect("whole")
    }

    /// The picture of the scene, cut out of the window.
    pub fn picture(&mut self) -> RgbaImage {
        let rect = self.rect("picture") * self.scale;
        let [x, y, width, height] =
            [rect.left(), rect.top(), rect.width(), rect.height()].map(|edge| edge as u32);
        image::imageops::crop_imm(&self.window(), x, y, width, height).to_image()
    }

    /// The point of the window in the middle of a pixel of the picture.
    pub fn point(&self, x: u32, y: u32) -> Pos2 {
        self.rect("picture").min + vec2(x as f32 + 0.5, y as f32 + 0.5) / self.scale
    }

    /// Saves the window for whoever wants to look at it.
    pub fn save(&mut self, name: &str) {
        let folder = relievo_testing::root().join("target/viewer");
        std::fs::create_dir_all(&folder).expect("writable");
        self.window().save(folder.join(format!("{name}.png"))).expect("writable");
    }

    pub fn shown(&self) -> &relievo_viewer::Shown {
        self.viewer.shown().expect("a scene is shown")
    }

    /// Triangles in view, some frames later.
    pub fn triangles(&mut self) -> f64 {
        self.frames(7);
        self.viewer.history().last().expect("a frame").triangles
    }
}

/// The name of a widget, and what and where it is.
fn named(node: &Node, all: &HashMap<NodeId, &Node>) -> Option<(String, (Role, Rect))> {
    let bounds = node.bounds()?;
    let by = node.labelled_by().first().and_then(|by| all.get(by)).and_then(|by| by.label().or(by.value()));
    let name = by.or(node.label()).or(node.value()).filter(|name| !name.is_empty());
    // The field for an address has no name before something is in it.
    let name = match node.role() {
        Role::TextInput => "text".to_owned(),
        _ => name?.to_owned(),
    };
    let [low, high] = [pos2(bounds.x0 as f32, bounds.y0 as f32), pos2(bounds.x1 as f32, bounds.y1 as f32)];
    // The text beside a widget has its name, too.
    let is_text = matches!(node.role(), Role::Label | Role::SpinButton | Role::TextRun);
    (!is_text).then(|| (name, (node.role(), Rect::from_min_max(low, high))))
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

fn target(gpu: &Gpu, size: [u32; 2]) -> Offscreen {
    Offscreen::with_format(gpu, size, TargetFormat::new(FORMAT)).expect("a target")
}

fn paint(viewer: &mut Viewer, target: &Offscreen) -> Result<(), relievo::Error> {
    let view = target.color(0).expect("a colour").create_view(&wgpu::TextureViewDescriptor::default());
    viewer.paint(&view, target.size())
}

/// The number of pixels that differ by more than some levels.
pub fn different(one: &RgbaImage, other: &RgbaImage) -> usize {
    assert_eq!(one.dimensions(), other.dimensions());
    let far = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 6);
    one.pixels().zip(other.pixels()).filter(|(a, b)| far(a, b)).count()
}
