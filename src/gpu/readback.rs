//! Copies of bytes from the device to the host.

use futures_channel::oneshot::{Receiver, channel};

use super::{Gpu, GpuError};

/// A submitted copy from the device, with the receiver that learns of its completion.
pub(super) struct Readback {
    staging: wgpu::Buffer,
    size: u64,
    // Receiver of the mapping's result; `None` if there is nothing to read.
    mapped: Option<Receiver<Result<(), wgpu::BufferAsyncError>>>,
}

impl Readback {
    /// Submits a copy of the first `size` bytes of `buffer`, and maps the copy for reading.
    ///
    /// # Errors
    /// Errors that the device reports.
    pub(crate) fn start(gpu: &Gpu, buffer: &wgpu::Buffer, size: u64) -> Result<Self, GpuError> {
        let padded = size.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        gpu.scoped(|| {
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            let staging = gpu.raw_buffer("readback", padded.max(wgpu::COPY_BUFFER_ALIGNMENT), usage);
            if size == 0 {
                return Self { staging, size, mapped: None };
            }
            let mut encoder = gpu.encoder("readback");
            encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, padded);
            gpu.queue().submit([encoder.finish()]);
            let (sender, receiver) = channel();
            staging.map_async(wgpu::MapMode::Read, .., move |result| {
                // The receiver no longer exists if the caller has dropped the future.
                let _ = sender.send(result);
            });
            Self { staging, size, mapped: Some(receiver) }
        })
    }

    /// Returns the copied bytes once the device has answered. The future stays pending until the device is polled.
    ///
    /// # Errors
    /// [`GpuError::DeviceLost`].
    pub(crate) async fn answer(self) -> Result<Vec<u8>, GpuError> {
        let lost = |reason: String| GpuError::DeviceLost { reason };
        let Some(mapped) = self.mapped else { return Ok(Vec::new()) };
        mapped.await.map_err(|error| lost(error.to_string()))?.map_err(|error| lost(error.to_string()))?;
        let view = self.staging.get_mapped_range(..).map_err(|error| lost(error.to_string()))?;
        Ok(view[..self.size as usize].to_vec())
    }
}
