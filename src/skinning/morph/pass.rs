//! The GPU pass of `kernels/skinning/morph.wgsl`.

use encase::ShaderType;
use glam::UVec4;

use crate::Error;
use crate::asset::mesh::MAX_LEVELS;
use crate::gpu::{
    Buffer, Gpu, GpuError, Group, IndirectJob, Job, Kernel, Step, Uniform, rows_of_workgroups, shaders,
};
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};

/// The kernel's `MorphParams`.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct MorphParams {
    pub vertices: u32,
    pub targets: u32,
    pub instances: u32,
    pub pairs: u32,
    pub levels: [UVec4; MAX_LEVELS / 4],
}

/// Applies morph targets.
#[derive(Debug, Clone)]
pub struct MorphPass {
    all: Kernel,
    active: Kernel,
}

impl MorphPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |compacted| Kernel::new(gpu, &shaders::SKINNING_MORPH, &[("COMPACTED", compacted)]);
        Ok(Self { all: kernel(0.0)?, active: kernel(1.0)? })
    }

    /// Prepares the morphed vertices of all instances that are seen; clusters beyond their level of detail keep
    /// their previous contents. For a mesh without targets the job is empty.
    ///
    /// # Errors
    /// [`crate::InputError`] for a crowd of another mesh; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Job, Error> {
        let mut steps = Vec::new();
        if mesh.targets > 0 {
            let nothing = ActiveClusters {
                pairs: Buffer::new(gpu, "no clusters", 0)?,
                dispatched: Buffer::from_slice(gpu, "no clusters", &[0; 4])?,
            };
            let group = bind(gpu, &self.all, mesh, crowd, &nothing)?;
            let workgroups = rows_of_workgroups(gpu, pairs(mesh, crowd));
            steps.push(Step { groups: vec![group], workgroups, kernel: self.all.clone() });
        }
        Ok(Job::new(gpu, "skinning/morph", steps)?)
    }

    /// Prepares the active clusters, as far as their instances are seen and the clusters are within the level
    /// of detail; all other vertices stay unchanged. For a mesh without targets the job is empty.
    ///
    /// # Errors
    /// As [`MorphPass::prepare`].
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        active: &ActiveClusters,
    ) -> Result<Option<IndirectJob>, Error> {
        if mesh.targets == 0 {
            return Ok(None);
        }
        let group = bind(gpu, &self.active, mesh, crowd, active)?;
        let arguments = active.dispatched.raw();
        Ok(Some(IndirectJob::new("skinning/morph", &self.active, arguments, vec![(group, 0)])))
    }
}

fn pairs(mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> u32 {
    (crowd.instances * mesh.clusters()) as u32
}

fn bind(
    gpu: &Gpu,
    kernel: &Kernel,
    mesh: &MeshBuffers,
    crowd: &SkinnedCrowd,
    active: &ActiveClusters,
) -> Result<Group, Error> {
    crowd.morphed.check_holds("crowd.morphed", crowd.instances * mesh.vertices.len())?;
    crowd.weights.check_holds("crowd.weights", crowd.instances * mesh.targets)?;
    crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
    let params = MorphParams {
        vertices: mesh.vertices.len() as u32,
        targets: mesh.targets as u32,
        instances: crowd.instances as u32,
        pairs: pairs(mesh, crowd),
        levels: mesh.clusters_of_levels(),
    };
    let uniform = Uniform::new(gpu, "morph", &params)?;
    let resources = [
        uniform.raw().as_entire_binding(),
        mesh.vertices.raw().as_entire_binding(),
        mesh.delta_offsets.raw().as_entire_binding(),
        mesh.deltas.raw().as_entire_binding(),
        crowd.weights.raw().as_entire_binding(),
        crowd.instance_lods.raw().as_entire_binding(),
        active.pairs.raw().as_entire_binding(),
        active.dispatched.raw().as_entire_binding(),
        crowd.morphed.raw().as_entire_binding(),
    ];
    Ok(kernel.bind(gpu, 0, &resources)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(morph_params_layout: MorphParams = SKINNING_MORPH "MorphParams");
}
