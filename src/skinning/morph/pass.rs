//! `kernels/skinning/morph.wgsl`.

use encase::ShaderType;

use crate::Error;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};

/// `MorphParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct MorphParams {
    pub vertices: u32,
    pub targets: u32,
    pub pairs: u32,
}

/// Adds morph targets.
#[derive(Debug, Clone)]
pub struct MorphPass {
    kernel: Kernel,
}

impl MorphPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::SKINNING_MORPH, &[])? })
    }

    /// Prepares the morphed vertices of all instances. Of a mesh without targets there are none, and nothing is done.
    ///
    /// # Errors
    /// [`crate::InputError`] for a crowd of another mesh; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Job, Error> {
        if mesh.targets == 0 {
            return Ok(Job::new(gpu, "skinning/morph", Vec::new())?);
        }
        let pairs = crowd.instances * mesh.vertices.len();
        crowd.morphed.check_holds("crowd.morphed", pairs)?;
        crowd.weights.check_holds("crowd.weights", crowd.instances * mesh.targets)?;
        let params = MorphParams {
            vertices: mesh.vertices.len() as u32,
            targets: mesh.targets as u32,
            pairs: pairs as u32,
        };
        let uniform = Uniform::new(gpu, "morph", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            mesh.vertices.raw().as_entire_binding(),
            mesh.delta_offsets.raw().as_entire_binding(),
            mesh.deltas.raw().as_entire_binding(),
            crowd.weights.raw().as_entire_binding(),
            crowd.morphed.raw().as_entire_binding(),
        ];
        let step = Step {
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, params.pairs),
            kernel: self.kernel.clone(),
        };
        Ok(Job::new(gpu, "skinning/morph", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(morph_params_layout: MorphParams = SKINNING_MORPH "MorphParams");
}
