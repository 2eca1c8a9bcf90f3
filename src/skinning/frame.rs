//! The skinning of a crowd: all GPU passes from the bones' matrices to drawable vertices.

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

/// Options of a [`SkinFrame`]: the mesh, the number of instances, and the blending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkinOptions {
    /// Index of the mesh in the model.
    pub mesh: usize,
    /// Number of instances, at least 1.
    pub instances: usize,
    /// The kind of blending of bones.
    pub blend: Blend,
}

/// All GPU passes that skin the instances of one mesh, prepared for recording.
#[derive(Debug, Clone)]
pub struct SkinFrame {
    /// The mesh in GPU buffers.
    pub mesh: MeshBuffers,
    /// The order of the mesh's vertices in clusters.
    pub clusters: Clusters,
    /// Levels of detail and morph weights of the instances. The caller may write them.
    pub crowd: SkinnedCrowd,
    /// Inputs of the cluster selection. If the model matrices record updated bones, `updated_bones` is the matrices'
    /// own buffer. Otherwise the caller writes `updated_bones`, and [`SkinFrame::record_updated_bones`] clears it.
    pub select: ClusterSelectBuffers,
    /// The clusters selected by the last [`SkinFrame::record_updated_bones`].
    pub active: ActiveClusters,
    /// Skinned vertices, at index `instance · vertices + slot`. Vertices of clusters beyond an instance's level of
    /// detail are outdated.
    pub skinned: Buffer<Vertex>,
    palette: Job,
    /// Two jobs that select clusters: the first keeps the record of updated bones, the second clears it.
    selections: [Job; 2],
    /// The morphing job, if the mesh has morph targets, and the skinning job.
    jobs: Vec<Job>,
    reader: Arc<UpdatedBonesReader>,
}

impl SkinFrame {
    /// Prepares the skinning of all instances of a model's mesh. `matrices` holds the bones' poses.
    ///
    /// # Errors
    /// [`InputError`] in these cases: the model does not have the mesh; the mesh does not match the model; there are 0
    /// instances; `matrices` holds fewer matrices or updated bones than needed; dual quaternions are requested for
    /// matrices under [`Gate::Bounded`](crate::animation::Gate::Bounded), whose error bound holds for linear blending
    /// only. [`crate::gpu::GpuError`] from the device.
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
        // The palette is prepared last, because it claims the matrices for its kind of blending. A refused frame must
        // not claim them.
        let palette = PalettePass::new(gpu)?.prepare(gpu, &mesh, matrices, &crowd)?;
        Ok(Self { mesh, clusters, crowd, select, active, skinned, palette, selections, jobs, reader })
    }

    /// Records the skinning of visible instances at their level of detail. Only these clusters are skinned:
    /// - clusters with a bone that was updated since the last recording, or with a changed morph weight;
    /// - clusters that the instance's level of detail in the previous frame did not include;
    /// - all clusters of instances whose influences changed, or that were invisible in the previous frame.
    ///
    /// The first recording therefore skins everything visible. Each recording counts as one frame
    /// ([`ClusterSelectBuffers::skinned`]): record at most once per frame; frames may be skipped. If several skinning
    /// frames share model matrices, the last of them clears the updated bones ([`UpdatedBones`]).
    pub fn record_updated_bones(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch_updated_bones(&mut compute_pass(encoder, "skinning"));
    }

    /// Does the same as [`SkinFrame::record_updated_bones`], within a compute pass of the caller.
    pub fn dispatch_updated_bones(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.palette.dispatch(pass);
        let [keeping, clearing] = &self.selections;
        if self.reader.read() { clearing } else { keeping }.dispatch(pass);
        self.jobs.iter().for_each(|job| job.dispatch(pass));
    }

    /// Reads the vertices of an instance, in the mesh's own order. Vertices beyond its level of detail are outdated.
    /// Blocks until the device has finished.
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
