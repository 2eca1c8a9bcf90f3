//! The GPU pass of `kernels/lod/sorted.wgsl`.

use crate::Error;
use crate::gpu::bindings::lod::sorted as bindings;
use crate::gpu::{Gpu, Job, Uniform, pass};
use crate::shared::lod::sorted::SortedParams;

/// Buffers of the kernel that writes sorted draws.
#[doc(inline)]
pub use bindings::Buffers as SortedBuffers;

pass! {
    /// GPU pass that writes the draws of single instances.
    pub struct SortedPass;
}

impl SortedPass {
    /// Prepares a job that writes the first `count` sorted draws. Record the job after [`decide`](crate::lod::decide).
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers with fewer draws; [`crate::gpu::GpuError`] for failures of the device.
    pub fn prepare(&self, gpu: &Gpu, buffers: SortedBuffers<'_>, count: u32) -> Result<Job, Error> {
        let uniform = Uniform::new(gpu, "single", &SortedParams { count })?;
        let lengths = bindings::Lengths { sorted: count as usize };
        let group = buffers.bind(gpu, &self.kernel, &uniform, &lengths)?;
        Ok(Job::spread(gpu, "lod/sorted", &self.kernel, group, count)?)
    }
}
