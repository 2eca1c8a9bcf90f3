//! The GPU pass of `kernels/skinning/palette.wgsl`.

use crate::Error;
use crate::animation::ModelMatrices;
use crate::animation::model_matrices::Consumer;
use crate::gpu::bindings::skinning::palette as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Uniform};
use crate::shared::skinning::palette::PaletteParams;
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::vertex::Blend;

/// GPU pass that computes the palettes of a crowd.
#[derive(Debug, Clone)]
pub struct PalettePass {
    linear: Kernel,
    dual: Kernel,
}

impl PalettePass {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`GpuError`] if the driver cannot compile a kernel.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |dual| bindings::kernel(gpu, &bindings::Constants { dual });
        Ok(Self { linear: kernel(false)?, dual: kernel(true)? })
    }

    /// Prepares the computation of the palettes of all visible instances.
    ///
    /// # Errors
    /// [`crate::InputError`] if there are fewer matrices than the crowd needs. Also if dual quaternions are requested
    /// for matrices under [`Gate::Bounded`](crate::animation::Gate::Bounded), whose error bound holds for linear
    /// blending only. [`GpuError`] from the device.
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
        let group = bindings::Group {
            params: &uniform,
            bones: mesh.bones.slice(),
            inverse_binds: mesh.inverse_binds.slice().cast(),
            model_matrices: matrices.buffer().slice().cast(),
            instance_lods: crowd.instance_lods.slice(),
            palette: crowd.palette.slice(),
        };
        let group = group.bind(gpu, kernel)?;
        Ok(Job::spread(gpu, "skinning/palette", kernel, group, params.pairs)?)
    }
}
