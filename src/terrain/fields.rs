//! Batches of square height fields on the device, stored one after the other.

use crate::InputError;
use crate::gpu::{Buffer, Gpu, GpuError};

/// `count` square fields of `width`² heights each (1/65536 height units), one field after the other, row by row.
#[derive(Debug, Clone)]
pub struct Fields {
    /// The heights of all fields; the buffer may be longer.
    pub heights: Buffer<i32>,
    /// Samples along an edge of a field.
    pub width: u32,
    /// Number of fields in the buffer.
    pub count: u32,
}

/// Location of a field in a batch that is split into parts, one buffer per part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Place {
    /// Index of the part.
    pub part: usize,
    /// Index of the field within the part.
    pub index: u32,
}

/// Locations of all fields of `parts`, in order. Every field must be `width` samples wide.
///
/// # Errors
/// [`InputError`] that names the part whose width differs or whose buffer is too short.
pub(crate) fn places(parts: &[Fields], width: u32) -> Result<Vec<Place>, InputError> {
    let mut places = Vec::new();
    for (part, fields) in parts.iter().enumerate() {
        let path = format!("parts[{part}].width");
        InputError::check_same(path, fields.width, width, "as parts[0] has it")?;
        fields.heights.check_holds(&format!("parts[{part}].heights"), fields.points(0))?;
        places.extend((0..fields.count).map(|index| Place { part, index }));
    }
    Ok(places)
}

/// Advice in errors about fields that exceed the largest allowed storage binding.
pub(crate) const REMEDY: &str = "split the batch (fewer patches at once), use smaller patches or a smaller apron (fewer \
    iterations of erosion), or compute on the CPU with the functions in the `reference` modules";

/// Puts the buffer with the result first, after `iterations` iterations that alternate between the two buffers.
pub(crate) fn after([windows, other]: [Fields; 2], iterations: u32) -> [Fields; 2] {
    let width = windows.cropped(iterations).width;
    let [made, rest] = if iterations.is_multiple_of(2) { [windows, other] } else { [other, windows] };
    [Fields { width, ..made }, Fields { width: width.saturating_sub(2), ..rest }]
}

impl Fields {
    /// Allocates `count` fields of `width`² heights, all 0.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, label: &'static str, width: u32, count: u32) -> Result<Self, GpuError> {
        let points = width as usize * width as usize * count as usize;
        let heights = Buffer::new(gpu, label, points).map_err(|error| error.with_remedy(REMEDY))?;
        Ok(Self { heights, width, count })
    }

    /// Largest number of fields of this width in one part, at least 1. A part must fit one dispatch and a storage binding of
    /// WebGPU's default size, 128 MiB. This limit also applies on devices that allow more, so that the work on one part stays
    /// short.
    pub fn most(gpu: &Gpu, width: u32) -> usize {
        let bytes = 4 * u64::from(width) * u64::from(width);
        let binding = gpu.max_binding().min(wgpu::Limits::default().max_storage_buffer_binding_size);
        (binding / bytes.max(1)).clamp(1, 65_535) as usize
    }

    /// Reads the heights of each field, in order. Waits for the device.
    ///
    /// # Errors
    /// [`GpuError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<Vec<i32>>, GpuError> {
        gpu.block_on(self.read(gpu))
    }

    /// Reads the heights of each field, in order; see [`Buffer::read`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<Vec<i32>>, GpuError> {
        let points = (self.width as usize).pow(2);
        let all = self.heights.read(gpu).await?;
        Ok(all.chunks_exact(points).take(self.count as usize).map(<[i32]>::to_vec).collect())
    }

    /// The same buffer, viewed as fields that are `samples` smaller on every side. If nothing is left, the fields' width is 0.
    pub fn cropped(&self, samples: u32) -> Self {
        Self { width: self.inner_width(samples), ..self.clone() }
    }

    /// Width of the fields after removal of `crop` samples on every side.
    fn inner_width(&self, crop: u32) -> u32 {
        self.width.saturating_sub(crop.saturating_mul(2))
    }

    /// Thread counts of a kernel with one thread per sample, after removal of `crop` samples on every side of each field.
    pub fn threads(&self, crop: u32) -> [u32; 3] {
        let width = self.inner_width(crop);
        [width, width, self.count]
    }

    /// Number of samples in all fields together, after removal of `crop` samples on every side of each field.
    pub fn points(&self, crop: u32) -> usize {
        (self.inner_width(crop) as usize).pow(2) * self.count as usize
    }

    /// Checks that samples remain after removal of `crop` samples on every side, and that the buffer holds all fields.
    ///
    /// # Errors
    /// [`InputError`] that names `field`, the caller's name for these fields.
    pub fn check(&self, field: &str, crop: u32) -> Result<(), InputError> {
        if self.inner_width(crop) == 0 {
            let bound = format!("must exceed {}, a rim of {crop} samples", crop.saturating_mul(2));
            return Err(InputError::new(format!("{field}.width"), self.width, bound));
        }
        self.heights.check_holds(&format!("{field}.heights"), self.points(0))
    }
}
