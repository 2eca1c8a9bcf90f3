//! The viewer, without a window: it takes input, shows the panel and the picture, and draws both into a texture of its host.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use egui_wgpu::{RendererOptions, ScreenDescriptor};
use relievo::asset::encode_png;
use relievo::gpu::{Gpu, GpuError};
use relievo::render::Offscreen;
use relievo::{Error, InputError};
use relievo_lab::measure::DistanceSweepReport;
use web_time::Instant;

use crate::experiment::Experiment;
use crate::eye::Eye;
use crate::history::{History, Sample};
use crate::images;
use crate::load::{Arrival, Changed, Job, News, Ready, Task};
use crate::settings::Settings;
use crate::shown::{Clock, Shown};
use crate::source::{Locate, Memory, Source, locate};
use crate::stage::{Colors, Stage};
use crate::start::Start;
use crate::streaming::Streaming;
use crate::wires::Wires;
use crate::{panel, theme};

/// Seconds without input after which nothing is drawn any more, unless the camera follows a path.
const REST: f64 = 60.0;

/// Largest number of frames that the device has not finished.
const IN_FLIGHT: u32 = 2;

/// Number of frames after a change: the device tells only some frames later what it drew.
const TOLD: u32 = 8;

/// How long the status line says what was done, in seconds.
const SAID: f64 = 4.0;

/// Longest step of the scene's time, in seconds.
const LONGEST: f64 = 0.25;

/// What the host does for the viewer.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// Saves a file.
    Save {
        /// The name that the file should have.
        name: String,
        /// The content.
        bytes: Vec<u8>,
    },
    /// Puts text on the clipboard.
    Copy(String),
    /// Remembers the settings.
    Remember(Settings),
}

/// What a frame of the viewer asks of its host.
pub struct Output {
    /// Cursor, clipboard and the like.
    pub platform: egui::PlatformOutput,
    /// The time until the next frame; `None` if it may wait for input.
    pub wait: Option<Duration>,
}

/// What is loaded, and why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// A file was opened.
    Open,
    /// The scene has to be built anew.
    Rebuild,
    /// The scene is compared with full detail.
    Compare,
}

/// What is loaded at present.
struct Loading {
    task: Task,
    purpose: Purpose,
    name: String,
    /// What somebody wrote to open it.
    address: Option<String>,
    step: String,
    /// Whether the device is busy with it.
    builds: bool,
    began: Instant,
    /// Number of transfers that had ended before.
    arrivals: usize,
}

/// Paints what egui has laid out.
struct Painter {
    renderer: egui_wgpu::Renderer,
    format: wgpu::TextureFormat,
    /// The pictures of the scene, and of the same in full detail.
    pictures: [Option<egui::TextureId>; 2],
    /// The colours of these pictures.
    colors: [Option<Colors>; 2],
    primitives: Vec<egui::ClippedPrimitive>,
    /// Textures of egui to write before the next frame, and to free after it.
    written: Vec<(egui::TextureId, egui::epaint::ImageDelta)>,
    freed: Vec<egui::TextureId>,
    pixels_per_point: f32,
}

impl Painter {
    fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let options = RendererOptions { dithering: false, ..RendererOptions::default() };
        Self {
            renderer: egui_wgpu::Renderer::new(gpu.device(), format, options),
            format,
            pictures: [None; 2],
            colors: [None; 2],
            primitives: Vec::new(),
            written: Vec::new(),
            freed: Vec::new(),
            pixels_per_point: 1.0,
        }
    }
}

/// The picture on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Picture {
    /// Where it is, in points.
    pub rect: egui::Rect,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// The viewer.
