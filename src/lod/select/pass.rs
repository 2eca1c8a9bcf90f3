//! The GPU pass of `kernels/lod/select.wgsl`.

use crate::Error;
use crate::gpu::bindings::lod::select as bindings;
use crate::gpu::{Gpu, Job, pass};
use crate::lod::BLOCK;

/// The buffers that a selection reads and writes.
#[doc(inline)]
pub use bindings::Buffers as SelectBuffers;

pass! {
    /// GPU pass that selects the instances that a view sees.
    pub struct SelectPass;
}

impl SelectPass {
    /// Prepares a job for all instances: [`BLOCK`] instances for each element of `block_objects`.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers that are too small for these blocks; [`crate::gpu::GpuError`] for failures of the
    /// device.
    pub fn prepare(&self, gpu: &Gpu, buffers: SelectBuffers<'_>) -> Result<Job, Error> {
        let blocks = buffers.block_objects.len();
        let group = buffers.bind(gpu, &self.kernel, &bindings::Lengths { blocks })?;
        Ok(Job::spread(gpu, "lod/select", &self.kernel, group, BLOCK * blocks as u32)?)
    }
}
