//! Skinning of a crowd into pages of vertices. The memory depends on the number of visible instances, not of all
//! instances.

use std::sync::Arc;

use super::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use super::clusters::Clusters;
use super::morph::MorphPass;
use super::pages::{PageBuffers, PagesPass};
use super::palette::PalettePass;
use super::select::{ClusterSelectBuffers, ClusterSelectPass};
use super::skin::SkinPass;
use crate::Error;
use crate::InputError;
use crate::animation::ModelMatrices;
use crate::animation::updated_bones::UpdatedBonesReader;
use crate::gpu::{Buffer, Gpu, Job};
use crate::skinning::vertex::Blend;
#[cfg(not(target_arch = "wasm32"))]
use crate::skinning::vertex::Vertex;

/// Options of a [`PagedSkin`]: the numbers of instances and vertex pages, and whether previous positions are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PagedSkinOptions {
    /// Number of instances, at least 1.
    pub instances: usize,
    /// Number of pages. A page has a capacity of 64 vertices: one cluster of one instance.
    pub pages: u32,
    /// Whether vertex positions of the previous frame are kept, for motion vectors ([`PageBuffers::last`]).
    pub keeps_last: bool,
}

/// GPU passes that skin all instances of one mesh into pages, by linear blending, prepared for recording.
#[derive(Debug, Clone)]
pub struct PagedSkin {
    /// The mesh in GPU buffers.
    pub mesh: MeshBuffers,
    /// The order of the mesh's vertices in clusters.
    pub clusters: Arc<Clusters>,
    /// Levels of detail and morph weights of the instances. The caller may write them.
    pub crowd: SkinnedCrowd,
    active: ActiveClusters,
    palette: Job,
    paging: Paging,
    reader: Arc<UpdatedBonesReader>,
}

/// The pages, and the GPU jobs that must be prepared again when the pages are replaced.
#[derive(Debug, Clone)]
struct Paging {
    pages: PageBuffers,
    select: ClusterSelectBuffers,
    deal: Job,
    /// Two jobs that select clusters: the first keeps the record of updated bones, the second clears it.
    selections: [Job; 2],
    /// The morphing job, if the mesh has morph targets, and the skinning job.
    after: Vec<Job>,
}

impl Paging {
    fn new(
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        select: ClusterSelectBuffers,
        active: &ActiveClusters,
        pages: u32,
    ) -> Result<Self, Error> {
        let allocated = if active.keeps_last { PageBuffers::keeping } else { PageBuffers::new };
        let pages = allocated(gpu, mesh, crowd, pages)?;
        let deal = PagesPass::new(gpu)?.prepare(gpu, mesh, crowd, &pages)?;
        let selections = ClusterSelectPass::new(gpu)?.prepare(gpu, mesh, crowd, &select, active)?;
        let morph = MorphPass::new(gpu)?.prepare_paged(gpu, mesh, crowd, &pages, active)?;
        let skin = SkinPass::new(gpu, Blend::Linear)?.prepare_paged(gpu, mesh, crowd, &pages, active)?;
        let after = morph.into_iter().chain([skin]).collect();
        Ok(Self { pages, select, deal, selections, after })
    }
}

