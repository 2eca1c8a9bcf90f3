//! The GPU pass of `kernels/skinning/select.wgsl`.

use crate::Error;
use crate::gpu::bindings::skinning::select as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::skinning::select::{self, SelectParams};
use crate::skinning::buffers::{ActiveClusters, DISPATCHED_WORDS, MeshBuffers, SkinnedCrowd};

/// The inputs of a selection, and the state that it keeps between frames.
#[derive(Debug, Clone)]
pub struct SelectBuffers {
    /// The bones of each instance that were updated since the last selection, one bit per slot of the skeleton's
    /// order, in [`MeshBuffers::mask_words`] words per instance. Under a gate,
    /// [`SkinFrame`](crate::skinning::frame::SkinFrame) uses
    /// [`Active::updated_bones`](crate::animation::active::Active::updated_bones) for it. Every bone below an
    /// updated one must be set too.
    pub updated_bones: Buffer<u32>,
    /// The state of each instance in the frame before, in 4 + [`MeshBuffers::targets`] words: the fade (as
    /// bits), largest number of influences and level of its InstanceLod; the number of frames for which it has
    /// been seen; and the weights of its targets, as bits. All words are 0 at first, so that everything that is
    /// seen then is skinned.
    ///
    /// The fourth word is 0 for an instance that is not seen, 1 for one that is seen for the first time or
    /// again, and 2 for one that was seen in the frame before too. At 1, the vertices that
    /// [`keep_last`](crate::skinning::skin::keep_last) copied belong to an earlier time or are unwritten;
    /// motion vectors can then use the placement only.
    pub skinned: Buffer<u32>,
}

/// Words per instance in [`SelectBuffers::skinned`], before its weights.
pub const SKINNED_WORDS: usize = select::SKINNED_WORDS as usize;

impl SelectBuffers {
    /// Allocates the buffers for a crowd, with no updated bone.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Self, GpuError> {
        Ok(Self {
            updated_bones: Buffer::new(gpu, "updated bones", crowd.instances * mesh.mask_words)?,
            skinned: Buffer::new(gpu, "skinned last", crowd.instances * (SKINNED_WORDS + mesh.targets))?,
        })
    }
}

/// Selects clusters.
#[derive(Debug, Clone)]
pub struct SelectPass {
    select: Kernel,
    finish: Kernel,
    finish_and_clear: Kernel,
}

impl SelectPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel =
            |finish, clear| bindings::kernel(gpu, &bindings::Constants { finish, clear, keep: false });
        Ok(Self {
            select: kernel(false, false)?,
            finish: kernel(true, false)?,
            finish_and_clear: kernel(true, true)?,
        })
    }

    /// Prepares the list of clusters to be skinned. The updated bones stay as they are.
    ///
    /// # Errors
    /// [`crate::InputError`] for buffers of another crowd; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        buffers: &SelectBuffers,
        active: &ActiveClusters,
    ) -> Result<Job, Error> {
        self.job(gpu, mesh, crowd, (buffers, active), &self.finish)
    }

    /// As [`SelectPass::prepare`]; afterwards no bone is updated any more.
    ///
    /// # Errors
    /// As [`SelectPass::prepare`].
    pub fn prepare_clearing(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        buffers: &SelectBuffers,
        active: &ActiveClusters,
    ) -> Result<Job, Error> {
        self.job(gpu, mesh, crowd, (buffers, active), &self.finish_and_clear)
    }

    /// Both selections: the one that keeps the updated bones, and the one that clears them.
    pub(crate) fn prepare_both(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        buffers: &SelectBuffers,
        active: &ActiveClusters,
    ) -> Result<[Job; 2], Error> {
        Ok([
            self.prepare(gpu, mesh, crowd, buffers, active)?,
            self.prepare_clearing(gpu, mesh, crowd, buffers, active)?,
        ])
    }

    /// The kernel that selects, where last positions are kept or not.
    fn selecting(&self, gpu: &Gpu, keep: bool) -> Result<Kernel, GpuError> {
        if keep {
            bindings::kernel(gpu, &bindings::Constants { keep, ..Default::default() })
        } else {
            Ok(self.select.clone())
        }
    }

    fn job(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        (buffers, active): (&SelectBuffers, &ActiveClusters),
        finish: &Kernel,
    ) -> Result<Job, Error> {
        let pairs = crowd.instances * mesh.clusters();
        buffers.updated_bones.check_holds("updated_bones", crowd.instances * mesh.mask_words)?;
        buffers.skinned.check_holds("skinned", crowd.instances * (SKINNED_WORDS + mesh.targets))?;
        crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
        crowd.weights.check_holds("crowd.weights", crowd.instances * mesh.targets)?;
        active.dispatched.check_holds("active.dispatched", DISPATCHED_WORDS)?;
        active.pairs.check_holds("active.pairs", active.words(pairs))?;
        let params = SelectParams {
            instances: crowd.instances as u32,
            clusters: mesh.clusters() as u32,
            words: mesh.mask_words as u32,
            most: gpu.device().limits().max_compute_workgroups_per_dimension,
            vertices: mesh.vertices.len() as u32,
            targets: mesh.targets as u32,
            levels: mesh.clusters_of_levels(),
        };
        let uniform = Uniform::new(gpu, "select", &params)?;
        let group = bindings::Group {
            params: &uniform,
            masks: mesh.masks.slice(),
            updated_bones: buffers.updated_bones.slice(),
            instance_lods: crowd.instance_lods.slice(),
            // Compared as bits.
            weights: crowd.weights.slice().cast(),
            offsets: mesh.delta_offsets.slice(),
            skinned: buffers.skinned.slice(),
            pairs: active.pairs.slice(),
            dispatched: active.dispatched.slice().cast(),
        };
        let step = |kernel: &Kernel, threads: usize| {
            Ok(Step {
                groups: vec![group.bind(gpu, kernel)?],
                workgroups: kernel.spread(gpu, threads as u32),
                kernel: kernel.clone(),
            })
        };
        let steps = [step(&self.selecting(gpu, active.keeps_last)?, pairs), step(finish, crowd.instances)];
        let steps = steps.into_iter().collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "skinning/select", steps)?)
    }
}
