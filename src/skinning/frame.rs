//! The skinning of a crowd in one object: everything between the bones' matrices and vertices that can be
//! drawn.

use std::sync::Arc;

use super::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use super::clusters::Clusters;
use super::morph::MorphPass;
use super::palette::PalettePass;
use super::select::{SelectBuffers, SelectPass};
use super::skin::SkinPass;
use crate::animation::model_matrices::Consumer;
use crate::animation::updated_bones::UpdatedBonesReader;
use crate::animation::{ModelMatrices, UpdatedBones};
use crate::asset::Model;
use crate::gpu::{Buffer, Gpu, Job, compute_pass};
use crate::skinning::vertex::{Blend, Vertex};
use crate::{Error, InputError};

/// The prepared skinning of all instances of one mesh.
#[derive(Debug, Clone)]
pub struct SkinFrame {
    /// The mesh on the device.
    pub mesh: MeshBuffers,
    /// The arrangement of its vertices.
    pub clusters: Clusters,
    /// InstanceLods and weights of morph targets, which the caller may write.
    pub crowd: SkinnedCrowd,
    /// The updated bones: those that the model matrices record, or, if they record none, those that the caller
    /// writes. [`SkinFrame::record_updated_bones`] clears the latter.
    pub select: SelectBuffers,
    /// The clusters that the last [`SkinFrame::record_updated_bones`] selected.
    pub active: ActiveClusters,
    /// Skinned vertices, at `instance · vertices + slot`. Those of clusters beyond an instance's level of
    /// detail are out of date.
    pub skinned: Buffer<Vertex>,
    palette: Job,
    /// The selection that keeps the updated bones, and the one that clears them.
    selections: [Job; 2],
    /// The jobs of morph targets, if there are any, and of vertices.
    jobs: Vec<Job>,
    reader: Arc<UpdatedBonesReader>,
}

impl SkinFrame {
    /// Prepares a model's mesh for `instances` instances, whose bones are posed by `matrices`.
    ///
    /// # Errors
    /// [`InputError`] for a mesh that the model does not have or that does not match it, for no instances, for
    /// fewer matrices or bits of updated bones than needed, and for dual quaternions over matrices of a crowd
    /// under [`Gate::Bounded`](crate::animation::Gate::Bounded), whose bound holds for linear blending only;
    /// [`crate::gpu::GpuError`].
    pub fn new(
        gpu: &Gpu,
        model: &Model,
        mesh: usize,
        matrices: &ModelMatrices,
        instances: usize,
        blend: Blend,
    ) -> Result<Self, Error> {
        if blend == Blend::DualQuaternion {
            matrices.consumer().check(Consumer::DualQuaternions)?;
        }
        InputError::check_below("mesh", mesh, model.meshes.len())?;
        let (mesh, clusters) = MeshBuffers::new(gpu, model, &model.meshes[mesh])?;
        let crowd = SkinnedCrowd::new(gpu, &mesh, instances, blend)?;
        let mut select = SelectBuffers::new(gpu, &mesh, &crowd)?;
        let updated = match matrices.updated_bones() {
            Some(updated) => updated.clone(),
            None => UpdatedBones::over(select.updated_bones),
        };
        select.updated_bones = updated.bits().clone();
        let reader = Arc::new(updated.reader());
        let active = ActiveClusters::new(gpu, &mesh, &crowd)?;
        let skinned = Buffer::new(gpu, "skinned vertices", instances * mesh.vertices.len())?;
        let selections = SelectPass::new(gpu)?.prepare(gpu, &mesh, &crowd, &select, &active)?;
        let skin = SkinPass::new(gpu, blend)?.prepare_active(gpu, &mesh, &crowd, &skinned, &active)?;
        let morph = MorphPass::new(gpu)?.prepare_active(gpu, &mesh, &crowd, &active)?;
        let jobs = morph.into_iter().chain([skin]).collect();
        // This comes last: it claims the matrices for its kind of blending, which a refused frame must not do.
        let palette = PalettePass::new(gpu)?.prepare(gpu, &mesh, matrices, &crowd)?;
        Ok(Self { mesh, clusters, crowd, select, active, skinned, palette, selections, jobs, reader })
    }

    /// Records the skinning of instances that are seen, at their level of detail, for these clusters: those with a
    /// bone that was updated since the last such recording or with a changed morph weight, those beyond the level of
    /// the frame before, and all clusters of instances whose influences changed or that were not seen in the frame
    /// before. The first recording thus skins everything that is seen. It counts frames ([`SelectBuffers::skinned`]):
    /// record it at most once per frame; frames may do without. The last of several frames of skinning over the same
    /// model matrices clears the updated bones ([`UpdatedBones`]).
    pub fn record_updated_bones(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch_updated_bones(&mut compute_pass(encoder, "skinning"));
    }

    /// Adds the same work as [`SkinFrame::record_updated_bones`] to a compute pass that is being recorded.
    pub fn dispatch_updated_bones(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.palette.dispatch(pass);
        let [keeping, clearing] = &self.selections;
        if self.reader.read() { clearing } else { keeping }.dispatch(pass);
        self.jobs.iter().for_each(|job| job.dispatch(pass));
    }

    /// Reads the vertices of an instance, in the mesh's own order; those beyond its level of detail are out of
    /// date. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist; [`crate::gpu::GpuError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read(&self, gpu: &Gpu, instance: usize) -> Result<Vec<Vertex>, Error> {
        InputError::check_below("instance", instance, self.crowd.instances)?;
        let vertices = self.mesh.vertices.len();
        let all = self.skinned.read_blocking(gpu)?;
        Ok(self.clusters.in_mesh_order(&all[instance * vertices..][..vertices]))
    }
}
