//! The GPU pass of `kernels/lod/decide.wgsl`.

use crate::Error;
use crate::gpu::bindings::lod::decide as bindings;
use crate::gpu::{Gpu, Job, pass};
use crate::lod::BLOCK;

/// The buffers that a decision reads and writes.
#[doc(inline)]
pub use bindings::Buffers as DecideBuffers;

pass! {
    /// GPU pass that decides the levels of detail of a view's instances.
    pub struct DecidePass;
}

impl DecidePass {
    /// Prepares a job for all instances: [`BLOCK`] instances for each element of `block_objects`. Record the job after
    /// [`select`](crate::lod::select).
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers that are too small for these blocks; [`crate::gpu::GpuError`] for failures of the
    /// device.
    pub fn prepare(&self, gpu: &Gpu, buffers: DecideBuffers<'_>) -> Result<Job, Error> {
        let blocks = buffers.block_objects.len();
        let group = buffers.bind(gpu, &self.kernel, &bindings::Lengths { blocks })?;
        Ok(Job::spread(gpu, "lod/decide", &self.kernel, group, BLOCK * blocks as u32)?)
    }
}
