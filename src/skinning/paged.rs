//! Skinning of a crowd into pages of vertices. Memory follows the number of visible instances, not of all instances.

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

/// How much a [`PagedSkin`] holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PagedSkinOptions {
    /// Number of instances, at least 1.
    pub instances: usize,
    /// Number of pages; a page holds one cluster of one instance.
    pub pages: u32,
    /// Whether each vertex's position of the frame before is kept ([`PageBuffers::last`]).
    pub keeps_last: bool,
}

/// The prepared skinning of all instances of one mesh into pages, by linear blending.
#[derive(Debug, Clone)]
pub struct PagedSkin {
    /// The mesh on the device.
    pub mesh: MeshBuffers,
    /// The arrangement of the mesh's vertices.
    pub clusters: Arc<Clusters>,
    /// LODs and morph weights of instances, which the caller may write.
    pub crowd: SkinnedCrowd,
    active: ActiveClusters,
    palette: Job,
    paging: Paging,
    reader: Arc<UpdatedBonesReader>,
}

/// The pages, and the jobs that depend on them.
#[derive(Debug, Clone)]
struct Paging {
    pages: PageBuffers,
    select: ClusterSelectBuffers,
    deal: Job,
    /// Two selections: one keeps the updated bones, the other clears them.
    selections: [Job; 2],
    /// Morphing, if there are targets, and skinning.
    after: Vec<Job>,
}

impl Paging {
    fn new(
        gpu: &Gpu,
        (mesh, crowd): (&MeshBuffers, &SkinnedCrowd),
        (select, active): (ClusterSelectBuffers, &ActiveClusters),
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
    /// Prepares a mesh. `clusters` is the arrangement of its vertices. `matrices` poses the bones and must record the updated
    /// bones.
    ///
    /// With last positions, the pages are followed by each vertex's position before the last [`PagedSkin::dispatch`]
    /// ([`PageBuffers::last`]). A page then takes 3584 bytes instead of 2560. A moving vertex is skinned once more
    /// after it stops. A vertex that was not visible in the frame before counts as static.
    ///
    /// # Errors
    /// [`InputError`] for no instances, for matrices without updated bones and for fewer of them than needed;
    /// [`crate::gpu::GpuError`].
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
        let paging = Paging::new(gpu, (&mesh, &crowd), (select, &active), pages)?;
        Ok(Self { mesh, clusters, crowd, active, palette, paging, reader: Arc::new(updated.reader()) })
    }

    /// The pages with their vertices.
    pub fn pages(&self) -> &PageBuffers {
        &self.paging.pages
    }

    /// Replaces the pages by `pages` new ones. The next frame assigns pages to all visible instances and skins them
    /// anew. After an error the old pages stay.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn set_pages(&mut self, gpu: &Gpu, pages: u32) -> Result<(), Error> {
        // A new record of skinned instances, because frames that are already recorded keep using the old one.
        let skinned = ClusterSelectBuffers::new(gpu, &self.mesh, &self.crowd)?.skinned;
        let select = ClusterSelectBuffers { skinned, ..self.paging.select.clone() };
        self.paging = Paging::new(gpu, (&self.mesh, &self.crowd), (select, &self.active), pages)?;
        Ok(())
    }

    /// Adds to a compute pass: page assignment, palettes, and skinning of clusters with an updated bone, a changed
    /// morph weight or a new page. If several skins share model matrices, the last of them clears the updated bones
    /// ([`UpdatedBones`](crate::animation::UpdatedBones)).
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.paging.deal.dispatch(pass);
        self.palette.dispatch(pass);
        let [keeping, clearing] = &self.paging.selections;
        if self.reader.read() { clearing } else { keeping }.dispatch(pass);
        self.paging.after.iter().for_each(|job| job.dispatch(pass));
    }

    /// Reads the vertices of each instance that has pages, in the mesh's own order; `None` for the others. Waits for
    /// the device.
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

    /// Indirect arguments of the skinning dispatch: workgroup counts along x, y and z, the number of skinned clusters,
    /// and a counter.
    pub fn dispatched(&self) -> &Buffer<u32> {
        &self.active.dispatched
    }
}
