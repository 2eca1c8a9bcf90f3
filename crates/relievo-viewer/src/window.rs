//! The viewer in a window.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use relievo::gpu::{Gpu, GpuError};
use relievo::{Error, InputError};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

use crate::settings::Settings;
use crate::start::Start;
use crate::viewer::{Request, Viewer};

/// How long to wait where the surface had no texture to draw into.
const PAUSE: Duration = Duration::from_millis(50);

/// Largest number of frames that wait for the detail of endless terrain.
const MOST_FRAMES: usize = 2000;

/// How the viewer is opened.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// What is opened, and how.
    pub start: Start,
    /// A part of the name of the adapter; `None` for the one that suits the window.
    pub adapter: Option<String>,
    /// Width and height of the window, in points; 1280 × 800 by default.
    pub size: Option<[u32; 2]>,
    /// The file of the settings; `None` to remember nothing.
    pub settings: Option<PathBuf>,
}

impl Options {
    /// The file of the settings of this user: `relievo/viewer.json` in the folder of configurations.
    pub fn users_settings() -> Option<PathBuf> {
        let folder = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let config = folder("XDG_CONFIG_HOME").or_else(|| folder("APPDATA"));
        let config = config.or_else(|| folder("HOME").map(|home| home.join(".config")));
        config.map(|config| config.join("relievo/viewer.json"))
    }
}

/// Draws one picture of what the viewer would show, without a window.
///
/// # Errors
/// [`Error`] for a file that cannot be shown; [`GpuError`].
pub fn draw(gpu: &Gpu, start: &Start, size: [u32; 2]) -> Result<image::RgbaImage, Error> {
    let mut viewer = Viewer::new(gpu.clone(), wgpu::TextureFormat::Rgba8Unorm, Settings::default());
    viewer.begin(start.clone());
    viewer.drawn(size)
}

impl Viewer {
    /// Draws the scene into a picture of this size, once all of it is there.
    fn drawn(&mut self, size: [u32; 2]) -> Result<image::RgbaImage, Error> {
        while self.step().is_some() {
            self.frame(egui::RawInput::default());
            std::thread::sleep(Duration::from_millis(2));
        }
        if let Some(why) = self.notice() {
            return Err(InputError::new("scene", "not shown", why.to_owned()).into());
        }
        let (gpu, colors) = (self.gpu().clone(), self.settings().colors);
        let Some(shown) = &mut self.shown else {
            return Err(InputError::new("scene", "none", "must be given").into());
        };
        shown.clock.plays = false;
        shown.apply()?;
        shown.stage.resize(size, colors)?;
        for _ in 0..MOST_FRAMES {
            let mut encoder = gpu.encoder("picture");
            shown.record(&mut encoder, size, colors)?;
            gpu.scoped(|| gpu.queue().submit([encoder.finish()]))?;
            gpu.wait()?;
            if shown.stage.ready() == 1.0 && !shown.is_streaming() {
                break;
            }
            while shown.is_streaming() {
                if let Some((why, _)) = shown.waits() {
                    return Err(InputError::new("scene", "not whole", why).into());
                }
                gpu.block_on(shown.stream(None))?;
                std::thread::sleep(Duration::from_millis(2));
            }
        }
        match shown.stage.target(colors) {
            Some(target) => target.read(&gpu),
            None => Err(InputError::new("picture", "none", "must be drawn before").into()),
        }
    }
}

/// Opens the viewer in a window, until it is closed.
///
/// # Errors
/// [`Error`] for a machine without a display or without an adapter for it; errors of the device.
pub fn run(options: Options) -> Result<(), Error> {
    let events = EventLoop::<Wake>::with_user_event().build().map_err(|error| display(&error))?;
    let handle = Box::new(events.owned_display_handle());
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(handle));
    let settings = options.settings.as_deref().map(read_settings).unwrap_or_default();
    let proxy = events.create_proxy();
    let mut program = Program { options, settings, instance, proxy, running: None, failure: None };
    events.run_app(&mut program).map_err(|error| display(&error))?;
    program.failure.map_or(Ok(()), Err)
}

/// An error of the window system.
fn display(error: &impl std::fmt::Display) -> Error {
    GpuError::Internal { reason: format!("no window: {error}") }.into()
}

fn read_settings(path: &Path) -> Settings {
    std::fs::read_to_string(path).map(|text| Settings::from_json(&text)).unwrap_or_default()
}

/// Something outside of the window wants a frame.
struct Wake;

struct Program {
    options: Options,
    settings: Settings,
    instance: wgpu::Instance,
    proxy: EventLoopProxy<Wake>,
    /// Everything that needs a window; `None` until there is one.
    running: Option<Running>,
    failure: Option<Error>,
}

