//! `kernels/skinning/select.wgsl`.

use encase::ShaderType;

use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use crate::skinning::weights::Reduction;

/// `SelectParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct SelectParams {
    pub instances: u32,
    pub clusters: u32,
    pub words: u32,
    pub most: u32,
}

/// What a selection reads and remembers.
#[derive(Debug, Clone)]
pub struct SelectBuffers {
    /// The bones of each instance that were recomputed this frame, a bit a slot of the skeleton's order, in
    /// [`MeshBuffers::mask_words`] words an instance. Put [`Active::dirty`](crate::animation::compact::Active::dirty)
    /// here where a gate decides. A bone below one that moved has moved too.
    pub moved: Buffer<u32>,
    /// The reductions with which instances were skinned last; none at first, so that all are skinned.
    pub skinned: Buffer<Reduction>,
    count: Buffer<u32>,
}

impl SelectBuffers {
    /// Room for a crowd. No bone has moved.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Self, GpuError> {
        Ok(Self {
            moved: Buffer::new(gpu, "moved bones", crowd.instances * mesh.mask_words)?,
            skinned: Buffer::new(gpu, "skinned reductions", crowd.instances)?,
            count: Buffer::new(gpu, "selected clusters", 1)?,
        })
    }
}

/// Selects clusters.
#[derive(Debug, Clone)]
pub struct SelectPass {
    select: Kernel,
    finish: Kernel,
}

impl SelectPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |finish| Kernel::new(gpu, &shaders::SKINNING_SELECT, &[("FINISH", finish)]);
        Ok(Self { select: kernel(0.0)?, finish: kernel(1.0)? })
    }

    /// Prepares the list of clusters to be skinned.
    ///
    /// # Errors
    /// [`crate::InputError`] for buffers of another crowd; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        buffers: &SelectBuffers,
        active: &ActiveClusters,
    ) -> Result<Job, Error> {
        let pairs = crowd.instances * mesh.clusters();
        buffers.moved.check_holds("moved", crowd.instances * mesh.mask_words)?;
        buffers.skinned.check_holds("skinned", crowd.instances)?;
        active.pairs.check_holds("active.pairs", pairs)?;
        let params = SelectParams {
            instances: crowd.instances as u32,
            clusters: mesh.clusters() as u32,
            words: mesh.mask_words as u32,
            most: gpu.device().limits().max_compute_workgroups_per_dimension,
        };
        let uniform = Uniform::new(gpu, "select", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            mesh.masks.raw().as_entire_binding(),
            buffers.moved.raw().as_entire_binding(),
            crowd.reductions.raw().as_entire_binding(),
            buffers.skinned.raw().as_entire_binding(),
            active.pairs.raw().as_entire_binding(),
            buffers.count.raw().as_entire_binding(),
            active.dispatched.raw().as_entire_binding(),
        ];
        let step = |kernel: &Kernel, threads: usize| {
            Ok(Step {
                groups: vec![kernel.bind(gpu, 0, &resources)?],
                workgroups: kernel.spread(gpu, threads as u32),
                kernel: kernel.clone(),
            })
        };
        let steps = [step(&self.select, pairs), step(&self.finish, crowd.instances)];
        let steps = steps.into_iter().collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "skinning/select", steps)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(select_params_layout: SelectParams = SKINNING_SELECT "SelectParams");
}