///
/// A host feeds it with input ([`Viewer::frame`]), lets it draw ([`Viewer::paint`]), and does what it asks for
/// ([`Viewer::requests`]).
pub struct Viewer {
    gpu: Gpu,
    egui: egui::Context,
    painter: Painter,
    pub(crate) settings: Settings,
    remembered: Settings,
    pub(crate) shown: Option<Shown>,
    loading: Option<Loading>,
    start: Start,
    /// A message to the user: what is wrong with what was opened or set.
    pub(crate) notice: Option<String>,
    pub(crate) history: History,
    pub(crate) arrivals: Vec<Arrival>,
    pub(crate) experiment: Experiment,
    /// Bytes and seconds until the first picture.
    pub(crate) first_picture: Option<(usize, f64)>,
    pub(crate) picture: Option<Picture>,
    /// The edges that were painted last.
    pub(crate) wires: Wires,
    /// The place of the wiper between full detail and the present one, as a fraction of the picture's width.
    pub(crate) wiper: f32,
    /// Whether the scene is compared with full detail.
    pub(crate) compares: bool,
    pub(crate) bookmarks: [Option<Eye>; 9],
    /// The text in the field for a name.
    pub(crate) address: String,
    /// Whether the list of keys is shown.
    pub(crate) shows_keys: bool,
    /// One step of time is due while the time stands still.
    pub(crate) steps: bool,
    to_host: Sender<Request>,
    from_viewer: Receiver<Request>,
    /// The time of the host's last frame, and of its last input, in seconds.
    now: f64,
    /// What was done last, and until when the status line says so.
    said: Option<(String, f64)>,
    last_input: f64,
    is_resting: bool,
    /// Frames that are still due after the last change.
    due: u32,
    began: Instant,
    last_paint: Option<Instant>,
    in_flight: Arc<AtomicU32>,
    /// Milliseconds from the submission of the last frame until the device was done, as bits.
    device_time: Arc<AtomicU32>,
    wants_picture: bool,
    locate: Locate,
}

impl Viewer {
    /// A viewer on a device, for targets of this format, which should not convert to sRGB by itself.
    pub fn new(gpu: Gpu, format: wgpu::TextureFormat, settings: Settings) -> Self {
        images::register();
        let egui = egui::Context::default();
        theme::dress(&egui, settings.theme);
        let (to_host, from_viewer) = channel();
        Self {
            painter: Painter::new(&gpu, format),
            gpu,
            egui,
            remembered: settings.clone(),
            settings,
            shown: None,
            loading: None,
            start: Start::default(),
            notice: None,
            history: History::default(),
            arrivals: Vec::new(),
            experiment: Experiment::default(),
            first_picture: None,
            picture: None,
            wires: Wires::default(),
            wiper: 0.5,
            compares: false,
            bookmarks: [None; 9],
            address: String::new(),
            shows_keys: false,
            steps: false,
            to_host,
            from_viewer,
            now: 0.0,
            last_input: 0.0,
            is_resting: false,
            due: TOLD,
            said: None,
            began: Instant::now(),
            last_paint: None,
            in_flight: Arc::default(),
            device_time: Arc::default(),
            wants_picture: false,
            locate,
        }
    }

    /// Lets the viewer find files in another way than by [`locate`].
    #[must_use]
    pub fn with_locate(self, locate: Locate) -> Self {
        Self { locate, ..self }
    }

