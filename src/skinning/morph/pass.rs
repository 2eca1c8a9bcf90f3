//! The GPU pass of `kernels/skinning/morph.wgsl`.

use crate::Error;
use crate::gpu::bindings::skinning::morph as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Group, IndirectJob, Job, Kernel, Step, Uniform, rows_of_workgroups};
use crate::shared::skinning::morph::MorphParams;
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};

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
        let kernel = |compacted| bindings::kernel(gpu, &bindings::Constants { compacted });
        Ok(Self { all: kernel(false)?, active: kernel(true)? })
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
                keeps_last: false,
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
    let group = bindings::Group {
        params: &uniform,
        vertices: mesh.vertices.slice().cast(),
        offsets: mesh.delta_offsets.slice(),
        deltas: mesh.deltas.slice().cast(),
        weights: crowd.weights.slice(),
        instance_lods: crowd.instance_lods.slice(),
        pairs: active.pairs.slice(),
        dispatched: active.dispatched.slice().cast(),
        morphed: crowd.morphed.slice().cast(),
    };
    Ok(group.bind(gpu, kernel)?)
}
