//! The viewer in a page: a canvas, the browser's device, files by `fetch`, settings in the browser's storage.

use std::cell::{Cell, RefCell};
use std::io;
use std::sync::Arc;
use std::time::Duration;

use js_sys::{Array, Reflect, Uint8Array};
use relievo::gpu::Gpu;
use relievo::{Error, wgpu};
use serde_json::json;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::platform::web::{EventLoopExtWebSys as _, WindowAttributesExtWebSys as _};
use winit::window::{Window, WindowId};

use crate::settings::Settings;
use crate::start::Start;
use crate::viewer::{Request, Viewer};

/// The key of the settings in the browser's storage.
const STORED: &str = "relievo viewer";

/// The identifier of the page's canvas, and of the element that shows what is wrong.
const CANVAS: &str = "viewer";
const MESSAGE: &str = "message";

/// Milliseconds until the next attempt where the canvas had no texture.
const PAUSE: Duration = Duration::from_millis(50);

/// The page ends if more devices than this are lost within this time.
const MOST_LOSSES: usize = 4;
const OFTEN: Duration = Duration::from_secs(60);

thread_local! {
    /// What the viewer shows, as JSON.
    static STATE: RefCell<String> = RefCell::new("{}".to_owned());

    /// How often somebody asked what the controls say, and the last answer: its number, and what [`Viewer::controls`] says.
    static ASKED: Cell<u32> = const { Cell::new(0) };
    static ANSWER: RefCell<(u32, serde_json::Value)> = const { RefCell::new((0, serde_json::Value::Null)) };

    /// The way to the event loop for callbacks, which have to be `Send`: without threads, they find it here.
    static WAKE: RefCell<Option<EventLoopProxy<Told>>> = const { RefCell::new(None) };
}

/// What the viewer shows, as JSON: what it loads (`step`), what is wrong (`notice`), the `scene`, `triangles` in view, `bytes` that
/// arrived, and seconds until the first picture.
pub fn state() -> String {
    STATE.with_borrow(String::clone)
}

/// Asks what the controls say. The number is that of the answer, which is in [`state`] after the next frame: the fields `answer` and
/// `controls`.
pub fn ask() -> u32 {
    let number = ASKED.get() + 1;
    ASKED.set(number);
    WAKE.with_borrow(|proxy| proxy.iter().for_each(|proxy| _ = proxy.send_event(Told::Wake)));
    number
}

/// Opens the viewer in the page's canvas.
pub fn start() {
    std::panic::set_hook(Box::new(|panic| fail(&format!("The viewer ended: {panic}"))));
    let events = match EventLoop::<Told>::with_user_event().build() {
        Ok(events) => events,
        Err(error) => return fail(&error.to_string()),
    };
    let proxy = events.create_proxy();
    take_drops(&proxy);
    events.spawn_app(Page { proxy, running: None });
}

/// Shows in the page, and in the browser's console, why there is no picture.
fn fail(why: &str) {
    web_sys::console::error_1(&why.into());
    let element = document().and_then(|document| document.get_element_by_id(MESSAGE));
    if let Some(element) = element {
        element.set_text_content(Some(why));
        let _ = element.remove_attribute("hidden");
    }
}

fn document() -> Option<web_sys::Document> {
    web_sys::window()?.document()
}

/// The address of the page without its query.
pub(crate) fn address() -> String {
    let location = web_sys::window().map(|window| window.location());
    let part = |part: Option<Result<String, JsValue>>| part.and_then(Result::ok).unwrap_or_default();
    let origin = part(location.as_ref().map(web_sys::Location::origin));
    origin + &part(location.as_ref().map(web_sys::Location::pathname))
}

fn query() -> String {
    web_sys::window().and_then(|window| window.location().search().ok()).unwrap_or_default()
}

fn storage() -> Option<web_sys::Storage> {
    web_sys::window()?.local_storage().ok()?
}

pub(crate) fn other(error: &JsValue) -> io::Error {
    let message = Reflect::get(error, &"message".into()).ok().and_then(|message| message.as_string());
    io::Error::other(message.unwrap_or_else(|| format!("{error:?}")))
}

/// An address in full; `None` for what is no address.
pub(crate) fn absolute(address: &str) -> Option<String> {
    let page = web_sys::window()?.location().href().ok()?;
    Some(web_sys::Url::new_with_base(address, &page).ok()?.href())
}

