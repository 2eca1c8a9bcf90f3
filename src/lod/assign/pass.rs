//! The GPU pass of `kernels/lod/assign.wgsl`.

use super::AssignParams;
use crate::Error;
use crate::animation::lod::PackedLod;
use crate::gpu::bindings::lod::assign as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use crate::lod::SceneInstance;
use crate::skinning::instance_lod::InstanceLod;

/// What an assignment reads and writes.
#[derive(Debug, Clone, Copy)]
pub struct AssignBuffers<'a> {
    /// The object and its fractions.
    pub params: &'a Uniform<AssignParams>,
    /// For each instance of the scene the displacement that is allowed, in the model's units, negative if none sees it.
    pub allowed: &'a Buffer<f32>,
    /// All instances of the scene.
    pub instances: &'a Buffer<SceneInstance>,
    /// Written, one for each instance of the object: what gates use.
    pub lods: &'a Buffer<PackedLod>,
    /// Written, one for each instance of the object: what skinning uses.
    pub instance_lods: &'a Buffer<InstanceLod>,
}

/// Assigns allowed displacements to gates and skinning.
#[derive(Debug, Clone)]
pub struct AssignPass {
    kernel: Kernel,
}

impl AssignPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the assignment to at most `instances` instances; the uniform's `instances` says how many there are.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for buffers that hold less; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, buffers: AssignBuffers<'_>, instances: u32) -> Result<Job, Error> {
        buffers.allowed.check_holds("allowed", instances as usize)?;
        buffers.instances.check_holds("instances", instances as usize)?;
        buffers.lods.check_holds("lods", instances as usize)?;
        buffers.instance_lods.check_holds("instance_lods", instances as usize)?;
        let group = bindings::Group {
            params: buffers.params,
            allowed: buffers.allowed.slice(),
            instances: buffers.instances.slice(),
            lods: buffers.lods.slice(),
            instance_lods: buffers.instance_lods.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "lod/assign", (&self.kernel, group), instances)?)
    }
}
