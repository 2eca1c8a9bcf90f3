//! The GPU pass of `kernels/lod/attach.wgsl`.

use super::AttachParams;
use crate::Error;
use crate::gpu::bindings::lod::attach as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Uniform};

/// The buffers that attaching reads and writes.
#[doc(inline)]
pub use bindings::Buffers as AttachBuffers;

/// Places attached meshes.
#[derive(Debug, Clone)]
pub struct AttachPass {
    kernel: Kernel,
}

impl AttachPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the placements of the meshes in one view, one for each element of `attachments`. Record it after the
    /// view's selection and the character's model matrices.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for `allowed`, placements, last instances or kept bones with too few elements;
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        params: &Uniform<AttachParams>,
        buffers: AttachBuffers<'_>,
    ) -> Result<Job, Error> {
        let (instances, attachments) = (buffers.instances.len(), buffers.attachments.len());
        let is_kept = buffers.last_instances.raw() != buffers.instances.raw();
        let placements = if is_kept { 2 } else { 1 } * instances;
        let lengths = bindings::Lengths { attachments, instances, placements };
        let group = buffers.bind(gpu, &self.kernel, params, &lengths)?;
        Ok(Job::spread(gpu, "lod/attach", &self.kernel, group, attachments as u32)?)
    }
}
