//! The pass of `kernels/animation/gate.wgsl`; the kernels of [`Gate::Budget`] belong to `animation::budget`.

use super::{Frame, Gate};
use crate::animation::active::Active;
use crate::animation::budget::{BudgetJob, BudgetPass};
use crate::animation::crowd::Crowd;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::TableBuffers;
use crate::animation::model_matrices::Consumer;
use crate::gpu::bindings::animation::gate as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, Upload};
use crate::shared::animation::gate as modes;
use crate::shared::animation::gate::GateParams;
use crate::{Error, InputError};

/// Decides which bones are sampled.
#[derive(Debug, Clone)]
pub struct GatePass {
    decider: Decider<Kernel>,
}

/// The pass that decides: the gate's kernel, compiled as `K`, or the kernels of a budget.
#[derive(Debug, Clone)]
pub(crate) enum Decider<K> {
    Gate(UploadedGate, K),
    Budget(Box<BudgetPass>),
}

impl GatePass {
    /// Uploads a gate's table and compiles its pipelines.
    ///
    /// # Errors
    /// [`GpuError`] if the device has no room for the table, or fails.
    pub fn new(gpu: &Gpu, gate: &Gate) -> Result<Self, GpuError> {
        let kernel = |mode: Mode| bindings::kernel(gpu, &bindings::Constants { mode: mode.constant() });
        Ok(Self { decider: Decider::new(gpu, gate, kernel)? })
    }

    /// A gate whose decisions are made by the pass of a budget.
    pub(crate) fn of_budget(pass: BudgetPass) -> Self {
        Self { decider: Decider::Budget(Box::new(pass)) }
    }

    /// Prepares the decision from a crowd's clip clocks.
    ///
    /// # Errors
    /// [`InputError`] for a crowd with other bones or clips than the gate's table, for a table whose motion
    /// was computed along another rotation path than the crowd uses, for lists of active bones of another
    /// crowd, and for [`Gate::Bounded`] if the model matrices were prepared for dual quaternion blending;
    /// [`GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        state: &GateState,
        active: &Active,
    ) -> Result<GateJob, Error> {
        let (gate, kernel) = match &self.decider {
            Decider::Gate(gate, kernel) => (gate, kernel),
            Decider::Budget(pass) => {
                return Ok(GateJob { work: Work::Budget(pass.prepare(gpu, crowd, state, active)?) });
            }
        };
        let time = GateTime::new(gpu, gate, crowd, state, active)?;
        let group = group(&time, &gate.table, state, active).bind(gpu, kernel)?;
        let step = Step {
            groups: vec![group],
            workgroups: kernel.spread(gpu, time.threads(gate.mode)),
            kernel: kernel.clone(),
        };
        let job = Job::new(gpu, "animation/gate", vec![step])?;
        Ok(GateJob { work: Work::Gate { time, job } })
    }
}

/// The bindings of a gate: what it decides from, and its decision.
pub(crate) fn group<'a>(
    time: &'a GateTime,
    table: &'a TableBuffers,
    state: &'a GateState,
    active: &'a Active,
) -> bindings::Group<'a> {
    bindings::Group {
        lods: state.lods.slice(),
        clip_clocks: state.clip_clocks.slice(),
        gate_params: &time.uniform,
        animated_bones: table.animated_bones.slice(),
        table: table.rows.slice(),
        sampled: state.sampled.slice(),
        remaining: time.remaining.slice(),
        bits: active.bits.slice(),
    }
}

impl<K> Decider<K> {
    /// Uploads a gate's table; unless the gate is a budget, `kernel` compiles the kernel for its mode.
    pub fn new(
        gpu: &Gpu,
        gate: &Gate,
        kernel: impl FnOnce(Mode) -> Result<K, GpuError>,
    ) -> Result<Self, GpuError> {
        let (mode, table) = match gate {
            Gate::Off(bones) => (Mode::Off, TableBuffers::of_animated_bones(gpu, bones)?),
            Gate::SkipPeriod { table, period } => {
                (Mode::SkipPeriod { period: *period }, TableBuffers::of_priorities(gpu, table)?)
            }
            Gate::Uniform(bones) => (Mode::Uniform, TableBuffers::of_animated_bones(gpu, bones)?),
            Gate::Random(bones) => (Mode::Random, TableBuffers::of_animated_bones(gpu, bones)?),
            Gate::Bounded(table) => {
                let mode = Mode::Bounded { first_above: table.first_above() };
                (mode, TableBuffers::of_bounds(gpu, table)?)
            }
            Gate::Budget { table, bones } => {
                return Ok(Self::Budget(Box::new(BudgetPass::new(gpu, table, *bones)?)));
            }
        };
        Ok(Self::Gate(UploadedGate { mode, table }, kernel(mode)?))
    }
}