    /// The context of the panel, for hosts that feed it.
    pub fn egui(&self) -> &egui::Context {
        &self.egui
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The scene that is shown.
    pub fn shown(&self) -> Option<&Shown> {
        self.shown.as_ref()
    }

    /// The message to the user, if there is one.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// Tells the user something, until it is closed.
    pub fn tell(&mut self, what: String) {
        self.notice = Some(what);
    }

    /// What the last frames cost and drew.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The settings as they are now.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What is loaded at present, if anything.
    pub fn step(&self) -> Option<&str> {
        self.loading.as_ref().map(|loading| loading.step.as_str())
    }

    /// Files that arrived, the first one first.
    pub fn arrivals(&self) -> &[Arrival] {
        &self.arrivals
    }

    /// Width and height of the picture in pixels, once a frame was laid out.
    pub fn picture_size(&self) -> Option<[u32; 2]> {
        Some(self.picture?.size)
    }

    /// The edges of triangles that were painted last.
    pub fn wires(&self) -> &Wires {
        &self.wires
    }

    /// Bytes that had arrived at the first picture, and the seconds until then.
    pub fn first_picture(&self) -> Option<(usize, f64)> {
        self.first_picture
    }

    /// Whether the scene is compared with full detail, and both are there.
    pub fn compares(&self) -> bool {
        self.compares && self.shown.as_ref().is_some_and(|shown| shown.full.is_some())
    }

    /// Opens what a start asks for, or the scene that the viewer brings along.
    pub fn begin(&mut self, start: Start) {
        if let Some(colors) = start.colors {
            self.settings.colors = colors;
        }
        let address = start.scene.clone();
        self.start = start;
        match address {
            Some(address) => self.open_address(&address),
            None => self.open_example(0),
        }
    }

    /// Opens a file of a source. The scene that is shown stays until the other one is there, or for good if the file cannot be
    /// shown.
    pub fn open(&mut self, name: &str, source: Arc<dyn Source>) {
        self.notice = None;
        self.load(Purpose::Open, PathBuf::from(name), source, None);
    }

    /// Opens a file by its address: a path, natively, or an address of a site, in a page.
    pub fn open_address(&mut self, address: &str) {
        match (self.locate)(address) {
            Ok((name, source)) => {
                self.open(&name, source);
                if let Some(loading) = &mut self.loading {
                    loading.address = Some(address.to_owned());
                }
            }
            Err(error) => self.notice = Some(error.to_string()),
        }
    }

    /// Opens one of the scenes that the viewer brings along.
    pub(crate) fn open_example(&mut self, number: usize) {
        let (name, text, _) = panel::EXAMPLES[number];
        // A page has the creature as a package beside it.
        #[cfg(target_arch = "wasm32")]
        if let Some(url) = crate::web::absolute(name) {
            let (own, page) = (Memory::default().with(name, text.as_bytes()), crate::source::Site { url });
            return self.open(name, Arc::new(crate::source::Bundled { own, page }));
        }
        let text = text.replace("creature.rlv", "builtin:creature");
        self.open(name, Arc::new(Memory::default().with(name, text.into_bytes())));
    }

    /// Opens files that were dropped: the first one that can be shown, with the others beside it.
    pub fn drop_files(&mut self, files: Vec<(String, Arc<[u8]>)>) {
        let rank = |name: &str| {
            let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
            match ending.as_deref() {
                Some("json") => 0,
                Some("rlv" | "glb" | "gltf" | "obj") => 1,
                _ => 2,
            }
        };
        let Some(first) = files.iter().map(|(name, _)| name.clone()).min_by_key(|name| rank(name)) else {
            return;
        };
        let memory = files.into_iter().fold(Memory::default(), |all, (name, bytes)| all.with(name, bytes));
        self.open(&first, Arc::new(memory));
    }

    fn load(&mut self, purpose: Purpose, name: PathBuf, source: Arc<dyn Source>, changed: Option<Changed>) {
        let shown = name.display().to_string();
        let fetching = match (purpose, &mut self.shown) {
            (Purpose::Rebuild, Some(shown)) => shown.streaming.take().map(Streaming::into_fetching),
            _ => None,
        };
        let job =
            Job { gpu: self.gpu.clone(), name, source, rate: self.settings.throttle, changed, fetching };
        let egui = self.egui.clone();
        let task = Task::start(job, move || egui.request_repaint());
        let (step, began, arrivals) = ("starting".to_owned(), Instant::now(), self.arrivals.len());
        self.loading =
            Some(Loading { task, purpose, name: shown, address: None, step, builds: false, began, arrivals });
    }

    /// What the host has to do, once each.
    pub fn requests(&mut self) -> Vec<Request> {
        if self.settings != self.remembered {
            self.remembered = self.settings.clone();
            let _ = self.to_host.send(Request::Remember(self.settings.clone()));
        }
        self.from_viewer.try_iter().collect()
    }

    pub(crate) fn request(&self, request: Request) {
        // The receiver is the viewer's own.
        let _ = self.to_host.send(request);
    }

    /// Takes input, and lays out the next frame.
    pub fn frame(&mut self, input: egui::RawInput) -> Output {
        let seconds = self.tick(&input);
        self.update_loading();
        self.experiment.update();
        #[cfg(not(target_arch = "wasm32"))]
        if self.is_streaming() {
            let gpu = self.gpu.clone();
            if let Err(error) = gpu.block_on(self.stream()) {
                self.notice = Some(error.to_string());
            }
        }
        if let Err(error) = self.advance(seconds) {
            self.notice = Some(error.to_string());
        }
        let egui = self.egui.clone();
        let full = egui.run_ui(input, |ui| panel::show(self, ui));
        self.change_scene();
        self.painter.pixels_per_point = full.pixels_per_point;
        self.painter.primitives = egui.tessellate(full.shapes, full.pixels_per_point);
        let mut textures = full.textures_delta;
        let written =
            textures.set.drain().flat_map(|(id, deltas)| deltas.into_iter().map(move |delta| (id, delta)));
        self.painter.written.extend(written);
        self.painter.freed.extend(textures.free.drain());
        let repaint = full.viewport_output.values().map(|output| output.repaint_delay).min();
        let wait = self.wait(repaint.unwrap_or(Duration::MAX));
        Output { platform: full.platform_output, wait }
    }

    /// Whether the scene comes from a site, level by level, and something may still come.
    pub fn is_streaming(&self) -> bool {
        let has_streaming = self.shown.as_ref().is_some_and(|shown| shown.streaming.is_some());
        has_streaming && !self.is_resting && !self.is_leaving()
    }

    /// Shows what has arrived of a scene of a site. [`Viewer::frame`] calls it natively. A page calls it between frames, because a
    /// browser tells errors of the device later.
    ///
    /// # Errors
    /// [`Error`] for packages that do not suit the scene, and of the device.
    pub async fn stream(&mut self) -> Result<(), Error> {
        let Self { shown: Some(shown), settings, arrivals, due, .. } = self else { return Ok(()) };
        let before = arrivals.len();
        let done = shown.stream(settings.throttle).await;
        if let Some(streaming) = &mut shown.streaming {
            arrivals.extend(streaming.arrivals());
            *due = if arrivals.len() > before { TOLD } else { *due };
            if let Some(why) = streaming.failures().into_iter().next() {
                self.notice = Some(why);
            }
        }
        done
    }

    /// Number of bytes that arrived since the scene was opened, used or not.
    pub fn bytes(&self) -> usize {
        let ended: usize = self.arrivals.iter().map(|arrival| arrival.bytes).sum();
        let streaming = self.shown.iter().flat_map(|shown| &shown.streaming);
        ended + streaming.flat_map(Streaming::asked).map(|asked| asked.bytes).sum::<usize>()
    }

    /// The seconds since the last frame.
    fn tick(&mut self, input: &egui::RawInput) -> f64 {
        let now = input.time.unwrap_or(self.now + f64::from(input.predicted_dt));
        let seconds = (now - self.now).clamp(0.0, LONGEST);
        self.now = now;
        let is_input = !input.events.is_empty() || !input.dropped_files.is_empty();
        self.due = self.due.saturating_sub(1);
        if is_input || self.last_input == 0.0 {
            (self.last_input, self.due) = (now, TOLD);
        }
        // A server that does not answer is asked again, though nobody is there.
        let is_whole =
            self.shown.as_ref().is_none_or(|shown| shown.stage.ready() == 1.0 && !shown.is_streaming());
        self.is_resting = now - self.last_input > REST && !self.is_on_path() && is_whole;
        seconds
    }

    fn is_on_path(&self) -> bool {
        self.shown
            .as_ref()
            .is_some_and(|shown| shown.clock.plays && shown.clock.follows && shown.time() < shown.path_end())
    }

    /// Whether the device builds another scene, which takes the place of this one.
    fn is_leaving(&self) -> bool {
        self.loading.as_ref().is_some_and(|loading| loading.purpose == Purpose::Open && loading.builds)
    }

    /// Lets the status line say for some seconds what the host has done.
    pub fn say(&mut self, said: impl Into<String>) {
        self.said = Some((said.into(), self.now + SAID));
        self.egui.request_repaint();
    }

    /// What the viewer did last, for some seconds.
    pub(crate) fn said(&self) -> Option<&str> {
        self.said.as_ref().filter(|(_, end)| self.now < *end).map(|(said, _)| said.as_str())
    }

    /// Whether the viewer draws nothing because nobody is there.
    pub fn is_resting(&self) -> bool {
        self.is_resting
    }

    /// The time until the next frame.
    fn wait(&self, repaint: Duration) -> Option<Duration> {
        let said = self.said.as_ref().map(|(_, end)| end - self.now).filter(|left| *left > 0.0);
        let repaint = repaint.min(said.map_or(Duration::MAX, Duration::from_secs_f64));
        let Some(shown) = &self.shown else {
            let waits = self.loading.is_some().then_some(Duration::from_millis(50));
            return if repaint < Duration::MAX { Some(repaint) } else { waits };
        };
        if self.is_resting {
            return None;
        }
        if self.is_leaving() {
            return Some(repaint.min(Duration::from_millis(50)));
        }
        let is_moving = shown.is_moving() && !self.experiment.is_running();
        if is_moving || shown.stage.ready() < 1.0 || self.steps || self.wants_picture || self.due > 0 {
            return Some(Duration::ZERO);
        }
        if let (Some((_, seconds)), None) = (shown.waits(), &self.loading) {
            return Some(repaint.min(Duration::from_secs_f64(seconds.clamp(0.05, 1.0))));
        }
        if self.loading.is_some() || self.experiment.is_running() || shown.is_streaming() {
            return Some(repaint.min(Duration::from_millis(50)));
        }
        (repaint < Duration::MAX).then_some(repaint)
    }

    /// Takes what the task that loads has told.
    fn update_loading(&mut self) {
        while let Some(loading) = &mut self.loading {
            let Some(news) = loading.task.next() else { return };
            match news {
                News::Step(step) => loading.step = step,
                News::Building => loading.builds = true,
                News::Arrived(arrival) => self.arrivals.push(arrival),
                News::Failed(why) => {
                    if loading.purpose == Purpose::Compare {
                        self.compares = false;
                    }
                    (self.notice, self.loading) = (Some(why), None);
                }
                News::Ready(ready) => {
                    let (purpose, name) = (loading.purpose, loading.name.clone());
                    if let Some(address) = loading.address.take() {
                        self.settings.opened(&address);
                    }
                    if purpose == Purpose::Open && self.shown.is_some() {
                        // Numbers of the scene before count no more.
                        (self.began, self.first_picture) = (loading.began, None);
                        self.arrivals.drain(..loading.arrivals);
                    }
                    self.loading = None;
                    if let Err(error) = self.take(purpose, name, *ready) {
                        self.notice = Some(error.to_string());
                    }
                }
            }
        }
    }

    /// Takes a scene that is ready.
    fn take(&mut self, purpose: Purpose, name: String, ready: Ready) -> Result<(), Error> {
        self.due = TOLD;
        match (purpose, &mut self.shown) {
            (Purpose::Rebuild, Some(shown)) => shown.rebuilt(ready)?,
            (Purpose::Compare, Some(shown)) => shown.compare(ready)?,
            _ => {
                let mut shown = Shown::new(name, ready)?;
                std::mem::take(&mut self.start).apply(&mut shown);
                self.history = History::default();
                self.compares = false;
                self.shown = Some(shown);
            }
        }
        Ok(())
    }

    /// Moves the scene in time.
    fn advance(&mut self, seconds: f64) -> Result<(), InputError> {
        let Some(shown) = &mut self.shown else { return Ok(()) };
        let is_still = self.is_resting || self.experiment.is_running();
        if std::mem::take(&mut self.steps) {
            shown.advance(1.0 / 60.0)?;
        } else if shown.clock.plays && !is_still {
            shown.advance(seconds as f32 * shown.clock.speed)?;
        }
        Ok(())
    }

    /// Follows controls that need another scene on the device.
    fn change_scene(&mut self) {
        let Some(shown) = &mut self.shown else { return };
        if let Err(error) = shown.apply() {
            self.notice = Some(error.to_string());
        }
        if let (true, Some(Picture { size, .. }), None) = (self.settings.bones, self.picture, &shown.chosen)
            && let Err(error) = shown.choose_nearest(size)
        {
            self.notice = Some(error.to_string());
        }
        if self.loading.is_some() || self.egui.input(|input| input.pointer.any_down()) {
            return;
        }
        let known = shown.known.clone();
        let (name, source) = (PathBuf::from(&shown.name), shown.source.clone());
        if let Some(document) = shown.regated() {
            self.load(Purpose::Rebuild, name, source, Some(Changed { document, known }));
        } else if self.compares && shown.full.is_none() {
            // Full detail needs whole packages; what is there of them is not fetched again.
            if shown.streaming.as_mut().is_some_and(|streaming| !streaming.fetch_all()) {
                return;
            }
            let mut document = shown.document.clone();
            let mut known = known;
            known.add_files(shown.streaming.iter().flat_map(Streaming::whole));
            document.set_characters("gate", Some(&serde_json::json!("off")));
            document.set_characters("influences", Some(&serde_json::json!({ "most": 8 })));
            document.set_characters("tiers", None);
            self.load(Purpose::Compare, name, source, Some(Changed { document, known }));
        } else if !self.compares {
            shown.full = None;
        }
    }

    /// The identifier of a picture for the panel: of the scene, or of the same in full detail.
    pub(crate) fn texture(&self, is_full: bool) -> Option<egui::TextureId> {
        self.painter.pictures[usize::from(is_full)]
    }

    /// Asks for a picture of the scene as a file.
    pub(crate) fn save_picture(&mut self) {
        self.wants_picture = true;
    }

    /// Draws the last frame into a texture of so many pixels.
    ///
    /// # Errors
    /// [`GpuError::DeviceLost`] if the device is lost: give the viewer another one ([`Viewer::rebuild`]). Other errors of the
    /// device.
    pub fn paint(&mut self, target: &wgpu::TextureView, size: [u32; 2]) -> Result<(), Error> {
        self.gpu.check()?;
        let start = Instant::now();
        let mut encoder = self.gpu.encoder("viewer");
        let is_drawn = self.record_scene(&mut encoder)?;
        let record = milliseconds(start);
        self.paint_panel(&mut encoder, target, size);
        let gpu = self.gpu.clone();
        gpu.scoped(|| gpu.queue().submit([encoder.finish()]))?;
        if is_drawn {
            self.time_device();
            self.count(record)?;
        }
        if std::mem::take(&mut self.wants_picture) {
            self.read_picture()?;
        }
        Ok(())
    }

    /// Records the scene, if there is one and the device is not too far behind. Returns whether it was recorded.
    fn record_scene(&mut self, encoder: &mut wgpu::CommandEncoder) -> Result<bool, Error> {
        #[cfg(not(target_arch = "wasm32"))]
        let _ = self.gpu.device().poll(wgpu::PollType::Poll);
        let is_leaving = self.is_leaving();
        let (Some(shown), Some(Picture { size, .. })) = (&mut self.shown, self.picture) else {
            return Ok(false);
        };
        // A scene that is about to go leaves the device to the next one, unless its picture gets another size.
        let is_whole = |target: &Offscreen| target.size() == size;
        if is_leaving && shown.stage.target(self.settings.colors).is_some_and(is_whole) {
            return Ok(false);
        }
        if self.is_resting || self.in_flight.load(Ordering::Acquire) >= IN_FLIGHT {
            return Ok(false);
        }
        let colors = self.settings.colors;
        let stages = [Some(&mut shown.stage), shown.full.as_mut()];
        let Painter { renderer, pictures, colors: shown_colors, .. } = &mut self.painter;
        for ((stage, picture), last) in stages.into_iter().zip(pictures).zip(shown_colors) {
            let Some(stage) = stage else { continue };
            if stage.resize(size, colors)? || last.replace(colors) != Some(colors) {
                show(renderer, stage, colors, picture);
            }
        }
        shown.record(encoder, size, colors)?;
        Ok(true)
    }

    fn paint_panel(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        size: [u32; 2],
    ) {
        let Painter { renderer, primitives, written, freed, pixels_per_point, .. } = &mut self.painter;
        let (device, queue) = (self.gpu.device(), self.gpu.queue());
        for (id, delta) in written.drain(..) {
            renderer.update_texture(device, queue, id, &delta);
        }
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point: *pixels_per_point };
        renderer.update_buffers(device, queue, encoder, primitives, &screen);
        let background = self.egui.global_style().visuals.panel_fill;
        let [r, g, b] =
            [background.r(), background.g(), background.b()].map(|channel| f64::from(channel) / 255.0);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("panel"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        renderer.render(&mut pass.forget_lifetime(), primitives, &screen);
        freed.drain(..).for_each(|id| renderer.free_texture(&id));
    }

    /// Measures when the device has done what was submitted.
    fn time_device(&mut self) {
        self.in_flight.fetch_add(1, Ordering::AcqRel);
        let (in_flight, time, start) = (self.in_flight.clone(), self.device_time.clone(), Instant::now());
        let egui = self.egui.clone();
        self.gpu.queue().on_submitted_work_done(move || {
            time.store((milliseconds(start) as f32).to_bits(), Ordering::Release);
            if in_flight.fetch_sub(1, Ordering::AcqRel) == IN_FLIGHT {
                egui.request_repaint();
            }
        });
    }

    /// Remembers what the frame cost and drew.
    fn count(&mut self, record: f64) -> Result<(), Error> {
        let Some(shown) = &mut self.shown else { return Ok(()) };
        let now = Instant::now();
        let frame =
            self.last_paint.replace(now).map_or(0.0, |last| 1e3 * now.duration_since(last).as_secs_f64());
        let device = f32::from_bits(self.device_time.load(Ordering::Acquire));
        shown.stage.view_mut().frame_took(device.max(record as f32))?;
        let bytes = self.bytes();
        let Some(shown) = &mut self.shown else { return Ok(()) };
        if self.first_picture.is_none() {
            self.first_picture = Some((bytes, self.began.elapsed().as_secs_f64()));
        }
        let device = (device > 0.0).then_some(f64::from(device));
        self.history.add(Sample { frame, record, device, bytes: bytes as f64, ..shown.sample() });
        Ok(())
    }

    /// Reads the picture of the scene back, and asks the host to save it.
    fn read_picture(&mut self) -> Result<(), Error> {
        let Some(shown) = &self.shown else { return Ok(()) };
        let Some(target) = shown.stage.target(self.settings.colors).cloned() else { return Ok(()) };
        let name = Path::new(&shown.name).file_stem().map_or("picture".into(), |stem| stem.to_string_lossy());
        let (name, gpu, to_host) = (format!("{name}.png"), self.gpu.clone(), self.to_host.clone());
        let egui = self.egui.clone();
        let read = async move {
            let picture = target.read_async(&gpu).await?;
            let size = [picture.width(), picture.height()];
            let encoded = encode_png(size, &picture, image::ExtendedColorType::Rgba8);
            let bytes = encoded.map_err(|error| Error::output(&name, error))?;
            let _ = to_host.send(Request::Save { name, bytes });
            egui.request_repaint();
            Ok::<(), Error>(())
        };
        #[cfg(not(target_arch = "wasm32"))]
        self.gpu.block_on(read)?;
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(async move { _ = read.await });
        Ok(())
    }

    /// The scene file as the scene is now, as text.
    pub fn scene_text(&mut self) -> Option<String> {
        Some(self.shown.as_mut()?.document().text())
    }

    /// What all controls say, as JSON: the scene file as the scene is now, and what is not in a scene file.
    pub fn controls(&mut self) -> serde_json::Value {
        let Some(shown) = &mut self.shown else { return serde_json::Value::Null };
        let Clock { plays, speed, follows } = shown.clock;
        serde_json::json!({
            "scene": shown.document().value(),
            "settings": self.settings,
            "time": shown.time(),
            "plays": plays,
            "speed": speed,
            "follows": follows,
            "exposure": shown.exposure,
            "compares": self.compares,
            "wiper": self.wiper,
            "bookmarks": self.bookmarks.iter().flatten().count(),
            "keys": self.shows_keys,
        })
    }

    /// Asks the host to save the scene file as the scene is now.
    pub(crate) fn save_scene(&mut self) {
        let Some(shown) = &mut self.shown else { return };
        let stem = Path::new(&shown.name).file_stem().map_or("scene".into(), |stem| stem.to_string_lossy());
        let name = format!("{stem}-view.json");
        // Beside the saved file, there are no files of a site.
        let source = shown.source.clone();
        let is_own = |name: &str| !name.starts_with("builtin:") && !crate::source::is_address(name);
        let address = |_: &str, name: &str| source.url(Path::new(name)).filter(|_| is_own(name));
        let bytes = shown.document().renamed(address).text().into_bytes();
        self.request(Request::Save { name, bytes });
    }

    /// What opens the viewer with this picture: a command, natively, or the address of the page.
    pub(crate) fn command(&self) -> Option<String> {
        let shown = self.shown.as_ref()?;
        let address = self.settings.recent.first().filter(|address| address.ends_with(&shown.name));
        let scene = address.unwrap_or(&shown.name).clone();
        let start = Start::of(scene, shown, self.settings.colors);
        #[cfg(target_arch = "wasm32")]
        return Some(format!("{}?{}", crate::web::address(), start.query()));
        #[cfg(not(target_arch = "wasm32"))]
        Some(start.command(self.picture?.size))
    }

    /// Whether the experiment of thesis A runs.
    pub fn is_measuring(&self) -> bool {
        self.experiment.is_running()
    }

    /// Number of measurements of the last experiment, or why there are none; `None` while it runs, and before the first.
    pub fn experiment_rows(&self) -> Option<Result<usize, &str>> {
        let result = self.experiment.result.as_ref()?;
        let rows = |report: &DistanceSweepReport| report.layouts.iter().map(|layout| layout.rows.len()).sum();
        Some(result.as_ref().map(rows).map_err(String::as_str))
    }

    /// Starts the experiment.
    pub(crate) fn start_experiment(&mut self, options: relievo_lab::measure::DistanceSweepOptions) {
        let egui = self.egui.clone();
        self.experiment.start(&self.gpu, options, move || egui.request_repaint());
    }

    /// Goes on with another device, after the own one was lost.
    ///
    /// # Errors
    /// The errors of [`relievo::scene::Scene::rebuild_all_async`].
    pub async fn rebuild(&mut self, gpu: Gpu) -> Result<(), Error> {
        if let Some(shown) = &mut self.shown {
            shown.stage.rebuild(&gpu).await?;
            if let Some(full) = &mut shown.full {
                full.rebuild(&gpu).await?;
            }
        }
        // What is loaded now is on the lost device.
        if let Some(Loading { purpose: Purpose::Open, name, .. }) = self.loading.take() {
            self.notice = Some(format!("{name}: the device was lost meanwhile; open it again"));
        }
        let primitives = std::mem::take(&mut self.painter.primitives);
        let pixels_per_point = self.painter.pixels_per_point;
        self.painter = Painter { primitives, pixels_per_point, ..Painter::new(&gpu, self.painter.format) };
        let letters = self.egui.fonts(|fonts| fonts.image());
        let letters = egui::epaint::ImageDelta::full(letters, egui::TextureOptions::LINEAR);
        self.painter.written.push((egui::TextureId::default(), letters));
        self.gpu = gpu;
        (self.in_flight, self.device_time) = Default::default();
        Ok(())
    }

    /// Whether an error means that the device is lost.
    pub fn is_loss(error: &Error) -> bool {
        matches!(error, Error::Gpu(GpuError::DeviceLost { .. }))
    }
}

/// Lets egui paint the picture of a stage.
fn show(
    renderer: &mut egui_wgpu::Renderer,
    stage: &Stage,
    colors: Colors,
    picture: &mut Option<egui::TextureId>,
) {
    let Some(texture) = stage.target(colors).and_then(|target| target.color(0)) else { return };
    let device = stage.gpu().device();
    // egui takes values as they are stored.
    let format = Some(texture.format().remove_srgb_suffix());
    let view = texture.create_view(&wgpu::TextureViewDescriptor { format, ..Default::default() });
    let filter = wgpu::FilterMode::Nearest;
    match picture {
        Some(id) => renderer.update_egui_texture_from_wgpu_texture(device, &view, filter, *id),
        None => *picture = Some(renderer.register_native_texture(device, &view, filter)),
    }
}

fn milliseconds(start: Instant) -> f64 {
    1e3 * start.elapsed().as_secs_f64()
}
