//! GPU access: opens a device or uses the embedding program's device; typed buffers, readback, kernels and timing. Only this
//! module opens devices; `render` creates textures and pipelines on them.
//!
//! Every failure is a [`GpuError`]: no adapter, a lost device, no memory, a validation error. Nothing in this module panics or
//! aborts.
//!
//! Every function that waits for the device has two forms. One form blocks. It does not exist on `wasm32`, because a browser
//! forbids waiting. The other form is a future whose name ends in `_async` (for reading, [`Buffer::read`]). The future does not
//! poll the device: a browser drives it, and natively the program must poll the device meanwhile. Further differences are
//! documented at the functions.

mod adapter;
#[doc(hidden)]
pub mod bind;
#[doc(hidden)]
pub mod bindings;
mod buffer;
mod errors;
mod identity;
mod job;
mod kernel;
mod limits;
mod memory;
mod pending;
mod readback;
mod readback_ring;
pub mod shaders;
mod shared;
mod texture;
mod upload;
mod wait;

use std::sync::Arc;

use crate::InputError;
pub use crate::error::GpuError;
#[cfg(not(target_arch = "wasm32"))]
pub use adapter::adapters;
pub use adapter::{AdapterSummary, Options};
pub use buffer::{Buffer, Uniform};
pub use job::{Job, ParamsJob, Step, compute_pass};
pub use kernel::{Group, Kernel};
pub(crate) use kernel::{Layouts, pass, rows_of_workgroups};
pub use memory::Memory;
pub(crate) use pending::PendingUploads;
pub use readback_ring::ReadbackRing;
pub(crate) use shared::{RenderProgram, Shared};
pub(crate) use upload::StagingStream;
pub use upload::{Staged, StagingRing, Upload};

use errors::Errors;
use identity::Identity;
use shared::Program;

/// A device and its queue, with the adapter's properties that relievo uses. Clones share the device and the pipelines compiled
/// on it.
#[derive(Debug, Clone)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    identity: Identity,
    summary: AdapterSummary,
    errors: Errors,
    memory: Arc<Memory>,
    kernels: Arc<Shared<Program, Kernel>>,
    /// Render pipelines of the crate's own shaders.
    pub(crate) pipelines: Arc<Shared<RenderProgram, wgpu::RenderPipeline>>,
    /// Deferred uploads of data that never changes; `None` unless the device is deferring.
    pending: Option<PendingUploads>,
}

impl Gpu {
    /// Opens a new device without a window, with WebGPU's default limits. Only buffers and storage bindings may be larger, as
    /// far as the adapter permits.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] if no adapter matches `options`. [`GpuError::NoDevice`] if the adapter refuses WebGPU's default
    /// limits.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn headless(options: &Options) -> Result<Self, GpuError> {
        pollster::block_on(Self::headless_async(options))
    }

    /// Opens a new device like `Gpu::headless`, but without blocking. In a browser, this is the only form.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] if no adapter matches `options`. [`GpuError::NoDevice`] if the adapter refuses WebGPU's default
    /// limits.
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
        let gpu = Self::new(device, queue, &info);
        gpu.errors.listen(&gpu.device);
        Ok(gpu)
    }

    /// Uses the device of an embedding program. The program's handlers for errors and for device loss stay in place: the crate
    /// wraps its own calls in error scopes, and detects device loss without a handler.
    pub fn from_wgpu(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let info = device.adapter_info();
        let gpu = Self::new(device, queue, &info);
        // A browser calls every callback of a device, so the program's callback stays in effect.
        #[cfg(target_arch = "wasm32")]
        gpu.errors.listen_for_loss(&gpu.device);
        gpu
    }

    fn new(device: wgpu::Device, queue: wgpu::Queue, info: &wgpu::AdapterInfo) -> Self {
        let summary = AdapterSummary::of(info);
        let (errors, memory, kernels, pipelines) = Default::default();
        let identity = Identity::of(&device);
        Self { device, queue, identity, summary, errors, memory, kernels, pipelines, pending: None }
    }

    /// Whether another handle belongs to the same device.
    pub(crate) fn is_same_device(&self, other: &Self) -> bool {
        self.identity == other.identity
    }

    /// Whether an encoder or a pass can record this device's resources. The closure `record` receives a buffer of 4 bytes, and
    /// records a use of this buffer: it binds the buffer as an index buffer, or clears it.
    ///
    /// The result is `false` for encoders and passes of another [`wgpu::Instance`]. wgpu itself refuses encoders and passes of
    /// another device of the same instance.
    pub(crate) fn is_taken<'a>(&'a self, record: impl FnOnce(&'a wgpu::Buffer)) -> bool {
        self.identity.is_taken(record)
    }

    /// Runs `work` with the caller's objects, and returns its errors like [`Gpu::scoped`]. `None` if the objects belong to
    /// another [`wgpu::Instance`].
    ///
    /// # Errors
    /// The errors of [`Gpu::scoped`].
    pub(crate) fn scoped_with<T>(&self, work: impl FnOnce() -> T) -> Result<Option<T>, GpuError> {
        identity::caught(|| self.scoped(work)).transpose()
    }

    /// Refuses an encoder of another [`wgpu::Instance`].
    ///
    /// # Errors
    /// [`InputError`] that names the encoder.
    pub(crate) fn check_encoder(&self, encoder: &mut wgpu::CommandEncoder) -> Result<(), InputError> {
        match self.is_taken(|probe| encoder.clear_buffer(probe, 0, Some(0))) {
            true => Ok(()),
            false => Err(foreign("encoder")),
        }
    }

    /// The underlying wgpu device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The underlying wgpu queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Name, kind, driver and backend of the adapter.
    pub fn adapter(&self) -> &AdapterSummary {
        &self.summary
    }

    /// Number of bytes that relievo's storage buffers hold on this device.
    pub fn memory(&self) -> &Arc<Memory> {
        &self.memory
    }

    /// Largest size of a storage binding in bytes, at least WebGPU's default of 128 MiB. It is a multiple of 16, like all
    /// [`Buffer`] sizes.
    pub fn max_binding(&self) -> u64 {
        let limits = self.device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        most - most % 16
    }

    /// Creates an unmapped buffer. The caller must hold an error scope.
    fn raw_buffer(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let descriptor =
            wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        self.device.create_buffer(&descriptor)
    }

    /// Creates a command encoder on this device.
    pub fn encoder(&self, label: &str) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) })
    }
}

/// Error for an encoder or a pass that belongs to another [`wgpu::Instance`].
pub(crate) fn foreign(path: &str) -> InputError {
    let bound = "must be of the device on which the scene was made, or rebuilt";
    InputError::new(path, "of another wgpu::Instance", bound)
}

/// Limits to request: WebGPU's defaults, but the adapter's own limit for storage bindings, because some buffers cannot be
/// split.
fn limits(offered: &wgpu::Limits) -> wgpu::Limits {
    let default = wgpu::Limits::default();
    // Shaders count words in u32. As a margin, a binding is limited to fewer than 2^32 bytes.
    let most = u64::from(u32::MAX) / 4 * 4;
    let binding = offered.max_storage_buffer_binding_size.min(offered.max_buffer_size).min(most);
    wgpu::Limits {
        max_storage_buffer_binding_size: default.max_storage_buffer_binding_size.max(binding),
        max_buffer_size: default.max_buffer_size.max(binding),
        ..default
    }
}