impl PagedSkin {
    /// Prepares the skinning of a mesh. `clusters` is the order of its vertices. `matrices` holds the bones' poses and
    /// must record the updated bones.
    ///
    /// With [`PagedSkinOptions::keeps_last`], the position of each vertex before the latest [`PagedSkin::dispatch`] is
    /// kept behind the pages ([`PageBuffers::last`]). A page then takes 3584 bytes instead of 2560. A moving vertex is
    /// skinned once more after it stops. A vertex that was invisible in the previous frame counts as static.
    ///
    /// # Errors
    /// [`InputError`] for 0 instances, and for matrices that record no updated bones or too few of them;
    /// [`crate::gpu::GpuError`] from the device.
    pub fn of_mesh(
        gpu: &Gpu,
        mesh: MeshBuffers,
        clusters: Arc<Clusters>,
        matrices: &ModelMatrices,
        options: PagedSkinOptions,
    ) -> Result<Self, Error> {
        let PagedSkinOptions { instances, pages, keeps_last } = options;
        let Some(updated) = matrices.updated_bones() else {
            return Err(InputError::new("matrices.updated_bones", "none", "must be recorded").into());
        };
        let crowd = SkinnedCrowd::paged(gpu, &mesh, instances, Blend::Linear)?;
        let updated_bones = updated.bits().clone();
        let select = ClusterSelectBuffers { updated_bones, ..ClusterSelectBuffers::new(gpu, &mesh, &crowd)? };
        let listed = if keeps_last { ActiveClusters::keeping } else { ActiveClusters::new };
        let active = listed(gpu, &mesh, &crowd)?;
        let palette = PalettePass::new(gpu)?.prepare(gpu, &mesh, matrices, &crowd)?;
        let paging = Paging::new(gpu, &mesh, &crowd, select, &active, pages)?;
        Ok(Self { mesh, clusters, crowd, active, palette, paging, reader: Arc::new(updated.reader()) })
    }

    /// The pages and the vertices in them.
    pub fn pages(&self) -> &PageBuffers {
        &self.paging.pages
    }

    /// Replaces all pages by `pages` new, empty pages. The next frame assigns pages to all visible instances and skins
    /// them again. After an error the old pages stay.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`] if the pages cannot be allocated.
    pub fn set_pages(&mut self, gpu: &Gpu, pages: u32) -> Result<(), Error> {
        // Starts a new record of skinned instances. Frames that are already recorded keep using the old record.
        let skinned = ClusterSelectBuffers::new(gpu, &self.mesh, &self.crowd)?.skinned;
        let select = ClusterSelectBuffers { skinned, ..self.paging.select.clone() };
        self.paging = Paging::new(gpu, &self.mesh, &self.crowd, select, &self.active, pages)?;
        Ok(())
    }

    /// Adds three steps to a compute pass: page assignment, palettes, and the skinning of clusters with an updated
    /// bone, a changed morph weight or a new page. If several skins share model matrices, the last of them clears the
    /// updated bones ([`UpdatedBones`](crate::animation::UpdatedBones)).
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.paging.deal.dispatch(pass);
        self.palette.dispatch(pass);
        let [keeping, clearing] = &self.paging.selections;
        if self.reader.read() { clearing } else { keeping }.dispatch(pass);
        self.paging.after.iter().for_each(|job| job.dispatch(pass));
    }

    /// Reads the vertices of the given instances, in the mesh's own order; `None` for a vertex whose cluster has no
    /// page. Blocks until the device has finished.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist; [`crate::gpu::GpuError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn read_each(
        &self,
        gpu: &Gpu,
        instances: &[usize],
    ) -> Result<Vec<Vec<Option<Vertex>>>, Error> {
        for instance in instances {
            InputError::check_below("instance", *instance, self.crowd.instances)?;
        }
        let PageBuffers { table, skinned, .. } = &self.paging.pages;
        let (table, skinned) = (table.read_blocking(gpu)?, skinned.read_blocking(gpu)?);
        let of_instance = |instance: &usize| {
            let own = &table[instance * self.mesh.clusters()..];
            let vertex = |place: usize| {
                let page = own[place / super::clusters::CLUSTER] as usize;
                skinned.get(super::clusters::CLUSTER * page + place % super::clusters::CLUSTER).copied()
            };
            let placed: Vec<_> = (0..self.mesh.vertices.len()).map(vertex).collect();
            self.clusters.in_mesh_order(&placed)
        };
        Ok(instances.iter().map(of_instance).collect())
    }

    /// Buffer of five words: workgroup counts along x, y and z (indirect arguments of the skinning dispatch), the
    /// number of skinned clusters, and a counter.
    pub fn dispatched(&self) -> &Buffer<u32> {
        &self.active.dispatched
    }
}
