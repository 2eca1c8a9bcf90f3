//! The GPU pass of `kernels/skinning/morph.wgsl`.

use crate::Error;
use crate::gpu::bind::Slice;
use crate::gpu::bindings::skinning::morph as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::skinning::morph::MorphParams;
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::Vertex;

/// GPU pass that applies morph targets to vertices.
#[derive(Debug, Clone)]
pub struct MorphPass {
    kernel: Kernel,
    paged: Kernel,
}

impl MorphPass {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`GpuError`] if the driver cannot compile a kernel.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |paged| bindings::kernel(gpu, &bindings::Constants { paged });
        Ok(Self { kernel: kernel(false)?, paged: kernel(true)? })
    }

    /// Prepares the morphing of the active clusters of visible instances, within their level of detail. All other
    /// vertices stay unchanged. Returns `None` for a mesh without morph targets.
    ///
    /// # Errors
    /// [`crate::InputError`] if the crowd belongs to another mesh; [`GpuError`] from the device.
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        active: &ActiveClusters,
    ) -> Result<Option<Job>, Error> {
        if mesh.targets == 0 {
            return Ok(None);
        }
        crowd.morphed.check_holds("crowd.morphed", crowd.instances * mesh.vertices.len())?;
        crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
        let seen = crowd.instance_lods.slice().cast();
        job(gpu, &self.kernel, mesh, crowd, active, seen, &crowd.morphed).map(Some)
    }

    /// As [`MorphPass::prepare_active`], but writes to pages that [`PagesPass`](crate::skinning::pages::PagesPass) has
    /// assigned. Clusters without a page are skipped.
    ///
    /// # Errors
    /// The same errors as [`MorphPass::prepare_active`].
    pub fn prepare_paged(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: &PageBuffers,
        active: &ActiveClusters,
    ) -> Result<Option<Job>, Error> {
        if mesh.targets == 0 {
            return Ok(None);
        }
        pages.table.check_holds("pages.table", crowd.instances * mesh.clusters())?;
        job(gpu, &self.paged, mesh, crowd, active, pages.table.slice(), &pages.morphed).map(Some)
    }
}

/// Binds the kernel's buffers. `seen` is the page table if vertices are paged, otherwise the levels of detail of
/// instances.
fn job(
    gpu: &Gpu,
    kernel: &Kernel,
    mesh: &MeshBuffers,
    crowd: &SkinnedCrowd,
    active: &ActiveClusters,
    seen: Slice<'_, u32>,
    morphed: &Buffer<Vertex>,
) -> Result<Job, Error> {
    crowd.weights.check_holds("crowd.weights", crowd.instances * mesh.targets)?;
    let params = MorphParams {
        vertices: mesh.vertices.len() as u32,
        targets: mesh.targets as u32,
        instances: crowd.instances as u32,
        pairs: (crowd.instances * mesh.clusters()) as u32,
        levels: mesh.clusters_of_levels(),
    };
    let group = bindings::Group {
        params: &Uniform::new(gpu, "morph", &params)?,
        vertices: mesh.vertices.slice().cast(),
        offsets: mesh.delta_offsets.slice(),
        deltas: mesh.deltas.slice().cast(),
        weights: crowd.weights.slice(),
        seen,
        pairs: active.pairs.slice(),
        dispatched: active.dispatched.slice().cast(),
        morphed: morphed.slice().cast(),
    };
    let step = Step::indirect(kernel, group.bind(gpu, kernel)?, active.dispatched.raw(), 0);
    Ok(Job::new(gpu, "skinning/morph", vec![step])?)
}
