//! The GPU pass of `kernels/lod/attach.wgsl`.

use super::{AttachParams, Attachment, KeptBone};
use crate::Error;
use crate::animation::ModelMatrices;
use crate::gpu::bindings::lod::attach as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use crate::lod::{SceneInstance, SelectView};

/// What attaching reads and writes.
#[derive(Debug, Clone, Copy)]
pub struct AttachBuffers<'a> {
    /// The number of attached meshes, and where the character's instances lie.
    pub params: &'a Uniform<AttachParams>,
    /// The view.
    pub view: &'a Uniform<SelectView>,
    /// The attached meshes, of which only the first [`AttachParams::attached`] count.
    pub attachments: &'a Buffer<Attachment>,
    /// The model matrices of the character's bones.
    pub model_matrices: &'a ModelMatrices,
    /// All instances of the scene.
    pub instances: &'a Buffer<SceneInstance>,
    /// What the views of the frame allow each of them, negative if none sees it.
    pub allowed: &'a Buffer<f32>,
    /// Written for the attached meshes, three for each instance: the rows of the transform from the model's space to the
    /// corner of the view's cell. If the last frame is kept, as many follow for the transforms of that frame.
    pub rows: &'a Buffer<[f32; 4]>,
    /// All instances of the scene as they were in the last frame; the same buffer as `instances` if it is not kept.
    pub last_instances: &'a Buffer<SceneInstance>,
    /// Two for each attachment, zeros at first; where they were in this frame is kept here for the next one.
    pub kept: &'a Buffer<KeptBone>,
}

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

    /// Prepares the placements of as many meshes as `attachments` has room for, in one view. Record it behind the
    /// selection of the view and the model matrices of the character.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for `allowed`, rows, last instances or kept bones of fewer elements than there are;
    /// [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, buffers: AttachBuffers<'_>) -> Result<Job, Error> {
        let instances = buffers.instances.len();
        buffers.allowed.check_holds("allowed", instances)?;
        let is_kept = buffers.last_instances.raw() != buffers.instances.raw();
        buffers.rows.check_holds("rows", if is_kept { 6 } else { 3 } * instances)?;
        buffers.last_instances.check_holds("last_instances", instances)?;
        buffers.kept.check_holds("kept", 2 * buffers.attachments.len())?;
        let group = bindings::Group {
            params: buffers.params,
            view: buffers.view,
            attachments: buffers.attachments.slice(),
            model_matrices: buffers.model_matrices.buffer().slice().cast(),
            instances: buffers.instances.slice(),
            allowed: buffers.allowed.slice(),
            rows: buffers.rows.slice(),
            last_instances: buffers.last_instances.slice(),
            kept: buffers.kept.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "lod/attach", (&self.kernel, group), buffers.attachments.len() as u32)?)
    }
}
