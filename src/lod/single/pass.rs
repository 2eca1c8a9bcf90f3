//! The GPU pass of `kernels/lod/single.wgsl`.

use crate::Error;
use crate::gpu::bindings::lod::single as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Uniform};
use crate::shared::lod::single::SingleParams;

/// What the draws of single instances are made from, and where they go.
#[doc(inline)]
pub use bindings::Buffers as SingleBuffers;

/// Writes the draws of single instances.
#[derive(Debug, Clone)]
pub struct SinglePass {
    kernel: Kernel,
}

impl SinglePass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the draws of the first `count` of the singles. Record it after [`select`](crate::lod::select).
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers with fewer; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, buffers: SingleBuffers<'_>, count: u32) -> Result<Job, Error> {
        let uniform = Uniform::new(gpu, "single", &SingleParams { count })?;
        let lengths = bindings::Lengths { singles: count as usize };
        let group = buffers.bind(gpu, &self.kernel, &uniform, &lengths)?;
        Ok(Job::spread(gpu, "lod/single", (&self.kernel, group), count)?)
    }
}