/// Reads a whole file by its address.
pub(crate) async fn fetched(address: &str) -> io::Result<Vec<u8>> {
    let window = web_sys::window().ok_or_else(|| io::Error::other("there is no window"))?;
    let response = JsFuture::from(window.fetch_with_str(address)).await.map_err(|error| other(&error))?;
    let response: web_sys::Response = response.dyn_into().map_err(|error| other(&error))?;
    if !response.ok() {
        return Err(crate::source::answered(response.status()));
    }
    let body = response.array_buffer().map_err(|error| other(&error))?;
    let body = JsFuture::from(body).await.map_err(|error| other(&error))?;
    Ok(Uint8Array::new(&body).to_vec())
}

/// The scenes and models of the server that the page comes from, as its catalog lists them: names and addresses. It is asked for them
/// at the first call, and the answer wakes the page.
pub(crate) fn offered(egui: &egui::Context) -> Vec<(String, String)> {
    let known = OFFERED.with_borrow_mut(|offered| {
        let known = offered.clone();
        offered.get_or_insert_default();
        known
    });
    if let (None, Some(catalog)) = (&known, absolute("catalog.json")) {
        let egui = egui.clone();
        spawn_local(async move {
            // A page that no such server serves has none.
            let Ok(text) = fetched(&catalog).await else { return };
            let Ok(catalog) = serde_json::from_slice::<serde_json::Value>(&text) else { return };
            let list = |name: &str| catalog[name].as_array().cloned().unwrap_or_default().into_iter();
            let scenes = list("scenes")
                .filter_map(|name| Some((name.as_str()?.to_owned(), name.as_str()?.to_owned())));
            // A model that is not ready has no package.
            let models = list("models").filter_map(|model| {
                let name = model["name"].as_str().filter(|_| model["package"].is_string())?;
                Some((name.to_owned(), format!("models/{name}.rlv")))
            });
            OFFERED.set(Some(scenes.chain(models).collect()));
            egui.request_repaint();
        });
    }
    known.unwrap_or_default()
}

thread_local! {
    /// Scenes and models of the server, once it has been asked for them.
    static OFFERED: RefCell<Option<Vec<(String, String)>>> = const { RefCell::new(None) };
}

/// Completes after so many seconds.
pub(crate) async fn sleep(seconds: f64) {
    let promise = js_sys::Promise::new(&mut |resolve, _| {
        if let Some(window) = web_sys::window() {
            let milliseconds = (1e3 * seconds).min(f64::from(i32::MAX)) as i32;
            let _ = window.set_timeout_with_callback_and_timeout_and_arguments_0(&resolve, milliseconds);
        }
    });
    let _ = JsFuture::from(promise).await;
}

/// Lets the page draw a frame.
pub(crate) async fn next_frame() {
    sleep(0.0).await;
}

/// What the event loop is told.
enum Told {
    Wake,
    Opened(Box<Opened>),
    Failed(String),
    Dropped(Vec<(String, Arc<[u8]>)>),
    Recovered(Box<Opened>),
    /// The viewer is back from showing what has arrived.
    Back,
}

/// A device, and the canvas's surface configured for it.
struct Opened {
    gpu: Gpu,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
}

/// Opens a device for a canvas.
async fn opened(window: Arc<Window>) -> Result<Opened, String> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::BROWSER_WEBGPU;
    let instance = wgpu::Instance::new(descriptor);
    let surface = instance.create_surface(window.clone()).map_err(|error| error.to_string())?;
    let suits = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
    let adapter = instance.request_adapter(&suits).await;
    let adapter = adapter.map_err(|error| format!("This browser has no adapter for WebGPU: {error}"))?;
    let features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
    let (own, default) = (adapter.limits(), wgpu::Limits::default());
    let binding = own.max_storage_buffer_binding_size.min(own.max_buffer_size);
    let required_limits = wgpu::Limits {
        max_storage_buffer_binding_size: binding.max(default.max_storage_buffer_binding_size),
        max_buffer_size: binding.max(default.max_buffer_size),
        ..default
    };
    let descriptor =
        wgpu::DeviceDescriptor { required_features: features, required_limits, ..Default::default() };
    let (device, queue) = adapter.request_device(&descriptor).await.map_err(|error| error.to_string())?;
    let size = window.inner_size();
    let config = surface.get_default_config(&adapter, size.width.max(1), size.height.max(1));
    let config = config.ok_or("the adapter does not draw into a canvas")?;
    let config = wgpu::SurfaceConfiguration { format: config.format.remove_srgb_suffix(), ..config };
    surface.configure(&device, &config);
    Ok(Opened { gpu: Gpu::from_wgpu(device, queue), surface, config })
}

