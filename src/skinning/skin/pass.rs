//! The GPU pass of `kernels/skinning/skin.wgsl`.

use crate::gpu::bindings::skinning::skin as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::skinning::skin::SkinParams;
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::{Blend, Vertex};
use crate::{Error, InputError};

/// GPU pass that skins vertices.
#[derive(Debug, Clone)]
pub struct SkinPass {
    /// Two kernels for vertices without pages: the first reads the mesh's vertices, the second morphed vertices.
    kernels: [Kernel; 2],
    /// The same two kernels for vertices in pages.
    paged: [Kernel; 2],
    blend: Blend,
}

/// The buffers of skinned and morphed vertices, and their page table.
struct Output<'a> {
    skinned: &'a Buffer<Vertex>,
    /// Vertices after morphing and before skinning; used for meshes with morph targets.
    morphed: &'a Buffer<Vertex>,
    /// The page table. Any buffer serves if vertices are not in pages.
    table: &'a Buffer<u32>,
    /// Offset of the positions of the previous frame in `skinned`, in units of two floats; 0 if they are not kept.
    last: u32,
}

impl SkinPass {
    /// Compiles the kernels for one kind of blending.
    ///
    /// # Errors
    /// [`GpuError`] if the driver cannot compile a kernel.
    pub fn new(gpu: &Gpu, blend: Blend) -> Result<Self, GpuError> {
        let dual = blend == Blend::DualQuaternion;
        let kernel = |paged, morphed| {
            bindings::kernel(gpu, &bindings::Constants { dual, morphed, paged, keep: false })
        };
        let kernels = [kernel(false, false)?, kernel(false, true)?];
        Ok(Self { kernels, paged: [kernel(true, false)?, kernel(true, true)?], blend })
    }

    /// Prepares the skinning of the active clusters of visible instances, within their level of detail. The result goes
    /// to `skinned`, instance by instance, in the order of the mesh's clusters. All other vertices stay unchanged.
    ///
    /// # Errors
    /// [`InputError`] if the crowd has another mesh or kind of blending, or if `skinned` is too small; [`GpuError`]
    /// from the device.
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        skinned: &Buffer<Vertex>,
        active: &ActiveClusters,
    ) -> Result<Job, Error> {
        let vertices = crowd.instances * mesh.vertices.len();
        skinned.check_holds("skinned", vertices)?;
        crowd.morphed.check_holds("crowd.morphed", if mesh.targets > 0 { vertices } else { 0 })?;
        let output = Output { skinned, morphed: &crowd.morphed, table: &active.pairs, last: 0 };
        self.job(gpu, &self.kernels[usize::from(mesh.targets > 0)], mesh, crowd, active, output)
    }

    /// As [`SkinPass::prepare_active`], but writes to pages that [`PagesPass`](crate::skinning::pages::PagesPass) has
    /// assigned. Clusters without a page are skipped. If the pages keep previous positions ([`PageBuffers::keeping`]),
    /// the pass also stores a previous position for each vertex. It is the position before or after this skinning,
    /// depending on the cluster's state.
    ///
    /// # Errors
    /// The same errors as [`SkinPass::prepare_active`]. Also [`InputError`] if only one of `pages` and `active` keeps
    /// previous positions.
    pub fn prepare_paged(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: &PageBuffers,
        active: &ActiveClusters,
    ) -> Result<Job, Error> {
        let keeps = pages.last > 0;
        let bound = || format!("must be {keeps}, as the pages have or lack last positions");
        InputError::check(keeps == active.keeps_last, "active.keeps_last", active.keeps_last, bound)?;
        let (morphed, dual) = (mesh.targets > 0, self.blend == Blend::DualQuaternion);
        let kernel = match keeps {
            true => &bindings::kernel(gpu, &bindings::Constants { dual, morphed, paged: true, keep: true })?,
            false => &self.paged[usize::from(morphed)],
        };
        active.pairs.check_holds("active.pairs", active.words(crowd.instances * mesh.clusters()))?;
        pages.table.check_holds("pages.table", crowd.instances * mesh.clusters())?;
        let PageBuffers { skinned, morphed, table, last, .. } = pages;
        self.job(gpu, kernel, mesh, crowd, active, Output { skinned, morphed, table, last: *last })
    }

    fn job(
        &self,
        gpu: &Gpu,
        kernel: &Kernel,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        active: &ActiveClusters,
        output: Output<'_>,
    ) -> Result<Job, Error> {
        if crowd.blend != self.blend {
            let bound = format!("must be {:?}, as the pass's", self.blend);
            return Err(InputError::new("crowd.blend", format!("{:?}", crowd.blend), bound).into());
        }
        let vectors = if self.blend == Blend::Linear { 3 } else { 4 };
        crowd.palette.check_holds("crowd.palette", vectors * crowd.instances * mesh.bones.len())?;
        let vertices = if mesh.targets > 0 { output.morphed } else { &mesh.vertices };
        let params = SkinParams {
            vertices: mesh.vertices.len() as u32,
            pairs: (crowd.instances * mesh.clusters()) as u32,
            bones: mesh.bones.len() as u32,
            instances: crowd.instances as u32,
            last: output.last,
            levels: mesh.clusters_of_levels(),
        };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "skin", &params)?,
            vertices: vertices.slice().cast(),
            influences: mesh.influences.slice(),
            palette: crowd.palette.slice(),
            instance_lods: crowd.instance_lods.slice(),
            pairs: active.pairs.slice(),
            dispatched: active.dispatched.slice().cast(),
            skinned: output.skinned.slice().cast(),
            page_table: output.table.slice(),
        };
        let step = Step::indirect(kernel, group.bind(gpu, kernel)?, active.dispatched.raw(), 0);
        Ok(Job::new(gpu, "skinning/skin", vec![step])?)
    }
}
