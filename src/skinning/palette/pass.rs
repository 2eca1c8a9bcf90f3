//! The GPU pass of `kernels/skinning/palette.wgsl`.

use encase::ShaderType;

use crate::Error;
use crate::animation::ModelMatrices;
use crate::animation::model_matrices::Consumer;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::vertex::Blend;

/// The kernel's `PaletteParams`.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct PaletteParams {
    pub bones: u32,
    pub all_bones: u32,
    pub pairs: u32,
}

/// Computes palettes.
#[derive(Debug, Clone)]
pub struct PalettePass {
    linear: Kernel,
    dual: Kernel,
}

impl PalettePass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |dual| Kernel::new(gpu, &shaders::SKINNING_PALETTE, &[("DUAL", dual)]);
        Ok(Self { linear: kernel(0.0)?, dual: kernel(1.0)? })
    }

    /// Prepares the palettes of all instances that are seen.
    ///
    /// # Errors
    /// [`crate::InputError`] for fewer matrices than the crowd needs, and for dual quaternions over matrices of
    /// a crowd under [`Gate::Bounded`](crate::animation::Gate::Bounded), whose bound holds for linear blending
    /// only; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        matrices: &ModelMatrices,
        crowd: &SkinnedCrowd,
    ) -> Result<Job, Error> {
        matrices.buffer().check_holds("matrices", crowd.instances * mesh.all_bones)?;
        crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
        if crowd.blend == Blend::DualQuaternion {
            matrices.consumer().claim(Consumer::DualQuaternions)?;
        }
        let kernel = if crowd.blend == Blend::Linear { &self.linear } else { &self.dual };
        let params = PaletteParams {
            bones: mesh.bones.len() as u32,
            all_bones: mesh.all_bones as u32,
            pairs: (crowd.instances * mesh.bones.len()) as u32,
        };
        let uniform = Uniform::new(gpu, "palette", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            mesh.bones.raw().as_entire_binding(),
            mesh.inverse_binds.raw().as_entire_binding(),
            matrices.raw().as_entire_binding(),
            crowd.instance_lods.raw().as_entire_binding(),
            crowd.palette.raw().as_entire_binding(),
        ];
        let step = Step {
            groups: vec![kernel.bind(gpu, 0, &resources)?],
            workgroups: kernel.spread(gpu, params.pairs),
            kernel: kernel.clone(),
        };
        Ok(Job::new(gpu, "skinning/palette", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(palette_params_layout: PaletteParams = SKINNING_PALETTE "PaletteParams");
}
