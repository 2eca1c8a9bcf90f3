//! Typed device buffers, and reading them back.

use std::marker::PhantomData;
use std::sync::Arc;

use encase::internal::WriteInto;
use encase::{ShaderSize, UniformBuffer};

use super::memory::Held;
use super::readback::Readback;
use super::{Gpu, GpuError};
use crate::InputError;

/// Granularity of buffer sizes, in bytes.
const ROOM: usize = 16;

// What needs no type stands outside of the generic types: it is compiled once.

/// Creates a storage buffer of at least `bytes` bytes.
fn storage(gpu: &Gpu, label: &'static str, bytes: usize) -> Result<(wgpu::Buffer, Arc<Held>), GpuError> {
    let size = bytes.next_multiple_of(ROOM) as u64;
    if size > gpu.max_binding() {
        return Err(GpuError::Limit {
            pass: label,
            limit: "maxStorageBufferBindingSize",
            needed: size,
            available: gpu.max_binding(),
            remedy: "split the batch",
        });
    }
    gpu.memory().check(label, size)?;
    let usage = wgpu::BufferUsages::STORAGE
        | wgpu::BufferUsages::VERTEX
        | wgpu::BufferUsages::INDEX
        | wgpu::BufferUsages::INDIRECT
        | wgpu::BufferUsages::COPY_SRC
        | wgpu::BufferUsages::COPY_DST;
    Ok((create(gpu, label, size, usage)?, Arc::new(gpu.memory().hold(label, size))))
}

