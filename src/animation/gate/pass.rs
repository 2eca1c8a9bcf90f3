//! `kernels/animation/gate.wgsl`.

use super::{Frame, Gate};
use crate::animation::compact::Active;
use crate::animation::crowd::Crowd;
use crate::animation::gate_table::{GateTable, Kind, check_path};
use crate::animation::lod::Lod;
use crate::animation::phase::Phase;
use crate::gpu::bindings::animation::gate as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::animation::gate as modes;
use crate::shared::animation::gate::GateParams;
use crate::animation::sample::RotationPath;
use crate::{Error, InputError};

/// What gates know of a crowd. All buffers may be read and bound by the caller.
#[derive(Debug, Clone)]
pub struct Gating {
    /// One an instance; written by the host, full detail at first.
    pub lods: Buffer<Lod>,
    /// Written by [`crate::animation::phase::PhasePass`].
    pub phases: Buffer<Phase>,
    /// Each instance's last clip + 1, with the highest bit where layers lay above it; a number of what these played; as
    /// bits, its last time inside the clip, and that ahead. Zeros: no pose is stored.
    pub history: Buffer<[u32; 4]>,
    /// For each slot of each instance, the sum of motion when it was sampled last.
    pub sampled: Buffer<u32>,
    /// For each slot of each instance, what it leaves of the allowed way, where that is needed later.
    pub(crate) kept: Buffer<u32>,
    /// The table of movers.
    pub(crate) movers: Buffer<u32>,
    /// The table's rows.
    pub(crate) table: Buffer<[u32; 2]>,
    pub(crate) words: u32,
    pub(crate) stride: u32,
    pub(crate) first_above: u32,
    pub(crate) kind: Kind,
    path: Option<RotationPath>,
}

impl Gating {
    /// Uploads a table and makes room for a crowd.
    ///
    /// # Errors
    /// [`InputError`] for a table of another number of bones; [`GpuError`].
    pub fn new(gpu: &Gpu, table: &GateTable, crowd: &Crowd) -> Result<Self, Error> {
        if table.bones() != crowd.bones {
            let bound = format!("must be {}, as the crowd's", crowd.bones);
            return Err(InputError::new("table.bones", table.bones(), bound).into());
        }
        let instances = crowd.len();
        Ok(Self {
            lods: Buffer::from_slice(gpu, "lods", &vec![Lod::FULL; instances])?,
            phases: Buffer::new(gpu, "phases", instances)?,
            history: Buffer::new(gpu, "history", instances)?,
            sampled: Buffer::new(gpu, "sampled", crowd.pairs())?,
            kept: Buffer::new(gpu, "kept", if table.kind() == Kind::Bounds { crowd.pairs() } else { 0 })?,
            movers: Buffer::from_slice(gpu, "movers", table.movers())?,
            table: Buffer::from_slice(gpu, "gate table", table.rows())?,
            words: table.words() as u32,
            stride: table.stride() as u32,
            first_above: table.above(0),
            kind: table.kind(),
            path: table.path(),
        })
    }

    /// Refuses a table of another kind than the gate needs, where it needs one, and another path than the crowd's.
    pub(crate) fn check(&self, needed: Option<Kind>, crowd: &Crowd) -> Result<(), InputError> {
        needed.map_or(Ok(()), |needed| self.kind.check(needed))?;
        check_path(self.path, crowd.path())
    }
}

/// Decides which bones are sampled.
#[derive(Debug, Clone)]
pub struct GatePass {
    kernel: Kernel,
    gate: Gate,
}

impl GatePass {
    /// Compiles the pipeline of a mode.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, gate: Gate) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu, &bindings::Constants { mode: mode(gate) })?, gate })
    }

    /// Prepares the decision, from a crowd's phases.
    ///
    /// # Errors
    /// [`InputError`] for a table of another kind than the gate needs, or of motion along another path than the crowd's
    /// rotations take; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        gating: &Gating,
        active: &Active,
    ) -> Result<GateJob, Error> {
        let time = GateTime::new(gpu, self.gate, crowd, gating)?;
        let group = bindings::Group {
            lods: gating.lods.slice(),
            phases: gating.phases.slice(),
            gate_params: &time.uniform,
            movers: gating.movers.slice(),
            table: gating.table.slice(),
            sampled: gating.sampled.slice(),
            kept: gating.kept.slice(),
            bits: active.bits.slice(),
        };
        let step = Step {
            groups: vec![group.bind(gpu, &self.kernel)?],
            workgroups: self.kernel.spread(gpu, time.threads(self.gate)),
            kernel: self.kernel.clone(),
        };
        Ok(GateJob { time, job: Job::new(gpu, "animation/gate", vec![step])? })
    }
}

/// `MODE` of the kernel.
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
    pub(crate) uniform: Uniform<GateParams>,
}

impl GateTime {
    pub fn new(gpu: &Gpu, gate: Gate, crowd: &Crowd, gating: &Gating) -> Result<Self, Error> {
        let needed = match gate {
            Gate::SkipPeriod { .. } => Some(Kind::Priorities),
            Gate::Bounded => Some(Kind::Bounds),
            Gate::Off | Gate::Uniform | Gate::Random => None,
        };
        gating.check(needed, crowd)?;
        let params = GateParams {
            instances: gating.lods.len() as u32,
            bones: crowd.bones as u32,
            words: gating.words,
            stride: gating.stride,
            first_above: gating.first_above,
            ticks: 0,
            frame_ticks: 0,
            period: if let Gate::SkipPeriod { period } = gate { period } else { 0 },
            frame: 0,
        };
        Ok(Self { params, uniform: Uniform::new(gpu, "gate", &params)? })
    }

    /// One a word of bits, or an instance where words wait for each other.
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
    /// Chooses the frame of the next submission.
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
