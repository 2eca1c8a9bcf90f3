//! The GPU pass of `kernels/terrain/limit.wgsl`.

use super::ErosionLimit;
use crate::Error;
use crate::gpu::bindings::terrain::limit as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use crate::shared::terrain::limit::LimitParams;

/// Keeps eroded heights within a distance of the heights before erosion.
#[derive(Debug, Clone)]
pub struct LimitPass {
    kernel: Kernel,
}

/// Buffers of heights in 1/65536 units.
#[derive(Debug, Clone, Copy)]
pub struct LimitBuffers<'a> {
    /// Read: the heights before erosion.
    pub origins: &'a Buffer<i32>,
    /// Read and written: the eroded heights.
    pub heights: &'a Buffer<i32>,
}

impl LimitPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares a job for the first `points` heights of both buffers. Heights must be below 2^30 in size.
    ///
    /// # Errors
    /// [`crate::InputError`] for a limit out of bounds and for buffers that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        limit: ErosionLimit,
        points: usize,
        buffers: LimitBuffers<'_>,
    ) -> Result<Job, Error> {
        limit.validate()?;
        buffers.origins.check_holds("origins", points)?;
        buffers.heights.check_holds("heights", points)?;
        let params = LimitParams { points: points as u32, most: limit.fixed_depth() };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "limit of erosion", &params)?,
            origins: buffers.origins.slice(),
            heights: buffers.heights.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "terrain/limit", &self.kernel, group, points as u32)?)
    }
}
