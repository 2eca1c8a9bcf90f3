//! The device: opening one, or using that of an embedding program; typed buffers, readback, kernels and timing.
//! This is the only module that opens devices; `render` creates its textures and pipelines on them.
//!
//! Every failure is a [`GpuError`]: no adapter, a lost device, no memory, a validation error. Nothing in this
//! module panics or aborts.

mod adapter;
pub(crate) mod bind;
pub(crate) mod bindings;
mod buffer;
mod job;
mod kernel;
mod memory;
mod readback;
mod readback_ring;
pub mod shaders;
mod shared;
mod timer;
mod tuning;
mod upload;

use std::sync::{Arc, Mutex};
use std::time::Duration;

pub use crate::error::GpuError;
pub use adapter::{AdapterSummary, Options, adapters};
pub use buffer::{Buffer, Uniform};
pub(crate) use job::Step;
pub use job::{IndirectJob, Job, compute_pass};
pub use kernel::{Group, Kernel};
pub(crate) use kernel::{Layouts, layouts, module, pipeline_layout, rows_of_workgroups};
pub use memory::Memory;
pub use readback_ring::ReadbackRing;
pub use timer::{Measurement, TimedBy, Timer};
pub(crate) use tuning::Tuning;
pub use upload::{Staged, StagingRing, Upload};

use shared::Shared;
pub(crate) use shared::{Drawing, Program};

/// The longest wait for the device before it counts as hung.
const PATIENCE: Duration = Duration::from_secs(300);

/// Errors that the handlers of an own device have received.
#[derive(Debug, Default)]
struct Heard {
    lost: Option<String>,
    error: Option<GpuError>,
}

/// A device and its queue, with the properties of the adapter that relievo uses. Clones share the device and
/// the pipelines compiled on it.
#[derive(Debug, Clone)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    summary: AdapterSummary,
    tuning: Tuning,
    heard: Arc<Mutex<Heard>>,
    memory: Arc<Memory>,
    kernels: Arc<Shared<Program, Kernel>>,
    pub(crate) render_pipelines: Arc<Shared<Drawing, RenderPipeline>>,
}

/// A render pipeline with its bind group layouts.
pub(crate) type RenderPipeline = (wgpu::RenderPipeline, Vec<wgpu::BindGroupLayout>);

impl Gpu {
    /// Opens a device of its own, without a window, with WebGPU's default limits. Storage bindings may be
    /// larger and more numerous if the adapter permits it.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] when nothing matches `options`, [`GpuError::NoDevice`] when the adapter
    /// refuses WebGPU's default limits.
    pub fn headless(options: &Options) -> Result<Self, GpuError> {
        pollster::block_on(Self::headless_async(options))
    }

