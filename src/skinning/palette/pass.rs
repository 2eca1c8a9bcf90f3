//! `kernels/skinning/palette.wgsl`.

use encase::ShaderType;

use crate::Error;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::vertex::Blend;

/// `PaletteParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct PaletteParams {
    pub bones: u32,
    pub all_bones: u32,
    pub pairs: u32,
}

/// Makes palettes.
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

    /// Prepares the palettes of all instances that are seen, from `models`, as [`crate::animation::concat`] writes them.
    ///
    /// # Errors
    /// [`crate::InputError`] for fewer models than the crowd needs; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        models: &Buffer<Affine>,
        crowd: &SkinnedCrowd,
    ) -> Result<Job, Error> {
        models.check_holds("models", crowd.instances * mesh.all_bones)?;
        crowd.reductions.check_holds("crowd.reductions", crowd.instances)?;
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
            models.raw().as_entire_binding(),
            crowd.reductions.raw().as_entire_binding(),
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
