//! Reads of keys as sampling reads them, and its writes (`kernels/baseline/gather.wgsl`).

use encase::ShaderType;

use crate::animation::crowd::Local;
use crate::animation::place::Place;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `GatherParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct GatherParams {
    pub pairs: u32,
    pub bones: u32,
    pub keys: u32,
}

/// Moves the bytes of sampling: of each bone of each instance the two keys of three tracks around the instance's
/// place (20 words, tracks shared by all instances), and a local transform (12 words).
#[derive(Debug, Clone)]
pub struct GatherPass {
    kernel: Kernel,
}

impl GatherPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::BASELINE_GATHER, &[])? })
    }

    /// Prepares a crowd: a place an instance, whose key lies below the last; three tracks a bone, each of `keys` values.
    ///
    /// # Errors
    /// [`InputError`] for less than a bone or two keys, and for buffers that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        [bones, keys]: [usize; 2],
        places: &Buffer<Place>,
        values: &Buffer<[f32; 4]>,
        gathered: &Buffer<Local>,
    ) -> Result<Job, Error> {
        for (field, value, least) in [("bones", bones, 1), ("keys", keys, 2)] {
            if value < least {
                return Err(InputError::new(field, value, format!("must be at least {least}")).into());
            }
        }
        let pairs = places.len().saturating_mul(bones);
        values.check_holds("values", 3_usize.saturating_mul(bones).saturating_mul(keys))?;
        gathered.check_holds("gathered", pairs)?;
        let params = GatherParams { pairs: pairs as u32, bones: bones as u32, keys: keys as u32 };
        let uniform = Uniform::new(gpu, "gather", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            places.raw().as_entire_binding(),
            values.raw().as_entire_binding(),
            gathered.raw().as_entire_binding(),
        ];
        let step = Step {
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, params.pairs),
            kernel: self.kernel.clone(),
        };
        Ok(Job::new(gpu, "baseline/gather", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(gather_params_layout: GatherParams = BASELINE_GATHER "GatherParams");
}
