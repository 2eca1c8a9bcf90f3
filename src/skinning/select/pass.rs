//! The GPU pass of `kernels/skinning/select.wgsl`.

use crate::Error;
use crate::gpu::bindings::skinning::select as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::skinning::select::{self, SelectParams};
use crate::skinning::buffers::{ActiveClusters, DISPATCHED_WORDS, MeshBuffers, SkinnedCrowd};

/// The inputs of a cluster selection, and the state that it keeps between frames.
#[derive(Debug, Clone)]
pub struct ClusterSelectBuffers {
    /// For each instance, the set of bones that were updated since the last selection. A set takes
    /// [`MeshBuffers::mask_words`] words: one bit per bone, in the skeleton's order.
    ///
    /// Under a gate, [`SkinFrame`](crate::skinning::frame::SkinFrame) uses
    /// [`Active::updated_bones`](crate::animation::active::Active::updated_bones) here. If a bone is set, all bones
    /// below it must also be set.
    pub updated_bones: Buffer<u32>,
    /// The state of each instance in the previous frame, in 5 + [`MeshBuffers::targets`] words. The words are:
    /// influence fade (as bits), largest number of influences, level of detail, skeleton tier, visibility, and the
    /// weights of the morph targets (as bits).
    ///
    /// The visibility word is 0 for an invisible instance, 1 for an instance that has just become visible, and 2 for an
    /// instance that was also visible in the previous frame. All words are 0 at first, so the first frame skins
    /// everything visible.
    pub skinned: Buffer<u32>,
}

/// Words per instance in [`ClusterSelectBuffers::skinned`], not counting its morph weights.
pub const SKINNED_WORDS: usize = select::SKINNED_WORDS as usize;

impl ClusterSelectBuffers {
    /// Allocates the buffers for a crowd. No bone is marked as updated.
    ///
    /// # Errors
    /// [`GpuError`] if a buffer cannot be allocated.
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Self, GpuError> {
        Ok(Self {
            updated_bones: Buffer::new(gpu, "updated bones", crowd.instances * mesh.mask_words)?,
            skinned: Buffer::new(gpu, "skinned last", crowd.instances * (SKINNED_WORDS + mesh.targets))?,
        })
    }
}

/// GPU pass that selects the clusters to skin.
#[derive(Debug, Clone)]
pub struct ClusterSelectPass {
    select: Kernel,
    finish: Kernel,
    finish_and_clear: Kernel,
}

impl ClusterSelectPass {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`GpuError`] if the driver cannot compile a kernel.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel =
            |finish, clear| bindings::kernel(gpu, &bindings::Constants { finish, clear, keep: false });
        Ok(Self {
            select: kernel(false, false)?,
            finish: kernel(true, false)?,
            finish_and_clear: kernel(true, true)?,
        })
    }

    /// Prepares two jobs that select clusters: the first keeps the record of updated bones, the second clears it.
    ///
    /// # Errors
    /// [`crate::InputError`] if the buffers belong to another crowd; [`GpuError`] from the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        buffers: &ClusterSelectBuffers,
        active: &ActiveClusters,
    ) -> Result<[Job; 2], Error> {
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
            // The kernel compares weights as bits, so it reads them as integers.
            weights: crowd.weights.slice().cast(),
            offsets: mesh.delta_offsets.slice(),
            skinned: buffers.skinned.slice(),
            pairs: active.pairs.slice(),
            dispatched: active.dispatched.slice().cast(),
        };
        // Selection uses another variant of the kernel if positions of the previous frame are kept.
        let select = match active.keeps_last {
            true => &bindings::kernel(gpu, &bindings::Constants { keep: true, ..Default::default() })?,
            false => &self.select,
        };
        let step = |kernel, threads| {
            Ok::<_, GpuError>(Step::spread(gpu, kernel, vec![group.bind(gpu, kernel)?], threads as u32))
        };
        let job = |finish| {
            let steps = vec![step(select, pairs)?, step(finish, crowd.instances)?];
            Job::new(gpu, "skinning/select", steps)
        };
        Ok([job(&self.finish)?, job(&self.finish_and_clear)?])
    }
}
