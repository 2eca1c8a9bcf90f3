//! The GPU pass of `kernels/lod/list.wgsl`.

use crate::Error;
use crate::gpu::bindings::lod::list as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::lod::{BLOCK, LodObject, OBJECT_LISTS, SceneDraw};
use crate::shared::lod::list::{ListParams, PLACE, RUNS, SUM};

/// Buffers of the list kernel.
#[derive(Debug, Clone, Copy)]
pub struct ListBuffers<'a> {
    /// The objects. Their lists and draws must lie inside `lists` and `arguments`.
    pub objects: &'a Buffer<LodObject>,
    /// Object index of each block of 64 instances, or [`NO_OBJECT`](crate::lod::NO_OBJECT).
    pub block_objects: &'a Buffer<u32>,
    /// Decision word per instance.
    pub decisions: &'a Buffer<u32>,
    /// In: instance count per block and list, [`OBJECT_LISTS`] counts for each block. The kernel overwrites them.
    pub counts: &'a Buffer<u32>,
    /// Out: list entries, from [`LodObject::list_begin`] on. An entry has an instance's index in its object, the level, and the
    /// steps of the transition.
    pub lists: &'a Buffer<u32>,
    /// Out: draws of all objects ([`LodObject::draw`]). Only their instance counts are written.
    pub arguments: &'a Buffer<SceneDraw>,
}

/// GPU pass that writes the instance lists of a view and the instance counts of its draws.
#[derive(Debug, Clone)]
pub struct ListPass {
    sum: Kernel,
    place: Kernel,
}

impl ListPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// Errors of the driver's shader compiler.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        Ok(Self { sum: kernel(SUM)?, place: kernel(PLACE)? })
    }

    /// Prepares a job that writes the lists of the first `object_count` objects and `blocks` blocks, in two dispatches.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers with fewer objects or blocks; [`GpuError`] for failures of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        buffers: ListBuffers<'_>,
        object_count: u32,
        blocks: u32,
    ) -> Result<Job, Error> {
        buffers.objects.check_holds("objects", object_count as usize)?;
        buffers.block_objects.check_holds("block_objects", blocks as usize)?;
        buffers.decisions.check_holds("decisions", (BLOCK * blocks) as usize)?;
        buffers.counts.check_holds("counts", (OBJECT_LISTS * blocks) as usize)?;
        let uniform = Uniform::new(gpu, "list", &ListParams { objects: object_count, blocks })?;
        let group = bindings::Group {
            params: &uniform,
            objects: buffers.objects.slice(),
            block_objects: buffers.block_objects.slice(),
            decisions: buffers.decisions.slice(),
            counts: buffers.counts.slice(),
            lists: buffers.lists.slice(),
            arguments: buffers.arguments.slice(),
        };
        let step = |kernel, threads| {
            Ok::<_, GpuError>(Step::spread(gpu, kernel, vec![group.bind(gpu, kernel)?], threads))
        };
        let steps =
            vec![step(&self.sum, OBJECT_LISTS * RUNS * object_count)?, step(&self.place, BLOCK * blocks)?];
        Ok(Job::new(gpu, "lod/list", steps)?)
    }
}