/// The viewer in its window.
struct Running {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    input: egui_winit::State,
    viewer: Viewer,
    adapter: Option<String>,
}

impl Running {
    fn new(program: &Program, events: &ActiveEventLoop) -> Result<Self, Error> {
        let [width, height] = program.options.size.unwrap_or([1280, 800]);
        let attributes = Window::default_attributes()
            .with_title("relievo")
            .with_inner_size(LogicalSize::new(width, height));
        let window = Arc::new(events.create_window(attributes).map_err(|error| display(&error))?);
        let surface = program.instance.create_surface(window.clone()).map_err(|error| display(&error))?;
        let wanted = program.options.adapter.clone().or_else(|| std::env::var("RELIEVO_ADAPTER").ok());
        let wanted = wanted.filter(|wanted| !wanted.is_empty());
        let (adapter, gpu) = pollster::block_on(opened(&program.instance, &surface, wanted.as_deref()))?;
        let config = configuration(&surface, &adapter, &window)?;
        surface.configure(gpu.device(), &config);
        let mut viewer = Viewer::new(gpu, config.format, program.settings.clone());
        let most = viewer.gpu().device().limits().max_texture_dimension_2d as usize;
        let (egui, proxy) = (viewer.egui().clone(), program.proxy.clone());
        // Another thread that loads something asks for a frame.
        egui.set_request_repaint_callback(move |asked| {
            if asked.delay.is_zero() {
                let _ = proxy.send_event(Wake);
            }
        });
        let input = egui_winit::State::new(
            egui,
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(most),
        );
        viewer.begin(program.options.start.clone());
        Ok(Self { window, surface, config, input, viewer, adapter: wanted })
    }

    /// Draws a frame. Returns how long the next one may wait; `None` for an event.
    fn frame(&mut self, instance: &wgpu::Instance) -> Result<Option<Duration>, Error> {
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Ok(None);
        }
        let input = self.input.take_egui_input(&self.window);
        let output = self.viewer.frame(input);
        self.input.handle_platform_output(&self.window, output.platform);
        use wgpu::CurrentSurfaceTexture as Current;
        let texture = match self.surface.get_current_texture() {
            Current::Success(texture) | Current::Suboptimal(texture) => texture,
            Current::Timeout | Current::Occluded => return Ok(Some(PAUSE)),
            Current::Outdated => {
                self.configure();
                return Ok(Some(Duration::ZERO));
            }
            Current::Lost | Current::Validation => {
                self.recover(instance)?;
                return Ok(Some(Duration::ZERO));
            }
        };
        let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
        match self.viewer.paint(&view, [self.config.width, self.config.height]) {
            Err(error) if Viewer::is_loss(&error) => {
                drop(texture);
                self.recover(instance)?;
                return Ok(Some(Duration::ZERO));
            }
            painted => painted?,
        }
        self.window.pre_present_notify();
        self.viewer.gpu().queue().present(texture);
        Ok(output.wait)
    }

    /// Goes on with another device after the own one was lost.
    fn recover(&mut self, instance: &wgpu::Instance) -> Result<(), Error> {
        self.surface = instance.create_surface(self.window.clone()).map_err(|error| display(&error))?;
        let (_, gpu) = pollster::block_on(opened(instance, &self.surface, self.adapter.as_deref()))?;
        gpu.clone().block_on(self.viewer.rebuild(gpu))?;
        self.configure();
        Ok(())
    }

    fn configure(&mut self) {
        let size = self.window.inner_size();
        (self.config.width, self.config.height) = (size.width.max(1), size.height.max(1));
        self.surface.configure(self.viewer.gpu().device(), &self.config);
    }

    /// Does what the viewer asks for.
    fn serve(&mut self, settings: Option<&Path>) {
        for request in self.viewer.requests() {
            let done = match request {
                Request::Copy(text) => {
                    self.input.set_clipboard_text(text.clone());
                    // A terminal has it too, where there is no clipboard.
                    println!("{text}");
                    self.viewer.say("copied");
                    Ok(())
                }
                Request::Save { name, bytes } => {
                    let path = unused(&name);
                    let written = relievo_lab::files::write_file(&path, &bytes);
                    if written.is_ok() {
                        println!("{}", path.display());
                        self.viewer.say(format!("saved {}", path.display()));
                        self.window.set_title(&format!("relievo: saved {}", path.display()));
                    }
                    written
                }
                Request::Remember(own) => settings.map_or(Ok(()), |path| {
                    let folder = path.parent().unwrap_or(Path::new(""));
                    std::fs::create_dir_all(folder).map_err(|error| Error::output(path, error))?;
                    relievo_lab::files::write_file(path, own.to_json().as_bytes())
                }),
            };
            if let Err(error) = done {
                self.viewer.tell(error.to_string());
            }
        }
    }
}

