//! The skinning of a crowd: all steps from the bones' matrices to drawable vertices.

use std::sync::Arc;

use super::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use super::clusters::Clusters;
use super::morph::MorphPass;
use super::palette::PalettePass;
use super::select::{ClusterSelectBuffers, ClusterSelectPass};
use super::skin::SkinPass;
use crate::animation::model_matrices::Consumer;
use crate::animation::updated_bones::UpdatedBonesReader;
use crate::animation::{ModelMatrices, UpdatedBones};
use crate::asset::Model;
use crate::gpu::{Buffer, Gpu, Job, compute_pass};
use crate::skinning::vertex::{Blend, Vertex};
use crate::{Error, InputError};

/// What a [`SkinFrame`] skins, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkinOptions {
    /// Index of the mesh in the model.
    pub mesh: usize,
    /// Number of instances, at least 1.
    pub instances: usize,
    /// Blending of bones.
    pub blend: Blend,
}

/// The prepared skinning of all instances of one mesh.
#[derive(Debug, Clone)]
pub struct SkinFrame {
    /// The mesh on the device.
    pub mesh: MeshBuffers,
    /// The arrangement of the mesh's vertices.
    pub clusters: Clusters,
    /// LODs and morph weights of instances, which the caller may write.
    pub crowd: SkinnedCrowd,
    /// The updated bones: those that the model matrices record, or, if they record none, those that the caller writes.
    /// [`SkinFrame::record_updated_bones`] clears the caller's.
    pub select: ClusterSelectBuffers,
    /// The clusters selected by the last [`SkinFrame::record_updated_bones`].
    pub active: ActiveClusters,
    /// Skinned vertices, at `instance · vertices + slot`. Clusters beyond an instance's level of detail are out of
    /// date.
    pub skinned: Buffer<Vertex>,
    palette: Job,
    /// Two selections: one keeps the updated bones, the other clears them.
    selections: [Job; 2],
    /// The jobs of morph targets, if there are any, and of skinning.
    jobs: Vec<Job>,
    reader: Arc<UpdatedBonesReader>,
}

impl SkinFrame {
    /// Prepares the instances of a model's mesh, with bones posed by `matrices`.
    ///
    /// # Errors
    /// [`InputError`] for a mesh that the model does not have or that does not match it, for no instances, for fewer
    /// matrices or bits of updated bones than needed, and for dual quaternions over matrices of a crowd under
    /// [`Gate::Bounded`](crate::animation::Gate::Bounded), whose bound holds for linear blending only;
    /// [`crate::gpu::GpuError`].
    pub fn new(
        gpu: &Gpu,
        model: &Model,
        matrices: &ModelMatrices,
        options: SkinOptions,
    ) -> Result<Self, Error> {
        let SkinOptions { mesh, instances, blend } = options;
        if blend == Blend::DualQuaternion {
            matrices.consumer().check(Consumer::DualQuaternions)?;
        }
        InputError::check_below("mesh", mesh, model.meshes.len())?;
        let (mesh, clusters) = MeshBuffers::new(gpu, model, &model.meshes[mesh])?;
        let crowd = SkinnedCrowd::new(gpu, &mesh, instances, blend)?;
        let mut select = ClusterSelectBuffers::new(gpu, &mesh, &crowd)?;
        let updated = match matrices.updated_bones() {
            Some(updated) => updated.clone(),
            None => UpdatedBones::over(select.updated_bones),
        };
        select.updated_bones = updated.bits().clone();
        let reader = Arc::new(updated.reader());
        let active = ActiveClusters::new(gpu, &mesh, &crowd)?;
        let skinned = Buffer::new(gpu, "skinned vertices", instances * mesh.vertices.len())?;
        let selections = ClusterSelectPass::new(gpu)?.prepare(gpu, &mesh, &crowd, &select, &active)?;
        let skin = SkinPass::new(gpu, blend)?.prepare_active(gpu, &mesh, &crowd, &skinned, &active)?;
        let morph = MorphPass::new(gpu)?.prepare_active(gpu, &mesh, &crowd, &active)?;
        let jobs = morph.into_iter().chain([skin]).collect();
        // This step is last: it claims the matrices for its kind of blending, which a refused frame must not do.
        let palette = PalettePass::new(gpu)?.prepare(gpu, &mesh, matrices, &crowd)?;
        Ok(Self { mesh, clusters, crowd, select, active, skinned, palette, selections, jobs, reader })
    }

    /// Records the skinning of visible instances at their level of detail. It skins only these clusters:
    /// - clusters with a bone that was updated since the last such recording, or with a changed morph weight;
    /// - clusters beyond the level of the frame before;
    /// - all clusters of instances whose influences changed, or that were not visible in the frame before.
    ///
    /// The first recording therefore skins everything visible. It counts frames ([`ClusterSelectBuffers::skinned`]): record it
    /// at most once per frame; frames may skip it. If several skinning frames share model matrices, the last of them
    /// clears the updated bones ([`UpdatedBones`]).
    pub fn record_updated_bones(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch_updated_bones(&mut compute_pass(encoder, "skinning"));
    }

    /// As [`SkinFrame::record_updated_bones`], into a compute pass that is being recorded.
    pub fn dispatch_updated_bones(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.palette.dispatch(pass);
        let [keeping, clearing] = &self.selections;
        if self.reader.read() { clearing } else { keeping }.dispatch(pass);
        self.jobs.iter().for_each(|job| job.dispatch(pass));
    }

    /// Reads an instance's vertices, in the mesh's own order. Vertices beyond its level of detail are out of date.
    /// Waits for the device.
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
