//! A window: a crowd that walks over terrain, between relief walls, under a camera that mouse and keys move. `world.rs` is
//! all that this program says to relievo; `targets.rs` (the window's surface, 4 samples, depth), `eye.rs` (the camera) and
//! this file (events and frames) are wgpu and winit, as in any engine.
//!
//! `cargo run --release --example window -- [--frames N] [--picture FILE]`
//!
//! Drag with the left button to turn, scroll to come nearer or go farther, W, A, S, D, Q and E to move (with Shift, faster),
//! Escape to end. `--frames` ends after so many frames of a sixtieth of a second each, and `--picture` saves the last one.

mod eye;
mod targets;
mod world;

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{ElementState, KeyEvent, MouseButton, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{KeyCode, PhysicalKey};
use winit::window::{Window, WindowId};

use eye::Eye;
use targets::Targets;
use world::World;

/// What may go wrong: the window, the device, a file.
type Failure = Box<dyn std::error::Error>;

/// How long to wait before the next attempt where the surface had no texture to draw into.
const PAUSE: Duration = Duration::from_millis(50);

fn main() -> Result<(), Failure> {
    let options = Options::of(std::env::args().skip(1))?;
    let events = EventLoop::new()?;
    let display = Box::new(events.owned_display_handle());
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(display));
    let mut program = Program { options, instance, running: None, failure: None };
    events.run_app(&mut program)?;
    program.failure.map_or(Ok(()), Err)
}

/// What the command line asks for.
#[derive(Default)]
struct Options {
    frames: Option<u32>,
    picture: Option<PathBuf>,
}

impl Options {
    fn of(mut arguments: impl Iterator<Item = String>) -> Result<Self, Failure> {
        let mut options = Self::default();
        while let Some(name) = arguments.next() {
            let value = arguments.next().ok_or_else(|| format!("{name} needs a value"))?;
            match name.as_str() {
                "--frames" => options.frames = Some(value.parse()?),
                "--picture" => options.picture = Some(value.into()),
                _ => return Err(format!("{name}: use --frames N or --picture FILE").into()),
            }
        }
        match options.frames {
            Some(0) => Err("--frames must be at least 1".into()),
            None if options.picture.is_some() => Err("--picture needs --frames".into()),
            _ => Ok(options),
        }
    }
}

/// The program, from its start to its end.
struct Program {
    options: Options,
    instance: wgpu::Instance,
    /// Everything that needs a window; `None` until the window is there.
    running: Option<Running>,
    failure: Option<Failure>,
}

/// What a frame needs.
struct Running {
    window: Arc<Window>,
    queue: wgpu::Queue,
    targets: Targets,
    world: World,
    eye: Eye,
    /// Why the device is gone, once it is.
    lost: Arc<OnceLock<String>>,
    clock: Clock,
}

impl Running {
    /// Opens a window and a device, and loads the world.
    fn new(events: &ActiveEventLoop, instance: &wgpu::Instance, options: &Options) -> Result<Self, Failure> {
        let attributes = Window::default_attributes()
            .with_title("relievo: loading")
            .with_inner_size(LogicalSize::new(1280, 720));
        let window = Arc::new(events.create_window(attributes)?);
        let surface = instance.create_surface(window.clone())?;
        let wanted = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::from_env().unwrap_or_default(),
            compatible_surface: Some(&surface),
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&wanted))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        let lost = Arc::new(OnceLock::new());
        let heard = lost.clone();
        device.set_device_lost_callback(move |_, reason| _ = heard.set(reason));
        let saves = options.picture.is_some();
        let targets = Targets::new(instance, &adapter, &device, (window.clone(), surface), saves)?;
        let world = World::new(&device, &queue, targets.format())?;
        let clock = Clock::new(options.frames);
        Ok(Self { window, queue, targets, world, eye: Eye::default(), lost, clock })
    }

    /// Draws a frame. Returns whether there was something to draw into; if not, try again a little later.
    fn frame(&mut self, picture: Option<&PathBuf>) -> Result<bool, Failure> {
        if let Some(reason) = self.lost.get() {
            return Err(format!("the device is lost: {reason}").into());
        }
        // First of all: what is recorded must be submitted, and without a texture there is nothing to submit.
        let Some(texture) = self.targets.next()? else { return Ok(false) };
        let seconds = self.clock.tick();
        self.eye.advance(seconds);
        let mut encoder = self.targets.device().create_command_encoder(&Default::default());
        self.world.record(&mut encoder, &self.eye, self.targets.size(), seconds)?;
        {
            let mut pass = self.targets.pass(&mut encoder, &texture.texture);
            self.world.draw(&mut pass)?;
            // Draws of the program's own go into the same pass.
        }
        let saved = picture.filter(|_| self.clock.is_last());
        let copy = saved.map(|path| (path, self.targets.copy(&mut encoder, &texture.texture)));
        self.queue.submit([encoder.finish()]);
        self.window.pre_present_notify();
        self.queue.present(texture);
        if let Some((path, copy)) = copy {
            self.targets.save(&copy, path)?;
        }
        if let Some(milliseconds) = self.clock.report() {
            let status = self.world.status();
            self.window.set_title(&format!("relievo: {status}, {milliseconds:.1} ms a frame"));
        }
        Ok(true)
    }
}