/// Lets files open that are dropped onto the page.
fn take_drops(proxy: &EventLoopProxy<Told>) {
    let Some(document) = document() else { return };
    let over =
        Closure::<dyn Fn(web_sys::DragEvent)>::new(|event: web_sys::DragEvent| event.prevent_default());
    let proxy = proxy.clone();
    let dropped = Closure::<dyn Fn(web_sys::DragEvent)>::new(move |event: web_sys::DragEvent| {
        event.prevent_default();
        let Some(files) = event.data_transfer().and_then(|transfer| transfer.files()) else { return };
        let proxy = proxy.clone();
        spawn_local(async move {
            let mut all = Vec::new();
            for file in (0..files.length()).filter_map(|at| files.get(at)) {
                if let Ok(bytes) = JsFuture::from(file.array_buffer()).await {
                    all.push((file.name(), Uint8Array::new(&bytes).to_vec().into()));
                }
            }
            let _ = proxy.send_event(Told::Dropped(all));
        });
    });
    for (name, listener) in [("dragover", over), ("drop", dropped)] {
        let _ = document.add_event_listener_with_callback(name, listener.as_ref().unchecked_ref());
        // It listens as long as the page is there.
        listener.forget();
    }
}

/// The page, from its start to its end.
struct Page {
    proxy: EventLoopProxy<Told>,
    running: Option<Running>,
}

/// The canvas, and once there is a device, the viewer in it.
struct Running {
    window: Arc<Window>,
    viewer: Option<Shown>,
    /// Whether another device is being opened.
    recovers: bool,
    /// When devices were lost.
    losses: Vec<web_time::Instant>,
    /// Events, and whether a frame was due, while the viewer was away.
    missed: Vec<WindowEvent>,
    is_due: bool,
}

impl Running {
    /// Takes the viewer back, once it is there.
    fn take_back(&mut self) {
        let Some(mut shown) = BACK.with_borrow_mut(Option::take) else { return };
        for event in self.missed.drain(..) {
            let _ = shown.input.on_window_event(&self.window, &event);
        }
        self.viewer = Some(shown);
    }
}

struct Shown {
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    input: egui_winit::State,
    viewer: Viewer,
}

impl Shown {
    fn new(window: &Window, opened: Opened, proxy: &EventLoopProxy<Told>) -> Self {
        let Opened { gpu, surface, config } = opened;
        let stored = storage().and_then(|storage| storage.get_item(STORED).ok()?);
        let settings = stored.map(|text| Settings::from_json(&text)).unwrap_or_default();
        let mut viewer = Viewer::new(gpu, config.format, settings);
        let egui = viewer.egui().clone();
        WAKE.set(Some(proxy.clone()));
        egui.set_request_repaint_callback(|asked| {
            if asked.delay.is_zero() {
                // After the end of the page, nobody listens.
                WAKE.with_borrow(|proxy| proxy.iter().for_each(|proxy| _ = proxy.send_event(Told::Wake)));
            }
        });
        let most = viewer.gpu().device().limits().max_texture_dimension_2d as usize;
        let scale = window.scale_factor() as f32;
        let root = egui::ViewportId::ROOT;
        let input = egui_winit::State::new(egui, root, window, Some(scale), window.theme(), Some(most));
        match Start::from_query(&query()) {
            Ok(start) => viewer.begin(start),
            Err(error) => {
                viewer.begin(Start::default());
                viewer.tell(format!("the address of the page: {error}"));
            }
        }
        Self { surface, config, input, viewer }
    }

