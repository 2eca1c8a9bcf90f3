//! The GPU pass of `kernels/lod/attach.wgsl`.

use super::AttachParams;
use crate::Error;
use crate::gpu::bindings::lod::attach as bindings;
use crate::gpu::{Gpu, Job, Uniform, pass};

/// Buffers of the kernel that places attached meshes.
#[doc(inline)]
pub use bindings::Buffers as AttachBuffers;

pass! {
    /// GPU pass that computes the placements of meshes attached to bones.
    pub struct AttachPass;
}

impl AttachPass {
    /// Prepares a job that places the attached meshes of one view, one mesh for each element of `attachments`. Record the job
    /// after the view's selection, and after the character's model matrices are computed.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers with too few elements (`allowed`, placements, last instances, kept bones);
    /// [`crate::gpu::GpuError`] for failures of the device.
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
