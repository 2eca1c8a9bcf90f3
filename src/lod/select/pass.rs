//! The GPU pass of `kernels/lod/select.wgsl`.

use crate::Error;
use crate::gpu::bindings::lod::select as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use crate::lod::{BLOCK, LodObject, OBJECT_LISTS, SceneInstance, SelectView};

/// What a selection reads and writes.
#[derive(Debug, Clone, Copy)]
pub struct SelectBuffers<'a> {
    /// The view. Its `blocks` may be fewer than `block_objects` has.
    pub view: &'a Uniform<SelectView>,
    /// The objects.
    pub objects: &'a Buffer<LodObject>,
    /// The index of the object that each block of 64 instances belongs to, [`NO_OBJECT`](crate::lod::NO_OBJECT) for none,
    /// whose instances are left alone.
    pub block_objects: &'a Buffer<u32>,
    /// The instances of all blocks.
    pub instances: &'a Buffer<SceneInstance>,
    /// Written, one for each instance: the smallest displacement that a view of the frame which sees it allows, in the
    /// model's units; [`UNSEEN_ALLOWED`](crate::lod::select::UNSEEN_ALLOWED) if none sees it.
    pub allowed: &'a Buffer<f32>,
    /// Written, one for each instance: 0 if the view does not see it, else 1 + 2 · level + mirrored. Leave them as they are
    /// from frame to frame if `SelectView::last_levels` is not 0.
    pub decisions: &'a Buffer<u32>,
    /// Written, three for each instance that is seen: the rows of the transform from the model's space to the corner of
    /// the view's cell. If `SelectView::last_levels` is not 0, there is an element for each instance from it on, which is
    /// written with the level of the last frame ([`level_told`](crate::lod::select::reference::level_told)).
    pub rows: &'a Buffer<[f32; 4]>,
    /// Written, [`OBJECT_LISTS`] for each block: how many of its instances are in each list.
    pub counts: &'a Buffer<u32>,
}

/// Selects instances.
#[derive(Debug, Clone)]
pub struct SelectPass {
    kernel: Kernel,
}

impl SelectPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the selection of the instances of as many blocks as `block_objects` has.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers that are too small for these blocks; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, buffers: SelectBuffers<'_>) -> Result<Job, Error> {
        let blocks = buffers.block_objects.len();
        let instances = BLOCK as usize * blocks;
        buffers.objects.check_holds("objects", 1)?;
        buffers.instances.check_holds("instances", instances)?;
        buffers.allowed.check_holds("allowed", instances)?;
        buffers.decisions.check_holds("decisions", instances)?;
        buffers.rows.check_holds("rows", 3 * instances)?;
        buffers.counts.check_holds("counts", OBJECT_LISTS as usize * blocks)?;
        let group = bindings::Group {
            view: buffers.view,
            objects: buffers.objects.slice(),
            block_objects: buffers.block_objects.slice(),
            instances: buffers.instances.slice(),
            allowed: buffers.allowed.slice(),
            decisions: buffers.decisions.slice(),
            rows: buffers.rows.slice(),
            counts: buffers.counts.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "lod/select", (&self.kernel, group), instances as u32)?)
    }
}
