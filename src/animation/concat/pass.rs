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

/// How threads share the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
    /// A thread a chain, a dispatch a level of chains: enough threads for a real GPU.
    Levels,
    /// A thread an instance, one dispatch: an instance's bones stay in the cache of a processor. On lavapipe about
    /// one and a half times as fast; a workgroup an instance with barriers between levels is three times as slow.
    Whole,
}

impl Walk {
    /// The faster one on this kind of adapter.
    pub fn of(gpu: &Gpu) -> Self {
        if gpu.adapter().kind == "cpu" { Self::Whole } else { Self::Levels }
    }
}

/// Concatenates local transforms.
#[derive(Debug, Clone)]
pub struct ConcatPass {
    kernel: Kernel,
    walk: Walk,
}

/// A prepared concatenation: a dispatch for each level of chains.
pub type ConcatJob = Job;

impl ConcatPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, walk: Walk) -> Result<Self, GpuError> {
        let whole = f64::from(walk == Walk::Whole);
        Ok(Self { kernel: Kernel::new(gpu, &shaders::ANIMATION_CONCAT, &[("WHOLE", whole)])?, walk })
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
                workgroups: self.kernel.spread(
                    gpu,
                    match self.walk {
                        Walk::Levels => params.instances * params.chains,
                        Walk::Whole => params.instances,
                    },
                ),
                kernel: self.kernel.clone(),
            })
        };
        let every = [0, all.chains.len() as u32];
        let levels: Vec<&[u32]> = match self.walk {
            Walk::Levels => all.levels.windows(2).collect(),
            Walk::Whole => vec![&every],
        };
        let steps = levels.into_iter().map(level).collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "animation/concat", steps)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(concat_params_layout: ConcatParams = ANIMATION_CONCAT "ConcatParams");
}