impl Program {
    /// Ends with a failure, if there is one.
    fn end_if<T>(&mut self, events: &ActiveEventLoop, result: Result<T, Failure>) -> Option<T> {
        result
            .map_err(|failure| {
                self.failure = Some(failure);
                events.exit();
            })
            .ok()
    }

    fn redraw(&mut self, events: &ActiveEventLoop) {
        let Some(running) = &mut self.running else { return };
        let is_drawn = running.frame(self.options.picture.as_ref());
        let is_last = running.clock.is_last();
        match self.end_if(events, is_drawn) {
            Some(true) if is_last => events.exit(),
            // The display's refresh paces frames: the next one waits for a texture of the surface.
            Some(true) => self.request_redraw(),
            Some(false) => events.set_control_flow(ControlFlow::WaitUntil(Instant::now() + PAUSE)),
            None => (),
        }
    }

    fn request_redraw(&self) {
        if let Some(running) = &self.running {
            running.window.request_redraw();
        }
    }
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.running.is_none() {
            let running = Running::new(events, &self.instance, &self.options);
            self.running = self.end_if(events, running);
            self.request_redraw();
        }
    }

    fn new_events(&mut self, events: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            events.set_control_flow(ControlFlow::Wait);
            self.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(running) = &mut self.running else { return };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::KeyboardInput {
                event: KeyEvent { physical_key: PhysicalKey::Code(key), state, .. },
                ..
            } => match key {
                KeyCode::Escape => events.exit(),
                key => running.eye.key(key, state == ElementState::Pressed),
            },
            WindowEvent::MouseInput { button: MouseButton::Left, state, .. } => {
                running.eye.button(state == ElementState::Pressed);
            }
            WindowEvent::CursorMoved { position, .. } => {
                // Of the window's height, so that neither its size nor the display's scale counts.
                let height = f64::from(running.targets.size()[1]);
                running.eye.cursor([position.x / height, position.y / height]);
            }
            WindowEvent::MouseWheel { delta, .. } => running.eye.wheel(delta),
            WindowEvent::Focused(false) => running.eye.release(),
            // In physical pixels. A change of the display's scale is followed by this event.
            WindowEvent::Resized(size) => running.targets.resize(size),
            WindowEvent::RedrawRequested => self.redraw(events),
            _ => (),
        }
    }
}

/// Counts and times frames.
struct Clock {
    /// Frames after which the program ends.
    frames: Option<u32>,
    drawn: u32,
    last: Instant,
    /// When the title was last set, and the frames since then.
    reported: (Instant, u32),
}

impl Clock {
    fn new(frames: Option<u32>) -> Self {
        let now = Instant::now();
        Self { frames, drawn: 0, last: now, reported: (now, 0) }
    }

    /// Begins a frame; returns the seconds by which the world advances. They do not depend on the machine's speed where
    /// the number of frames is given.
    fn tick(&mut self) -> f32 {
        let elapsed = self.last.elapsed().as_secs_f32();
        self.last = Instant::now();
        self.drawn += 1;
        self.reported.1 += 1;
        if self.frames.is_some() { 1.0 / 60.0 } else { elapsed.min(0.25) }
    }

    fn is_last(&self) -> bool {
        self.frames.is_some_and(|frames| self.drawn >= frames)
    }

    /// Milliseconds a frame, twice a second.
    fn report(&mut self) -> Option<f64> {
        let (since, frames) = self.reported;
        let elapsed = since.elapsed();
        if elapsed < Duration::from_millis(500) {
            return None;
        }
        self.reported = (Instant::now(), 0);
        Some(elapsed.as_secs_f64() * 1e3 / f64::from(frames.max(1)))
    }
}