    /// Draws a frame. Returns how long the next one may wait; `None` for an event.
    fn frame(&mut self, window: &Window) -> Result<Option<Duration>, Error> {
        let size = window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Ok(Some(PAUSE));
        }
        if [size.width, size.height] != [self.config.width, self.config.height] {
            (self.config.width, self.config.height) = (size.width, size.height);
            self.surface.configure(self.viewer.gpu().device(), &self.config);
        }
        let input = self.input.take_egui_input(window);
        let output = self.viewer.frame(input);
        for command in &output.platform.commands {
            if let egui::OutputCommand::CopyText(text) = command {
                copy(text);
            }
        }
        self.input.handle_platform_output(window, output.platform);
        use wgpu::CurrentSurfaceTexture as Current;
        let texture = match self.surface.get_current_texture() {
            Current::Success(texture) | Current::Suboptimal(texture) => texture,
            _ => return Ok(Some(PAUSE)),
        };
        let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.viewer.paint(&view, [self.config.width, self.config.height])?;
        self.viewer.gpu().queue().present(texture);
        self.serve();
        self.tell_state();
        Ok(output.wait)
    }

    /// Does what the viewer asks for.
    fn serve(&mut self) {
        for request in self.viewer.requests() {
            match request {
                Request::Copy(text) => {
                    copy(&text);
                    self.viewer.say("copied");
                }
                Request::Save { name, bytes } => match download(&name, &bytes) {
                    Ok(()) => self.viewer.say(format!("{name} is among the downloads")),
                    Err(error) => self.viewer.tell(format!("{name}: {}", other(&error))),
                },
                Request::Remember(settings) => {
                    // A browser may keep nothing for this page.
                    let _ = storage().map(|storage| storage.set_item(STORED, &settings.to_json()));
                }
            }
        }
    }

    fn tell_state(&mut self) {
        if ANSWER.with_borrow(|answer| answer.0) != ASKED.get() {
            ANSWER.set((ASKED.get(), self.viewer.controls()));
        }
        let (answer, controls) = ANSWER.with_borrow(Clone::clone);
        let viewer = &self.viewer;
        let last = viewer.history().last();
        let state = json!({
            "step": viewer.step(),
            "notice": viewer.notice(),
            "scene": viewer.shown().map(|shown| shown.name.as_str()),
            "ready": viewer.shown().map(|shown| shown.stage.ready()),
            "triangles": last.map(|sample| sample.triangles),
            "bytes": viewer.bytes(),
            "streams": viewer.shown().map(crate::Shown::is_streaming),
            "waits": viewer.shown().and_then(crate::Shown::waits).map(|(why, _)| why),
            "levels": viewer.shown().map(|shown| shown.packages().iter().map(|package| package.levels).collect::<Vec<_>>()),
            "first_bytes": viewer.first_picture().map(|(bytes, _)| bytes),
            "first_picture": viewer.first_picture().map(|(_, seconds)| seconds),
            "experiment": viewer.experiment_rows().map(|rows| match rows {
                Ok(rows) => json!(rows),
                Err(why) => json!(why),
            }),
            "measures": viewer.is_measuring(),
            "picture": viewer.picture_size(),
            "frames": viewer.shown().map(|shown| shown.stage.world.scene.frames()),
            "pixels": viewer.shown().map(|shown| shown.quality.pixels),
            "answer": answer,
            "controls": controls,
        });
        STATE.set(state.to_string());
    }
}

/// Puts text on the clipboard.
fn copy(text: &str) {
    if let Some(window) = web_sys::window() {
        let written = window.navigator().clipboard().write_text(text);
        spawn_local(async move { _ = JsFuture::from(written).await });
    }
}

/// Lets the browser save a file.
fn download(name: &str, bytes: &[u8]) -> Result<(), JsValue> {
    let parts = Array::of1(&Uint8Array::from(bytes));
    let blob = web_sys::Blob::new_with_u8_array_sequence(&parts)?;
    let address = web_sys::Url::create_object_url_with_blob(&blob)?;
    let document = document().ok_or(JsValue::NULL)?;
    let link: web_sys::HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
    link.set_href(&address);
    link.set_download(name);
    link.click();
    web_sys::Url::revoke_object_url(&address)
}

