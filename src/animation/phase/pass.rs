//! `kernels/animation/phase.wgsl`.

use encase::ShaderType;

use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::gate::Gating;
use crate::animation::place::check_elapsed;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `PhaseParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct PhaseParams {
    pub instances: u32,
    pub elapsed: f32,
    pub layers: u32,
}

/// Finds phases.
#[derive(Debug, Clone)]
pub struct PhasePass {
    kernel: Kernel,
}

impl PhasePass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::ANIMATION_PHASE, &[])? })
    }

    /// Prepares the phases of a crowd.
    ///
    /// # Errors
    /// [`InputError`] for a table of other clips; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        clips: &ClipBuffers,
        crowd: &Crowd,
        gating: &Gating,
    ) -> Result<PhaseJob, Error> {
        let clips_len = gating.movers.len() / (gating.words as usize + 1);
        if clips_len != clips.clips.len() {
            let bound = format!("must be {}, those of the set", clips.clips.len());
            return Err(InputError::new("table.clips", clips_len, bound).into());
        }
        let params = PhaseParams {
            instances: gating.lods.len() as u32,
            elapsed: 0.0,
            layers: crowd.layers as u32 - 1,
        };
        let uniform = Uniform::new(gpu, "phase", &params)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            crowd.instances.raw().as_entire_binding(),
            clips.clips.raw().as_entire_binding(),
            clips.timelines.raw().as_entire_binding(),
            clips.times.raw().as_entire_binding(),
            gating.lods.raw().as_entire_binding(),
            crowd.shares.raw().as_entire_binding(),
            gating.history.raw().as_entire_binding(),
            gating.phases.raw().as_entire_binding(),
        ];
        let step = Step {
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, params.instances),
            kernel: self.kernel.clone(),
        };
        Ok(PhaseJob { params, uniform, job: Job::new(gpu, "animation/phase", vec![step])? })
    }
}

/// Prepared phases: set the time, then record.
#[derive(Debug, Clone)]
pub struct PhaseJob {
    params: PhaseParams,
    uniform: Uniform<PhaseParams>,
    job: Job,
}

impl PhaseJob {
    /// Chooses the time of the next submission, as for [`super::super::place::PlaceJob::set`].
    ///
    /// # Errors
    /// [`InputError`] for seconds beyond ±[`MOST_SECONDS`](crate::animation::place::MOST_SECONDS); [`GpuError`].
    pub fn set(&self, gpu: &Gpu, elapsed: f32) -> Result<(), Error> {
        check_elapsed(elapsed)?;
        Ok(self.uniform.write(gpu, &PhaseParams { elapsed, ..self.params })?)
    }

    /// Records the pass.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(phase_params_layout: PhaseParams = ANIMATION_PHASE "PhaseParams");

    #[test]
    fn the_mark_of_layers_is_the_kernel_s() {
        let shader = &crate::gpu::shaders::ANIMATION_PHASE;
        assert_eq!(crate::gpu::layout::constant(shader, "BLENDED"), Some(crate::animation::phase::BLENDED));
    }
}
