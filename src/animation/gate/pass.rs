//! The GPU pass of `kernels/animation/gate.wgsl`.

use super::{Frame, Gate};
use crate::Error;
use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::Kind;
use crate::animation::model_matrices::Consumer;
use crate::gpu::bindings::animation::gate as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::animation::gate as modes;
use crate::shared::animation::gate::GateParams;

/// Decides which bones are sampled.
#[derive(Debug, Clone)]
pub struct GatePass {
    kernel: Kernel,
    gate: Gate,
}

impl GatePass {
    /// Compiles the pipeline of a gate.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, gate: Gate) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu, &bindings::Constants { mode: mode(gate) })?, gate })
    }

    /// Prepares the decision from a crowd's clip clocks.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a table of a kind that the gate cannot use or of another rotation
    /// path than the crowd's, for a crowd other than that of the active bones, and for [`Gate::Bounded`] over
    /// model matrices that are prepared for dual quaternions; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        gate_state: &GateState,
        active: &Active,
    ) -> Result<GateJob, Error> {
        let time = GateTime::new(gpu, self.gate, crowd, gate_state, active)?;
        let group = group(&time, gate_state, active).bind(gpu, &self.kernel)?;
        let step = Step {
            groups: vec![group],
            workgroups: self.kernel.spread(gpu, time.threads(self.gate)),
            kernel: self.kernel.clone(),
        };
        Ok(GateJob { time, job: Job::new(gpu, "animation/gate", vec![step])? })
    }
}

/// What a gate decides from, and its decision.
pub(crate) fn group<'a>(
    time: &'a GateTime,
    gate_state: &'a GateState,
    active: &'a Active,
) -> bindings::Group<'a> {
    bindings::Group {
        lods: gate_state.lods.slice(),
        clip_clocks: gate_state.clip_clocks.slice(),
        gate_params: &time.uniform,
        animated_bones: gate_state.animated_bones.slice(),
        table: gate_state.table.slice(),
        sampled: gate_state.sampled.slice(),
        remaining: gate_state.remaining.slice(),
        bits: active.bits.slice(),
    }
}

/// The kernel's `MODE`.
pub(crate) fn mode(gate: Gate) -> u32 {
    match gate {
        Gate::Off => modes::OFF,
        Gate::SkipPeriod { .. } => modes::SKIP_PERIOD,
        Gate::Uniform => modes::UNIFORM,
        Gate::Random => modes::RANDOM,
        Gate::Bounded => modes::BOUNDED,
    }
}

/// The frame of the next submission.
#[derive(Debug, Clone)]
pub(crate) struct GateTime {
    params: GateParams,
    uniform: Uniform<GateParams>,
}

impl GateTime {
    pub fn new(
        gpu: &Gpu,
        gate: Gate,
        crowd: &Crowd,
        gate_state: &GateState,
        active: &Active,
    ) -> Result<Self, Error> {
        let needed = match gate {
            Gate::SkipPeriod { .. } => Some(Kind::Priorities),
            Gate::Bounded => Some(Kind::Bounds),
            Gate::Off | Gate::Uniform | Gate::Random => None,
        };
        gate_state.check(needed, crowd)?;
        active.pairs.check_crowd(crowd)?;
        if gate == Gate::Bounded {
            crowd.model_matrices.consumer().claim(Consumer::BoundedGate)?;
        }
        let params = GateParams {
            instances: gate_state.lods.len() as u32,
            bones: crowd.bones as u32,
            words: gate_state.words,
            stride: gate_state.stride,
            first_above: gate_state.first_above,
            ticks: 0,
            frame_ticks: 0,
            period: if let Gate::SkipPeriod { period } = gate { period } else { 0 },
            frame: 0,
        };
        Ok(Self { params, uniform: Uniform::new(gpu, "gate", &params)? })
    }

    /// One thread per word of bits, or per instance if words depend on each other.
    fn threads(&self, gate: Gate) -> u32 {
        self.params.instances * if gate == Gate::Bounded { 1 } else { self.params.words }
    }

    /// As [`GateJob::set`].
    pub fn set(&self, gpu: &Gpu, frame: &Frame) -> Result<(), GpuError> {
        let Frame { ticks, frame_ticks, frame, ahead: _ } = *frame;
        self.uniform.write(gpu, &GateParams { ticks, frame_ticks, frame, ..self.params })
    }
}

/// A prepared decision: set the frame, then record.
#[derive(Debug, Clone)]
pub struct GateJob {
    time: GateTime,
    job: Job,
}

impl GateJob {
    /// Sets the frame of the next submission.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn set(&self, gpu: &Gpu, frame: &Frame) -> Result<(), GpuError> {
        self.time.set(gpu, frame)
    }

    /// Records the decision.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }

    /// Adds the decision to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.job.dispatch(pass);
    }
}