impl Page {
    fn redraw(&mut self, events: &ActiveEventLoop) {
        let Some(running) = &mut self.running else { return };
        running.take_back();
        running.is_due = running.viewer.is_none();
        let Running { window, viewer: Some(shown), recovers, losses, .. } = running else { return };
        if *recovers {
            return;
        }
        let drawn = shown.frame(window);
        let is_drawn = drawn.is_ok();
        match drawn {
            Ok(Some(Duration::ZERO)) => window.request_redraw(),
            Ok(Some(wait)) => {
                let moment = web_time::Instant::now().checked_add(wait);
                events.set_control_flow(moment.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
            }
            Ok(None) => events.set_control_flow(ControlFlow::Wait),
            Err(error) if Viewer::is_loss(&error) => {
                *recovers = true;
                losses.retain(|moment| moment.elapsed() < OFTEN);
                losses.push(web_time::Instant::now());
                if losses.len() > MOST_LOSSES {
                    return fail(
                        "The device was lost again and again. Another browser, or another graphics driver, may keep it.",
                    );
                }
                let (window, proxy) = (window.clone(), self.proxy.clone());
                spawn_local(async move {
                    let told = match opened(window).await {
                        Ok(opened) => Told::Recovered(Box::new(opened)),
                        Err(why) => Told::Failed(why),
                    };
                    let _ = proxy.send_event(told);
                });
            }
            Err(error) => {
                shown.viewer.tell(error.to_string());
                window.request_redraw();
            }
        }
        if is_drawn && shown.viewer.is_streaming() {
            self.stream();
        }
    }

    /// Shows what has arrived. The viewer is away as long as the browser does not tell errors, which takes no time where nothing
    /// has arrived.
    fn stream(&mut self) {
        let Some(Running { viewer, .. }) = &mut self.running else { return };
        let Some(mut shown) = viewer.take() else { return };
        let proxy = self.proxy.clone();
        spawn_local(async move {
            match shown.viewer.stream().await {
                // The next frame finds out that the device is lost.
                Err(error) if !Viewer::is_loss(&error) => shown.viewer.tell(error.to_string()),
                _ => {}
            }
            BACK.with_borrow_mut(|back| *back = Some(shown));
            let _ = proxy.send_event(Told::Back);
        });
    }

    /// Goes on with another device.
    fn recover(&mut self, opened: Opened) {
        let Some(Running { window, viewer, recovers, .. }) = &mut self.running else { return };
        let Some(mut shown) = viewer.take() else { return };
        let (proxy, again) = (self.proxy.clone(), window.clone());
        *recovers = false;
        let Opened { gpu, surface, config } = opened;
        // The viewer comes back by a message, because a browser forbids waiting.
        spawn_local(async move {
            if let Err(error) = shown.viewer.rebuild(gpu).await {
                let _ = proxy.send_event(Told::Failed(error.to_string()));
                return;
            }
            (shown.surface, shown.config) = (surface, config);
            BACK.with_borrow_mut(|back| *back = Some(shown));
            let _ = proxy.send_event(Told::Wake);
            again.request_redraw();
        });
    }
}

thread_local! {
    /// A viewer that was away, and goes back to its page.
    static BACK: RefCell<Option<Shown>> = const { RefCell::new(None) };
}

impl ApplicationHandler<Told> for Page {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.running.is_some() {
            return;
        }
        let canvas = document().and_then(|document| document.get_element_by_id(CANVAS));
        let canvas = canvas.and_then(|canvas| canvas.dyn_into::<web_sys::HtmlCanvasElement>().ok());
        let attributes = Window::default_attributes().with_canvas(canvas).with_prevent_default(true);
        let window = match events.create_window(attributes) {
            Ok(window) => Arc::new(window),
            Err(error) => return fail(&error.to_string()),
        };
        let (proxy, canvas) = (self.proxy.clone(), window.clone());
        spawn_local(async move {
            let told = match opened(canvas).await {
                Ok(opened) => Told::Opened(Box::new(opened)),
                Err(why) => Told::Failed(why),
            };
            let _ = proxy.send_event(told);
        });
        self.running = Some(Running {
            window,
            viewer: None,
            recovers: false,
            losses: Vec::new(),
            missed: Vec::new(),
            is_due: false,
        });
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(running)) = (cause, &self.running) {
            running.window.request_redraw();
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, told: Told) {
        let Some(running) = &mut self.running else { return };
        running.take_back();
        match told {
            Told::Back if !std::mem::take(&mut running.is_due) => return,
            Told::Back => {}
            Told::Wake => {}
            Told::Opened(opened) => {
                let mut shown = Shown::new(&running.window, *opened, &self.proxy);
                // The canvas may have got the focus before the device was there.
                let focus = WindowEvent::Focused(running.window.has_focus());
                for event in running.missed.drain(..).chain([focus]) {
                    let _ = shown.input.on_window_event(&running.window, &event);
                }
                running.viewer = Some(shown);
            }
            Told::Failed(why) => return fail(&why),
            Told::Dropped(files) => {
                if let Some(shown) = &mut running.viewer {
                    shown.viewer.drop_files(files);
                }
            }
            Told::Recovered(opened) => return self.recover(*opened),
        }
        running.window.request_redraw();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if matches!(event, WindowEvent::RedrawRequested) {
            return self.redraw(events);
        }
        let Some(Running { window, viewer, missed, .. }) = &mut self.running else { return };
        let Some(shown) = viewer else {
            missed.push(event);
            return;
        };
        let is_resized = matches!(event, WindowEvent::Resized(_));
        if shown.input.on_window_event(window, &event).repaint || is_resized {
            window.request_redraw();
        }
    }
}
