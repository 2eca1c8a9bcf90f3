//! `kernels/animation/phase.wgsl`.

use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::gate::Gating;
use crate::animation::place::{check_elapsed, check_seconds};
use crate::gpu::bindings::animation::phase as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Resource, Step, Uniform, shaders};
use crate::shared::animation::phase::PhaseParams;
use crate::{Error, InputError};

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
        Ok(Self { kernel: bindings::kernel(gpu)? })
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
        let time = PhaseTime::new(gpu, clips, crowd, gating)?;
        let step = Step {
            groups: vec![self.kernel.bind(gpu, 0, &resources(&time, clips, crowd, gating))?],
            workgroups: self.kernel.spread(gpu, time.params.instances),
            kernel: self.kernel.clone(),
        };
        Ok(PhaseJob { time, job: Job::new(gpu, "animation/phase", vec![step])? })
    }
}

/// What is bound, in the order of `wgsl/animation/phase.wgsl`.
pub(crate) fn resources<'a>(
    time: &'a PhaseTime,
    clips: &'a ClipBuffers,
    crowd: &'a Crowd,
    gating: &'a Gating,
) -> [Resource<'a>; 9] {
    [
        time.uniform.raw().as_entire_binding(),
        crowd.instances.raw().as_entire_binding(),
        clips.clips.raw().as_entire_binding(),
        clips.timelines.raw().as_entire_binding(),
        clips.times.raw().as_entire_binding(),
        gating.lods.raw().as_entire_binding(),
        crowd.shares.raw().as_entire_binding(),
        gating.history.raw().as_entire_binding(),
        gating.phases.raw().as_entire_binding(),
    ]
}

/// The time of the next submission.
#[derive(Debug, Clone)]
pub(crate) struct PhaseTime {
    params: PhaseParams,
    uniform: Uniform<PhaseParams>,
}

impl PhaseTime {
    pub fn new(gpu: &Gpu, clips: &ClipBuffers, crowd: &Crowd, gating: &Gating) -> Result<Self, Error> {
        let clips_len = gating.movers.len() / (gating.words as usize + 1);
        if clips_len != clips.clips.len() {
            let bound = format!("must be {}, those of the set", clips.clips.len());
            return Err(InputError::new("table.clips", clips_len, bound).into());
        }
        let params = PhaseParams {
            instances: gating.lods.len() as u32,
            elapsed: 0.0,
            layers: crowd.layers as u32 - 1,
            ahead: 0.0,
        };
        Ok(Self { params, uniform: Uniform::new(gpu, "phase", &params)? })
    }

    /// As [`PhaseJob::set`].
    pub fn set(&self, gpu: &Gpu, elapsed: f32, ahead: f32) -> Result<(), Error> {
        check_elapsed(elapsed)?;
        check_seconds("frame.ahead", ahead)?;
        Ok(self.uniform.write(gpu, &PhaseParams { elapsed, ahead, ..self.params })?)
    }
}

/// Prepared phases: set the time, then record.
#[derive(Debug, Clone)]
pub struct PhaseJob {
    time: PhaseTime,
    job: Job,
}

impl PhaseJob {
    /// Chooses the time of the next submission, as for [`super::super::place::PlaceJob::set`], and by how many seconds bones
    /// may be sampled ahead of it, as [`Frame::ahead`](crate::animation::gate::Frame::ahead).
    ///
    /// # Errors
    /// [`InputError`] for seconds beyond ±[`MOST_SECONDS`](crate::animation::place::MOST_SECONDS); [`GpuError`].
    pub fn set(&self, gpu: &Gpu, elapsed: f32, ahead: f32) -> Result<(), Error> {
        self.time.set(gpu, elapsed, ahead)
    }

    /// Records the pass.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }

    /// Adds the pass to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.job.dispatch(pass);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mark_of_layers_is_the_kernel_s() {
        let shader = &crate::gpu::shaders::ANIMATION_PHASE;
        assert_eq!(crate::gpu::layout::constant(shader, "BLENDED"), Some(crate::animation::phase::BLENDED));
    }
}