fn create(gpu: &Gpu, label: &str, size: u64, usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, GpuError> {
    gpu.scoped(|| gpu.raw_buffer(label, size, usage))
}

fn uniform(gpu: &Gpu, label: &str, bytes: &[u8]) -> Result<wgpu::Buffer, GpuError> {
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    let raw = create(gpu, label, bytes.len().next_multiple_of(16) as u64, usage)?;
    write(gpu, &raw, 0, bytes)?;
    Ok(raw)
}

fn check_fits(len: usize, first: usize, count: usize) -> Result<(), GpuError> {
    if first.saturating_add(count) > len {
        let reason = format!("{count} elements from {first} on do not fit a buffer of {len}");
        return Err(GpuError::Validation { reason });
    }
    Ok(())
}

fn check_holds(len: usize, field: &str, needed: usize) -> Result<(), InputError> {
    if len >= needed {
        return Ok(());
    }
    Err(InputError::new(field, format!("[{len} elements]"), format!("must hold at least {needed}")))
}

/// Replaces the bytes from `offset` on.
fn write(gpu: &Gpu, raw: &wgpu::Buffer, offset: usize, bytes: &[u8]) -> Result<(), GpuError> {
    gpu.scoped(|| gpu.queue().write_buffer(raw, offset as u64, bytes))
}

/// Reads the first `size` bytes.
async fn read(gpu: &Gpu, raw: &wgpu::Buffer, size: u64) -> Result<Vec<u8>, GpuError> {
    let answer = Readback::start(gpu, raw, size)?.answer().await;
    // The error of the copy itself is more precise than the error of the failed mapping.
    gpu.check_async().await?;
    answer
}

/// A storage buffer of `len` elements. It is also usable as a vertex, index and indirect buffer, and as source and destination
/// of copies.
#[derive(Debug, Clone)]
pub struct Buffer<T> {
    pub(super) raw: wgpu::Buffer,
    _held: Arc<Held>,
    len: usize,
    element: PhantomData<T>,
}

impl<T: bytemuck::Pod> Buffer<T> {
    /// Creates a buffer of zeros.
    ///
    /// An empty buffer is allocated with the size of one element, because WebGPU binds no empty ranges. Every size is rounded
    /// up to a multiple of 16 bytes, so kernels may read and write four words at a time.
    ///
    /// # Errors
    /// [`GpuError::Limit`] if the buffer exceeds the largest storage binding; [`GpuError::OutOfMemory`] if there is not enough
    /// memory.
    pub fn new(gpu: &Gpu, label: &'static str, len: usize) -> Result<Self, GpuError> {
        let (raw, held) = storage(gpu, label, len.max(1) * size_of::<T>())?;
        Ok(Self { raw, _held: held, len, element: PhantomData })
    }

    /// Creates a buffer that holds `data`.
    ///
    /// # Errors
    /// The errors of [`Buffer::new`].
    pub fn from_slice(gpu: &Gpu, label: &'static str, data: &[T]) -> Result<Self, GpuError> {
        let buffer = Self::new(gpu, label, data.len())?;
        buffer.write(gpu, data)?;
        Ok(buffer)
    }

    /// Creates a buffer that holds `data` and never changes. On a deferring device, the upload waits until the program sends it
    /// ([`Gpu::deferring`]).
    ///
    /// # Errors
    /// The errors of [`Buffer::new`].
    pub(crate) fn constant(gpu: &Gpu, label: &'static str, data: &[T]) -> Result<Self, GpuError> {
        let buffer = Self::new(gpu, label, data.len())?;
        gpu.fill_buffer(&buffer.raw, bytemuck::cast_slice(data))?;
        Ok(buffer)
    }

    /// Replaces the first `data.len()` elements.
    ///
    /// # Errors
    /// [`GpuError::Validation`] if `data` is longer than the buffer.
    pub fn write(&self, gpu: &Gpu, data: &[T]) -> Result<(), GpuError> {
        self.write_at(gpu, 0, data)
    }

    /// Checks that `count` elements from `first` on lie in the buffer. wgpu's own check is not enough, because the allocation
    /// may be larger than `len` elements.
    ///
    /// # Errors
    /// [`GpuError::Validation`] if the elements reach beyond the buffer's end.
    pub(super) fn has(&self, first: usize, count: usize) -> Result<(), GpuError> {
        check_fits(self.len, first, count)
    }

    /// Replaces `data.len()` elements, starting at element `first`.
    ///
    /// # Errors
    /// [`GpuError::Validation`] if `data` reaches beyond the buffer's end.
    pub fn write_at(&self, gpu: &Gpu, first: usize, data: &[T]) -> Result<(), GpuError> {
        self.has(first, data.len())?;
        write(gpu, &self.raw, first * size_of::<T>(), bytemuck::cast_slice(data))
    }

    /// Reads all elements back. The values include all work that was submitted before the future is first polled.
    ///
    /// The call never blocks: the future wakes when the device has answered. In a browser, the event loop drives the future.
    /// Elsewhere, the program must poll the device, or the future never wakes. Call `gpu.device().poll(wgpu::PollType::Poll)`
    /// once per frame, or `Gpu::wait` on a separate thread.
    ///
    /// # Errors
    /// Errors that the device reports.
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<T>, GpuError> {
        let bytes = read(gpu, &self.raw, (self.len * size_of::<T>()) as u64).await?;
        // The mapped bytes may be unaligned. So the elements are copied, not cast in place.
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// Reads all elements back like [`Buffer::read`], but blocks until the device has finished. Not available in browsers,
    /// where the answer never arrives while a program waits.
    ///
    /// # Errors
    /// Errors that the device reports, or [`GpuError::Hung`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<T>, GpuError> {
        gpu.block_on(self.read(gpu))
    }

    /// The underlying wgpu buffer.
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.raw
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the buffer has no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns a handle to the same bytes, as elements of another type.
    pub(super) fn of_elements<U>(&self) -> Buffer<U> {
        let len = self.len * size_of::<T>() / size_of::<U>();
        Buffer { raw: self.raw.clone(), _held: self._held.clone(), len, element: PhantomData }
    }

    /// Checks that the buffer holds at least `needed` elements.
    ///
    /// # Errors
    /// [`InputError`] that names `field`, if the buffer holds fewer.
    pub fn check_holds(&self, field: &str, needed: usize) -> Result<(), InputError> {
        check_holds(self.len, field, needed)
    }

    /// Allocated size of the buffer in bytes, including the rounding.
    pub fn bytes(&self) -> u64 {
        self.raw.size()
    }
}

/// A uniform buffer that holds one value of type `T`, in WGSL's layout.
#[derive(Debug, Clone)]
pub struct Uniform<T> {
    raw: wgpu::Buffer,
    value: PhantomData<T>,
}

impl<T: ShaderSize + WriteInto> Uniform<T> {
    /// Creates a uniform buffer that holds `value`.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, label: &'static str, value: &T) -> Result<Self, GpuError> {
        Ok(Self { raw: uniform(gpu, label, &uniform_bytes(value)?)?, value: PhantomData })
    }

    /// Replaces the value in the buffer.
    ///
    /// # Errors
    /// Errors that the device reports.
    pub fn write(&self, gpu: &Gpu, value: &T) -> Result<(), GpuError> {
        write(gpu, &self.raw, 0, &uniform_bytes(value)?)
    }

    /// The underlying wgpu buffer.
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.raw
    }
}

/// Encodes `value` in WGSL's layout for uniform buffers.
///
/// # Errors
/// [`GpuError::Internal`] if encase cannot encode the value.
pub(crate) fn uniform_bytes<T: ShaderSize + WriteInto>(value: &T) -> Result<Vec<u8>, GpuError> {
    let mut writer = UniformBuffer::new(Vec::new());
    writer.write(value).map_err(|error| GpuError::Internal { reason: error.to_string() })?;
    Ok(writer.into_inner())
}
