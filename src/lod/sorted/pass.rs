//! The GPU pass of `kernels/lod/sorted.wgsl`.

use crate::Error;
use crate::gpu::bindings::lod::sorted as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Uniform};
use crate::shared::lod::sorted::SortedParams;

/// Buffers of the kernel that writes sorted draws.
#[doc(inline)]
pub use bindings::Buffers as SortedBuffers;

/// GPU pass that writes the draws of single instances.
#[derive(Debug, Clone)]
pub struct SortedPass {
    kernel: Kernel,
}

impl SortedPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// Errors of the driver's shader compiler.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares a job that writes the first `count` sorted draws. Record the job after [`decide`](crate::lod::decide).
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers with fewer draws; [`GpuError`] for failures of the device.
    pub fn prepare(&self, gpu: &Gpu, buffers: SortedBuffers<'_>, count: u32) -> Result<Job, Error> {
        let uniform = Uniform::new(gpu, "single", &SortedParams { count })?;
        let lengths = bindings::Lengths { sorted: count as usize };
        let group = buffers.bind(gpu, &self.kernel, &uniform, &lengths)?;
        Ok(Job::spread(gpu, "lod/sorted", &self.kernel, group, count)?)
    }
}
