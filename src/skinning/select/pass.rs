//! The GPU pass of `kernels/skinning/select.wgsl`.

use encase::ShaderType;
use glam::UVec4;

use crate::Error;
use crate::asset::mesh::MAX_LEVELS;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::skinning::buffers::{ActiveClusters, DISPATCHED_WORDS, MeshBuffers, SkinnedCrowd};

/// The kernel's `SelectParams`.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct SelectParams {
    pub instances: u32,
    pub clusters: u32,
    pub words: u32,
    pub most: u32,
    pub vertices: u32,
    pub targets: u32,
    pub levels: [UVec4; MAX_LEVELS / 4],
}

/// The inputs of a selection, and the state that it keeps between frames.
#[derive(Debug, Clone)]
pub struct SelectBuffers {
    /// The bones of each instance that were updated this frame, one bit per slot of the skeleton's order, in
    /// [`MeshBuffers::mask_words`] words per instance. Under a gate,
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
pub const SKINNED_WORDS: usize = 4;

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
}

impl SelectPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |finish| Kernel::new(gpu, &shaders::SKINNING_SELECT, &[("FINISH", finish)]);
        Ok(Self { select: kernel(0.0)?, finish: kernel(1.0)? })
    }

    /// Prepares the list of clusters to be skinned.
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
        let pairs = crowd.instances * mesh.clusters();
        buffers.updated_bones.check_holds("updated_bones", crowd.instances * mesh.mask_words)?;
        buffers.skinned.check_holds("skinned", crowd.instances * (SKINNED_WORDS + mesh.targets))?;
        crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
        crowd.weights.check_holds("crowd.weights", crowd.instances * mesh.targets)?;
        active.dispatched.check_holds("active.dispatched", DISPATCHED_WORDS)?;
        active.pairs.check_holds("active.pairs", pairs)?;
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
        let resources = [
            uniform.raw().as_entire_binding(),
            mesh.masks.raw().as_entire_binding(),
            buffers.updated_bones.raw().as_entire_binding(),
            crowd.instance_lods.raw().as_entire_binding(),
            crowd.weights.raw().as_entire_binding(),
            mesh.delta_offsets.raw().as_entire_binding(),
            buffers.skinned.raw().as_entire_binding(),
            active.pairs.raw().as_entire_binding(),
            active.dispatched.raw().as_entire_binding(),
        ];
        let step = |kernel: &Kernel, threads: usize| {
            Ok(Step {
                groups: vec![kernel.bind(gpu, 0, &resources)?],
                workgroups: kernel.spread(gpu, threads as u32),
                kernel: kernel.clone(),
            })
        };
        let steps = [step(&self.select, pairs), step(&self.finish, crowd.instances)];
        let steps = steps.into_iter().collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "skinning/select", steps)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(select_params_layout: SelectParams = SKINNING_SELECT "SelectParams");

    #[test]
    fn weights_begin_where_the_kernel_has_them() {
        let shader = &crate::gpu::shaders::SKINNING_SELECT;
        assert_eq!(crate::gpu::layout::constant(shader, "SKINNED_WORDS"), Some(SKINNED_WORDS as u32));
    }
}
