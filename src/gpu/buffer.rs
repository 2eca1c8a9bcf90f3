//! Typed device buffers and their readback.

use std::marker::PhantomData;
use std::sync::Arc;

use encase::internal::WriteInto;
use encase::{ShaderSize, UniformBuffer};

use super::memory::Held;
use super::readback::Readback;
use super::{Gpu, GpuError};
use crate::InputError;

/// Granularity of buffer sizes in bytes.
const ROOM: usize = 16;

/// A storage buffer of `len` elements. Usable as storage, vertex, index and indirect buffer, and as copy source and
/// destination.
#[derive(Debug, Clone)]
pub struct Buffer<T> {
    pub(super) raw: wgpu::Buffer,
    _held: Arc<Held>,
    len: usize,
    element: PhantomData<T>,
}

impl<T: bytemuck::Pod> Buffer<T> {
    /// A buffer of zeros.
    ///
    /// An empty buffer has room for one element, because WebGPU binds no empty ranges. Every buffer has room for whole
    /// vectors of four words, so kernels may read and write four words at a time.
    ///
    /// # Errors
    /// [`GpuError::Limit`] if it exceeds the largest binding, [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, label: &'static str, len: usize) -> Result<Self, GpuError> {
        let size = (len.max(1) * size_of::<T>()).next_multiple_of(ROOM) as u64;
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
        let raw = gpu.scoped(|| {
            let descriptor =
                wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
            gpu.device().create_buffer(&descriptor)
        })?;
        Ok(Self { raw, _held: Arc::new(gpu.memory().hold(label, size)), len, element: PhantomData })
    }

    /// A buffer that holds `data`.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn from_slice(gpu: &Gpu, label: &'static str, data: &[T]) -> Result<Self, GpuError> {
        let buffer = Self::new(gpu, label, data.len())?;
        buffer.write(gpu, data)?;
        Ok(buffer)
    }

    /// As [`Buffer::from_slice`], for data that never changes. On a deferring device the upload waits
    /// ([`Gpu::deferring`]).
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub(crate) fn constant(gpu: &Gpu, label: &'static str, data: &[T]) -> Result<Self, GpuError> {
        let buffer = Self::new(gpu, label, data.len())?;
        gpu.fill_buffer(&buffer.raw, bytemuck::cast_slice(data))?;
        Ok(buffer)
    }

    /// Replaces the first `data.len()` elements.
    ///
    /// # Errors
    /// [`GpuError::Validation`] when `data` is longer than the buffer.
    pub fn write(&self, gpu: &Gpu, data: &[T]) -> Result<(), GpuError> {
        self.write_at(gpu, 0, data)
    }

    /// Refuses elements beyond the buffer's end; the allocation may be larger.
    ///
    /// # Errors
    /// [`GpuError::Validation`].
    pub(super) fn has(&self, first: usize, count: usize) -> Result<(), GpuError> {
        if first.saturating_add(count) > self.len() {
            let reason = format!("{count} elements from {first} on do not fit a buffer of {}", self.len());
            return Err(GpuError::Validation { reason });
        }
        Ok(())
    }

    /// Replaces `data.len()` elements, starting at `first`.
    ///
    /// # Errors
    /// [`GpuError::Validation`] when they reach beyond the buffer's end.
    pub fn write_at(&self, gpu: &Gpu, first: usize, data: &[T]) -> Result<(), GpuError> {
        self.has(first, data.len())?;
        let offset = (first * size_of::<T>()) as u64;
        gpu.scoped(|| gpu.queue().write_buffer(&self.raw, offset, bytemuck::cast_slice(data)))
    }

    /// Reads all elements back. The values include all work that was submitted before the first poll.
    ///
    /// The call never blocks: the future wakes when the device has answered. A browser's event loop drives it.
    /// Elsewhere the program must poll the device, or the future never wakes: call
    /// `gpu.device().poll(wgpu::PollType::Poll)` once per frame, or `Gpu::wait` on a thread of its own.
    ///
    /// # Errors
    /// Errors of the device.
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<T>, GpuError> {
        let answer = Readback::start(gpu, &self.raw, self.content_bytes())?.answer().await;
        // The copy's own error is more precise than the failed map.
        gpu.check_async().await?;
        let bytes = answer?;
        // The mapped bytes may be unaligned, so the elements are copied and not cast in place.
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// As [`Buffer::read`], but blocks until the device has finished. Not available in browsers, where the answer never
    /// arrives while a program waits.
    ///
    /// # Errors
    /// Errors of the device, or [`GpuError::Hung`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<T>, GpuError> {
        gpu.block_on(self.read(gpu))
    }

    fn content_bytes(&self) -> u64 {
        (self.len * size_of::<T>()) as u64
    }

    /// The wgpu buffer.
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.raw
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it has no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The same bytes as elements of another type.
    pub(super) fn of_elements<U>(&self) -> Buffer<U> {
        let len = self.len * size_of::<T>() / size_of::<U>();
        Buffer { raw: self.raw.clone(), _held: self._held.clone(), len, element: PhantomData }
    }

    /// Checks that the buffer holds at least `needed` elements.
    ///
    /// # Errors
    /// [`InputError`] that names `field`.
    pub fn check_holds(&self, field: &str, needed: usize) -> Result<(), InputError> {
        if self.len >= needed {
            return Ok(());
        }
        let value = format!("[{} elements]", self.len);
        Err(InputError::new(field, value, format!("must hold at least {needed}")))
    }

    /// Size of the buffer in bytes.
    pub fn bytes(&self) -> u64 {
        self.raw.size()
    }
}

/// A uniform buffer with WGSL's layout of `T`.
#[derive(Debug, Clone)]
pub struct Uniform<T> {
    raw: wgpu::Buffer,
    value: PhantomData<T>,
}

impl<T: ShaderSize + WriteInto> Uniform<T> {
    /// A uniform buffer that holds `value`.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, label: &'static str, value: &T) -> Result<Self, GpuError> {
        let raw = gpu.scoped(|| {
            gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: T::SHADER_SIZE.get().next_multiple_of(16),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })?;
        let uniform = Self { raw, value: PhantomData };
        uniform.write(gpu, value)?;
        Ok(uniform)
    }

    /// Replaces the value.
    ///
    /// # Errors
    /// Errors of the device.
    pub fn write(&self, gpu: &Gpu, value: &T) -> Result<(), GpuError> {
        let bytes = uniform_bytes(value)?;
        gpu.scoped(|| gpu.queue().write_buffer(&self.raw, 0, &bytes))
    }

    /// The wgpu buffer.
    pub fn raw(&self) -> &wgpu::Buffer {
        &self.raw
    }
}

/// The bytes of `value` in WGSL's uniform layout.
///
/// # Errors
/// [`GpuError::Internal`] when encase cannot write them.
pub(crate) fn uniform_bytes<T: ShaderSize + WriteInto>(value: &T) -> Result<Vec<u8>, GpuError> {
    let mut writer = UniformBuffer::new(Vec::new());
    writer.write(value).map_err(|error| GpuError::Internal { reason: error.to_string() })?;
    Ok(writer.into_inner())
}
