//! The GPU pass of `kernels/lod/assign.wgsl`.

use super::AssignParams;
use crate::Error;
use crate::gpu::bindings::lod::assign as bindings;
use crate::gpu::{Gpu, Job, Uniform, pass};

/// The buffers that an assignment reads and writes.
#[doc(inline)]
pub use bindings::Buffers as AssignBuffers;

pass! {
    /// GPU pass that divides allowed displacements between bone gates and skinning.
    pub struct AssignPass;
}

impl AssignPass {
    /// Prepares a job for at most `instances` instances. [`AssignParams::instances`] is the number in use.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers that hold fewer instances; [`crate::gpu::GpuError`] for failures of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        params: &Uniform<AssignParams>,
        buffers: AssignBuffers<'_>,
        instances: u32,
    ) -> Result<Job, Error> {
        let lengths = bindings::Lengths { instances: instances as usize };
        let group = buffers.bind(gpu, &self.kernel, params, &lengths)?;
        Ok(Job::spread(gpu, "lod/assign", &self.kernel, group, instances)?)
    }
}
