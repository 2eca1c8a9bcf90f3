//! `kernels/animation/concat.wgsl`.

use encase::ShaderType;

use super::{Chain, Chains};
use crate::animation::crowd::Crowd;
use crate::animation::skeleton::Skeleton;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `ConcatParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct ConcatParams {
    pub instances: u32,
    pub bones: u32,
    pub first_chain: u32,
    pub chains: u32,
}

/// Concatenates local transforms.
#[derive(Debug, Clone)]
pub struct ConcatPass {
    kernel: Kernel,
}

/// A prepared concatenation: a dispatch for each level of chains.
pub type ConcatJob = Job;

impl ConcatPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::ANIMATION_CONCAT, &[])? })
    }

    /// Prepares the model-space matrices of a crowd from its local transforms.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another skeleton; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, skeleton: &Skeleton, crowd: &Crowd) -> Result<ConcatJob, Error> {
        if crowd.bones != skeleton.len() {
            let bound = format!("must be {}, as the skeleton's", skeleton.len());
            return Err(InputError::new("crowd.bones", crowd.bones, bound).into());
        }
        let all = Chains::new(skeleton);
        let chains: Buffer<Chain> = Buffer::from_slice(gpu, "chains", &all.chains)?;
        let bones = Buffer::from_slice(gpu, "chain bones", &all.bones)?;
        let level = |level: &[u32]| {
            let params = ConcatParams {
                instances: crowd.instances.len() as u32,
                bones: crowd.bones as u32,
                first_chain: level[0],
                chains: level[1] - level[0],
            };
            let uniform = Uniform::new(gpu, "concat", &params)?;
            let resources = [
                uniform.raw().as_entire_binding(),
                chains.raw().as_entire_binding(),
                bones.raw().as_entire_binding(),
                crowd.locals.raw().as_entire_binding(),
                crowd.models.raw().as_entire_binding(),
            ];
            Ok(Step {
                groups: vec![self.kernel.bind(gpu, 0, &resources)?],
                workgroups: self.kernel.spread(gpu, params.instances * params.chains),
                kernel: self.kernel.clone(),
            })
        };
        let steps = all.levels.windows(2).map(level).collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "animation/concat", steps)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(concat_params_layout: ConcatParams = ANIMATION_CONCAT "ConcatParams");
}
