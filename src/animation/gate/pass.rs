//! The GPU pass of `kernels/animation/gate.wgsl`. The kernels of [`Gate::Budget`] are in `animation::budget`.

use super::{Frame, Gate};
use crate::Error;
use crate::animation::active::Active;
use crate::animation::budget::{BudgetJob, BudgetPass};
use crate::animation::crowd::Crowd;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::TableBuffers;
use crate::animation::model_matrices::Consumer;
use crate::gpu::bindings::animation::gate as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform, Upload, compute_pass};
use crate::shared::animation::gate::{BOUNDED, GateParams, OFF, RANDOM, SKIP_PERIOD, UNIFORM};

/// Chooses the bones to sample by any [`Gate`], on the GPU.
#[derive(Debug, Clone)]
pub struct GatePass {
    decider: Decider,
}

#[derive(Debug, Clone)]
enum Decider {
    /// The gate kernel, compiled for one mode. `period` (in ticks) and `first_above` (index of the first row of parents) are 0 in
    /// modes that do not use them.
    Gate { kernel: Kernel, mode: u32, period: u32, first_above: u32, table: TableBuffers },
    /// The kernels of [`Gate::Budget`].
    Budget(Box<BudgetPass>),
}

impl GatePass {
    /// Uploads a gate's table and compiles its pipelines.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device, including too little memory for the table.
    pub fn new(gpu: &Gpu, gate: &Gate) -> Result<Self, GpuError> {
        let (mut period, mut first_above) = (0, 0);
        let (mode, table) = match gate {
            Gate::Off(bones) => (OFF, TableBuffers::of_animated_bones(gpu, bones)?),
            Gate::Uniform(bones) => (UNIFORM, TableBuffers::of_animated_bones(gpu, bones)?),
            Gate::Random(bones) => (RANDOM, TableBuffers::of_animated_bones(gpu, bones)?),
            Gate::SkipPeriod { table, period: ticks } => {
                period = *ticks;
                (SKIP_PERIOD, TableBuffers::of_priorities(gpu, table)?)
            }
            Gate::Bounded(table) => {
                first_above = table.first_above();
                (BOUNDED, TableBuffers::of_bounds(gpu, table)?)
            }
            Gate::Budget { table, bones } => {
                let budget = BudgetPass::new(gpu, table, *bones)?;
                return Ok(Self { decider: Decider::Budget(Box::new(budget)) });
            }
        };
        let kernel = bindings::kernel(gpu, &bindings::Constants { mode })?;
        Ok(Self { decider: Decider::Gate { kernel, mode, period, first_above, table } })
    }

    /// Prepares a job that chooses which bones of a crowd are sampled. The crowd's clip clocks are the input.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device; [`InputError`](crate::InputError) in these cases:
    ///
    /// - the crowd's bones, clips or rotation path differ from the gate's table;
    /// - `active` belongs to another crowd;
    /// - the gate is [`Gate::Bounded`], and the model matrices were prepared for dual quaternion blending.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        state: &GateState,
        active: &Active,
    ) -> Result<GateJob, Error> {
        let (kernel, mode, period, first_above, table) = match &self.decider {
            Decider::Gate { kernel, mode, period, first_above, table } => {
                (kernel, *mode, *period, *first_above, table)
            }
            Decider::Budget(pass) => {
                return Ok(GateJob { work: Work::Budget(pass.prepare(gpu, crowd, state, active)?) });
            }
        };
        table.check(crowd)?;
        active.pairs.check_crowd(crowd)?;
        let params = GateParams {
            instances: state.lods.len() as u32,
            bones: crowd.bones as u32,
            words: table.words,
            stride: table.stride,
            first_above,
            clips: table.clips,
            tiers: table.tiers,
            ticks: 0,
            frame_ticks: 0,
            period,
            frame: 0,
        };
        let uniform = Uniform::new(gpu, "gate", &params)?;
        // Error budget that each bone leaves for its descendants in the same frame.
        let is_bounded = mode == BOUNDED;
        let remaining = Buffer::new(gpu, "remaining", if is_bounded { crowd.pairs() } else { 0 })?;
        if is_bounded {
            crowd.model_matrices.consumer().claim(Consumer::BoundedGate)?;
        }
        let group = bindings::Group {
            params: &uniform,
            lods: state.lods.slice(),
            clip_clocks: state.clip_clocks.slice(),
            animated_bones: table.animated_bones.slice(),
            table: table.rows.slice(),
            sampled: state.sampled.slice(),
            remaining: remaining.slice(),
            bits: active.bits.slice(),
        };
        // One thread per word of bits. Under a bounded gate, the words of an instance depend on one another, so one thread
        // decides all of them.
        let threads = params.instances * if is_bounded { 1 } else { params.words };
        let job = Job::spread(gpu, "animation/gate", kernel, group.bind(gpu, kernel)?, threads)?;
        Ok(GateJob { work: Work::Gate { params, uniform, job } })
    }
}

/// A prepared gate. In each frame, set the clock values, then record.
#[derive(Debug, Clone)]
pub struct GateJob {
    work: Work,
}

#[derive(Debug, Clone)]
enum Work {
    Gate { params: GateParams, uniform: Uniform<GateParams>, job: Job },
    Budget(BudgetJob),
}

impl GateJob {
    /// Sets the clock values of the next submission. [`Gate::Budget`] ignores them.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn set(&self, gpu: &Gpu, frame: &Frame) -> Result<(), GpuError> {
        self.set_through(&mut &*gpu, frame)
    }

    /// Does the same as [`GateJob::set`], but writes through `upload`. With [`Staged`](crate::gpu::Staged) writes, one submission
    /// may contain several frames.
    ///
    /// # Errors
    /// Same as [`GateJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, frame: &Frame) -> Result<(), GpuError> {
        let Frame { ticks, frame_ticks, frame, ahead: _ } = *frame;
        match &self.work {
            Work::Gate { params, uniform, .. } => {
                upload.uniform(uniform, &GateParams { ticks, frame_ticks, frame, ..*params })
            }
            Work::Budget(_) => Ok(()),
        }
    }

    /// Records the gate in a compute pass of its own.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "animation/gate"));
    }

    /// Records the gate in an open compute pass.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        match &self.work {
            Work::Gate { job, .. } => job.dispatch(pass),
            Work::Budget(job) => job.dispatch(pass),
        }
    }
}