/// A file's name that is not taken: with a number before its ending.
fn unused(name: &str) -> PathBuf {
    let path = Path::new(name);
    let (stem, ending) = (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let numbered = (2..).map(|at| format!("{}-{at}.{}", stem.to_string_lossy(), ending.to_string_lossy()));
    let mut names = std::iter::once(name.to_owned()).chain(numbered).map(PathBuf::from);
    names.find(|name| !name.exists()).unwrap_or_else(|| path.to_owned())
}

/// Opens a device for a surface: on the adapter whose name or driver has a part, or on the one that suits best.
async fn opened(
    instance: &wgpu::Instance,
    surface: &wgpu::Surface<'static>,
    wanted: Option<&str>,
) -> Result<(wgpu::Adapter, Gpu), Error> {
    let adapter = match wanted {
        None => {
            let suits =
                wgpu::RequestAdapterOptions { compatible_surface: Some(surface), ..Default::default() };
            instance.request_adapter(&suits).await.map_err(|error| display(&error))?
        }
        Some(wanted) => {
            let all = instance.enumerate_adapters(wgpu::Backends::all()).await;
            let has = |adapter: &wgpu::Adapter| {
                let info = adapter.get_info();
                let text = format!("{} {} {:?}", info.name, info.driver, info.device_type).to_lowercase();
                text.contains(&wanted.to_lowercase()) && adapter.is_surface_supported(surface)
            };
            let missing = || GpuError::NoAdapter {
                wanted: format!("matches `{wanted}` and draws into windows"),
                seen: "see `relievo info`".to_owned(),
            };
            all.into_iter().find(has).ok_or_else(missing)?
        }
    };
    let wanted = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    let (own, default) = (adapter.limits(), wgpu::Limits::default());
    // Shaders count words in u32.
    let binding =
        own.max_storage_buffer_binding_size.min(own.max_buffer_size).min(u64::from(u32::MAX) / 4 * 4);
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("relievo viewer"),
        required_features: adapter.features() & wanted,
        required_limits: wgpu::Limits {
            max_storage_buffer_binding_size: binding.max(default.max_storage_buffer_binding_size),
            max_buffer_size: binding.max(default.max_buffer_size),
            ..default
        },
        ..Default::default()
    };
    let (device, queue) = adapter.request_device(&descriptor).await.map_err(|error| display(&error))?;
    Ok((adapter, Gpu::from_wgpu(device, queue)))
}

/// The configuration of a window's surface, in a format that does not convert to sRGB by itself.
fn configuration(
    surface: &wgpu::Surface<'static>,
    adapter: &wgpu::Adapter,
    window: &Window,
) -> Result<wgpu::SurfaceConfiguration, Error> {
    let size = window.inner_size();
    let config = surface.get_default_config(adapter, size.width.max(1), size.height.max(1));
    let config = config.ok_or_else(|| display(&"the adapter does not draw into windows"))?;
    let formats = surface.get_capabilities(adapter).formats;
    let plain = formats
        .into_iter()
        .find(|format| matches!(format, wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Rgba8Unorm));
    Ok(wgpu::SurfaceConfiguration { format: plain.unwrap_or(config.format), ..config })
}

impl Program {
    fn redraw(&mut self, events: &ActiveEventLoop) {
        let Some(running) = &mut self.running else { return };
        let drawn = running.frame(&self.instance);
        running.serve(self.options.settings.as_deref());
        match drawn {
            Ok(Some(Duration::ZERO)) => running.window.request_redraw(),
            Ok(Some(wait)) => {
                let moment = Instant::now().checked_add(wait);
                events.set_control_flow(moment.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
            }
            Ok(None) => events.set_control_flow(ControlFlow::Wait),
            Err(error) => self.end(events, error),
        }
    }

    fn end(&mut self, events: &ActiveEventLoop, error: Error) {
        self.failure = Some(error);
        events.exit();
    }

    fn request_redraw(&self) {
        if let Some(running) = &self.running {
            running.window.request_redraw();
        }
    }
}

impl ApplicationHandler<Wake> for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.running.is_none() {
            match Running::new(self, events) {
                Ok(running) => self.running = Some(running),
                Err(error) => self.end(events, error),
            }
            self.request_redraw();
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            self.request_redraw();
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, _: Wake) {
        self.request_redraw();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(running) = &mut self.running else { return };
        match &event {
            WindowEvent::CloseRequested => return events.exit(),
            WindowEvent::RedrawRequested => return self.redraw(events),
            WindowEvent::Resized(_) => running.configure(),
            WindowEvent::DroppedFile(path) => running.viewer.open_address(&path.to_string_lossy()),
            _ => {}
        }
        if running.input.on_window_event(&running.window, &event).repaint {
            running.window.request_redraw();
        }
    }
}