    /// As [`Gpu::headless`], for programs that must not block, for example in a browser.
    ///
    /// # Errors
    /// As [`Gpu::headless`].
    pub async fn headless_async(options: &Options) -> Result<Self, GpuError> {
        let adapter = adapter::choose(options).await?;
        let info = adapter.get_info();
        let wanted = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("relievo"),
            required_features: adapter.features() & wanted,
            required_limits: limits(&adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = (adapter.request_device(&descriptor).await)
            .map_err(|error| GpuError::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        let heard = Arc::new(Mutex::new(Heard::default()));
        listen(&device, &heard);
        Ok(Self { heard, ..Self::new(device, queue, &info) })
    }

    /// Uses the device of an embedding program. The program's error handlers stay in place; relievo wraps its
    /// own calls in error scopes.
    pub fn from_wgpu(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let info = device.adapter_info();
        Self::new(device, queue, &info)
    }

    fn new(device: wgpu::Device, queue: wgpu::Queue, info: &wgpu::AdapterInfo) -> Self {
        let (summary, tuning) = (AdapterSummary::of(info), Tuning::of(info));
        let (heard, memory, kernels, render_pipelines) = Default::default();
        Self { device, queue, summary, tuning, heard, memory, kernels, render_pipelines }
    }

    /// The wgpu device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The wgpu queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Name, kind and driver of the adapter.
    pub fn adapter(&self) -> &AdapterSummary {
        &self.summary
    }

    /// What is fastest on the adapter.
    pub(crate) fn tuning(&self) -> Tuning {
        self.tuning
    }

    /// The bytes that relievo's storage buffers hold on this device.
    pub fn memory(&self) -> &Arc<Memory> {
        &self.memory
    }

    /// The largest storage binding in bytes: at least WebGPU's default of 128 MiB.
    pub fn max_binding(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    /// A command encoder.
    pub fn encoder(&self, label: &str) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) })
    }

    /// Records with `record`, submits, and waits until the device has finished.
    ///
    /// # Errors
    /// The errors of [`GpuError`] that the device reports.
    pub fn run(&self, label: &str, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> Result<(), GpuError> {
        self.scoped(|| {
            let mut encoder = self.encoder(label);
            record(&mut encoder);
            self.queue.submit([encoder.finish()]);
        })?;
        self.wait()
    }

    /// Waits until everything submitted so far has run.
    ///
    /// # Errors
    /// The loss of the device, an error that was reported in the meantime, or [`GpuError::Hung`].
    pub fn wait(&self) -> Result<(), GpuError> {
        let poll = wgpu::PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
        let polled = self.device.poll(poll);
        self.check()?;
        polled.map(|_| ()).map_err(|_| GpuError::Hung { seconds: PATIENCE.as_secs() })
    }

    /// Checks for errors that the device has reported outside a call that returned them.
    ///
    /// # Errors
    /// The first of these errors.
    pub fn check(&self) -> Result<(), GpuError> {
        let mut heard = self.heard.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(reason) = &heard.lost {
            return Err(GpuError::DeviceLost { reason: reason.clone() });
        }
        heard.error.take().map_or(Ok(()), Err)
    }

    /// Runs `work` and returns the errors that wgpu reports for it.
    ///
    /// # Errors
    /// Out of memory, validation and internal errors caused by `work`.
    pub fn scoped<T>(&self, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        self.check()?;
        // A browser resolves error scopes only after the calling task has returned: there, errors reach the
        // device's handler.
        if cfg!(target_arch = "wasm32") {
            return Ok(work());
        }
        let scopes =
            [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation]
                .map(|filter| self.device.push_error_scope(filter));
        let done = work();
        let mut first = None;
        for scope in scopes.into_iter().rev() {
            let error = pollster::block_on(scope.pop());
            first = first.or(error);
        }
        let Some(error) = first else { return Ok(done) };
        // A lost device rejects every call; polling tells why it was lost.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.check()?;
        Err(GpuError::from(error))
    }
}

/// WebGPU's default limits, with the adapter's own limits for the size and number of storage bindings: some
/// buffers cannot be split, and some kernels replace several others where a shader may bind enough buffers.
fn limits(offered: &wgpu::Limits) -> wgpu::Limits {
    let default = wgpu::Limits::default();
    // Shaders count words in u32 with room to spare.
    let most = u64::from(u32::MAX) / 4 * 4;
    let binding = offered.max_storage_buffer_binding_size.min(offered.max_buffer_size).min(most);
    let buffers = offered.max_storage_buffers_per_shader_stage;
    wgpu::Limits {
        max_storage_buffer_binding_size: default.max_storage_buffer_binding_size.max(binding),
        max_buffer_size: default.max_buffer_size.max(binding),
        max_storage_buffers_per_shader_stage: default.max_storage_buffers_per_shader_stage.max(buffers),
        ..default
    }
}

fn listen(device: &wgpu::Device, heard: &Arc<Mutex<Heard>>) {
    let on_error = heard.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let mut heard = on_error.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        heard.error.get_or_insert_with(|| GpuError::from(error));
    }));
    let on_loss = heard.clone();
    device.set_device_lost_callback(move |reason, message| {
        let mut heard = on_loss.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        heard.lost.get_or_insert(format!("{reason:?}: {message}"));
    });
}
