//! Square height fields of a batch on the device, one after the other.

use crate::gpu::{Buffer, Gpu, GpuError};

/// `count` fields of `width`² heights (1/65536 units), row by row.
#[derive(Debug, Clone)]
pub struct Fields {
    /// The heights.
    pub heights: Buffer<i32>,
    /// Samples along an edge of a field.
    pub width: u32,
    /// Fields in the buffer.
    pub count: u32,
}

impl Fields {
    /// Zeroed fields.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, label: &'static str, width: u32, count: u32) -> Result<Self, GpuError> {
        let points = width as usize * width as usize * count as usize;
        Ok(Self { heights: Buffer::new(gpu, label, points)?, width, count })
    }

    /// Fields of `width` that one binding and one dispatch may hold, at least one.
    pub fn most(gpu: &Gpu, width: u32) -> usize {
        let bytes = 4 * u64::from(width) * u64::from(width);
        (gpu.max_binding() / bytes.max(1)).clamp(1, 65_535) as usize
    }

    /// The same memory seen as smaller fields.
    pub fn cropped(&self, samples: u32) -> Self {
        Self { width: self.width - 2 * samples, ..self.clone() }
    }

    /// Workgroups for one thread a sample of fields that are `crop` samples smaller on every side.
    pub(crate) fn workgroups(&self, kernel: &crate::gpu::Kernel, crop: u32) -> [u32; 3] {
        let width = self.width - 2 * crop;
        [kernel.groups_for(width), width, self.count]
    }
}
