//! The GPU pass of `kernels/skinning/morph.wgsl`.

use crate::Error;
use crate::gpu::bind::Slice;
use crate::gpu::bindings::skinning::morph as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Group, IndirectJob, Job, Kernel, Step, Uniform, rows_of_workgroups};
use crate::shared::skinning::morph::MorphParams;
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::Vertex;

/// Applies morph targets.
#[derive(Debug, Clone)]
pub struct MorphPass {
    all: Kernel,
    active: Kernel,
    paged: Kernel,
}

/// What is morphed, and where to.
struct Output<'a> {
    active: &'a ActiveClusters,
    /// Words of the levels of detail, or the page table.
    seen: Slice<'a, u32>,
    morphed: &'a Buffer<Vertex>,
}

impl MorphPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |compacted, paged| bindings::kernel(gpu, &bindings::Constants { compacted, paged });
        Ok(Self { all: kernel(false, false)?, active: kernel(true, false)?, paged: kernel(true, true)? })
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
            let group = bind(gpu, &self.all, mesh, crowd, by_level(mesh, crowd, &nothing)?)?;
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
        let group = bind(gpu, &self.active, mesh, crowd, by_level(mesh, crowd, active)?)?;
        let arguments = active.dispatched.raw();
        Ok(Some(IndirectJob::new("skinning/morph", &self.active, arguments, vec![(group, 0)])))
    }

    /// As [`MorphPass::prepare_active`], into the pages that [`PagesPass`](crate::skinning::pages::PagesPass) deals out.
    /// Clusters without a page are skipped.
    ///
    /// # Errors
    /// As [`MorphPass::prepare`].
    pub fn prepare_paged(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: &PageBuffers,
        active: &ActiveClusters,
    ) -> Result<Option<IndirectJob>, Error> {
        if mesh.targets == 0 {
            return Ok(None);
        }
        pages.table.check_holds("pages.table", crowd.instances * mesh.clusters())?;
        let output = Output { active, seen: pages.table.slice(), morphed: &pages.morphed };
        let group = bind(gpu, &self.paged, mesh, crowd, output)?;
        let arguments = active.dispatched.raw();
        Ok(Some(IndirectJob::new("skinning/morph", &self.paged, arguments, vec![(group, 0)])))
    }
}

fn pairs(mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> u32 {
    (crowd.instances * mesh.clusters()) as u32
}

/// All vertices of each instance that is seen, up to its level of detail.
fn by_level<'a>(
    mesh: &MeshBuffers,
    crowd: &'a SkinnedCrowd,
    active: &'a ActiveClusters,
) -> Result<Output<'a>, Error> {
    crowd.morphed.check_holds("crowd.morphed", crowd.instances * mesh.vertices.len())?;
    crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
    Ok(Output { active, seen: crowd.instance_lods.slice().cast(), morphed: &crowd.morphed })
}

fn bind(
    gpu: &Gpu,
    kernel: &Kernel,
    mesh: &MeshBuffers,
    crowd: &SkinnedCrowd,
    output: Output<'_>,
) -> Result<Group, Error> {
    crowd.weights.check_holds("crowd.weights", crowd.instances * mesh.targets)?;
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
        seen: output.seen,
        pairs: output.active.pairs.slice(),
        dispatched: output.active.dispatched.slice().cast(),
        morphed: output.morphed.slice().cast(),
    };
    Ok(group.bind(gpu, kernel)?)
}