/// The way in which the gate's kernel decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    Off,
    SkipPeriod {
        period: u32,
    },
    Uniform,
    Random,
    Bounded {
        /// The index of the table's first row of parents.
        first_above: u32,
    },
}

impl Mode {
    /// The value of the kernel's override constant `MODE`.
    pub fn constant(self) -> u32 {
        match self {
            Self::Off => modes::OFF,
            Self::SkipPeriod { .. } => modes::SKIP_PERIOD,
            Self::Uniform => modes::UNIFORM,
            Self::Random => modes::RANDOM,
            Self::Bounded { .. } => modes::BOUNDED,
        }
    }

    fn is_bounded(self) -> bool {
        matches!(self, Self::Bounded { .. })
    }
}

/// The gate's table on the device.
#[derive(Debug, Clone)]
pub(crate) struct UploadedGate {
    pub mode: Mode,
    pub table: TableBuffers,
}

/// The time of the frame that is submitted next.
#[derive(Debug, Clone)]
pub(crate) struct GateTime {
    params: GateParams,
    uniform: Uniform<GateParams>,
    /// For each slot of each instance, the error budget that its bone leaves, if bones below need it in the
    /// same frame.
    remaining: Buffer<u32>,
}

impl GateTime {
    pub fn new(
        gpu: &Gpu,
        gate: &UploadedGate,
        crowd: &Crowd,
        state: &GateState,
        active: &Active,
    ) -> Result<Self, Error> {
        let UploadedGate { mode, table } = gate;
        table.check(crowd)?;
        active.pairs.check_crowd(crowd)?;
        let params = GateParams {
            instances: state.lods.len() as u32,
            bones: crowd.bones as u32,
            words: table.words,
            stride: table.stride,
            first_above: if let Mode::Bounded { first_above } = mode { *first_above } else { 0 },
            ticks: 0,
            frame_ticks: 0,
            period: if let Mode::SkipPeriod { period } = mode { *period } else { 0 },
            frame: 0,
        };
        let remaining = Buffer::new(gpu, "remaining", if mode.is_bounded() { crowd.pairs() } else { 0 })?;
        let uniform = Uniform::new(gpu, "gate", &params)?;
        if mode.is_bounded() {
            crowd.model_matrices.consumer().claim(Consumer::BoundedGate)?;
        }
        Ok(Self { params, uniform, remaining })
    }

    /// Number of threads: one per word of bits, or one per instance if words depend on each other.
    fn threads(&self, mode: Mode) -> u32 {
        self.params.instances * if mode.is_bounded() { 1 } else { self.params.words }
    }

    /// Sets the frame, as [`GateJob::set`] does.
    pub fn set(&self, upload: &mut impl Upload, frame: &Frame) -> Result<(), GpuError> {
        let Frame { ticks, frame_ticks, frame, ahead: _ } = *frame;
        upload.uniform(&self.uniform, &GateParams { ticks, frame_ticks, frame, ..self.params })
    }
}

/// A prepared decision: set the frame, then record.
#[derive(Debug, Clone)]
pub struct GateJob {
    work: Work,
}

#[derive(Debug, Clone)]
enum Work {
    Gate { time: GateTime, job: Job },
    Budget(BudgetJob),
}

impl GateJob {
    /// Sets the frame of the next submission. A budget ignores it.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn set(&self, gpu: &Gpu, frame: &Frame) -> Result<(), GpuError> {
        self.set_through(&mut &*gpu, frame)
    }

    /// As [`GateJob::set`], written by `upload`.
    ///
    /// # Errors
    /// As [`GateJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, frame: &Frame) -> Result<(), GpuError> {
        match &self.work {
            Work::Gate { time, .. } => time.set(upload, frame),
            Work::Budget(_) => Ok(()),
        }
    }

    /// Sets the number of bones that may be sampled from the next submission on.
    ///
    /// # Errors
    /// [`InputError`] unless the gate is [`Gate::Budget`]; [`GpuError`] for errors of the device.
    pub fn set_budget(&self, gpu: &Gpu, bones: u32) -> Result<(), Error> {
        match &self.work {
            Work::Gate { .. } => Err(no_budget(bones).into()),
            Work::Budget(job) => Ok(job.set(gpu, bones)?),
        }
    }

    /// Records the decision.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        match &self.work {
            Work::Gate { job, .. } => job.record(encoder),
            Work::Budget(job) => job.record(encoder),
        }
    }

    /// Adds the decision to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        match &self.work {
            Work::Gate { job, .. } => job.dispatch(pass),
            Work::Budget(job) => job.dispatch(pass),
        }
    }
}

/// The error of setting a budget for another gate than [`Gate::Budget`].
pub(crate) fn no_budget(bones: u32) -> InputError {
    InputError::new("budget", bones, "must be of a crowd that is under one, not another gate")
}
