//! The GPU pass of `kernels/animation/decide.wgsl`, and of the separate kernels that it replaces.

use super::Choice;
use crate::animation::active::Active;
use crate::animation::budget::{BudgetJob, BudgetPass};
use crate::animation::clip_clock::pass::{self as clip_clock, ClipClockTime};
use crate::animation::clip_clock::{ClipClockJob, ClipClockPass};
use crate::animation::compact::pass as compact;
use crate::animation::compact::{CompactJob, CompactPass, Stages};
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::gate::pass::{self as gate, GateTime};
use crate::animation::gate::{Frame, Gate, GateJob, GatePass};
use crate::animation::gate_state::GateState;
use crate::gpu::bindings::animation as bindings;
use crate::gpu::shaders::{self, BindingKind};
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, compute_pass};
use crate::shared::animation::compact::CompactParams;
use crate::{Error, InputError};

/// How many dispatches divide the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dispatches {
    /// One workgroup does all of it.
    One,
    /// At least one dispatch for each step.
    Each,
}

impl Dispatches {
    /// The faster choice for a crowd on this device.
    pub fn of(gpu: &Gpu, choice: Choice, active: &Active) -> Self {
        let is_gate = matches!(choice, Choice::Gate(_));
        let is_small = Stages::of(gpu, active) == Stages::One;
        if is_gate && is_small && needed() <= available(gpu) { Self::One } else { Self::Each }
    }
}

/// The number of storage buffers that the single dispatch needs.
fn needed() -> u32 {
    let is_storage = |kind| matches!(kind, BindingKind::StorageRead | BindingKind::StorageReadWrite);
    shaders::ANIMATION_DECIDE.bindings.iter().filter(|binding| is_storage(binding.kind)).count() as u32
}

/// The number of storage buffers that the device permits in a shader.
fn available(gpu: &Gpu) -> u32 {
    gpu.device().limits().max_storage_buffers_per_shader_stage
}

/// Decides which bones are sampled, and lists them.
#[derive(Debug, Clone)]
pub struct DecidePass {
    choice: Choice,
    kernels: Kernels,
}

#[derive(Debug, Clone)]
enum Kernels {
    One(Kernel, Gate),
    Each(Box<Steps>),
}

#[derive(Debug, Clone)]
struct Steps {
    clip_clock: ClipClockPass,
    decider: Decider,
    compact: CompactPass,
}

#[derive(Debug, Clone)]
enum Decider {
    Gate(GatePass),
    Budget(BudgetPass, u32),
}

impl DecidePass {
    /// Compiles the pipelines. A budget always takes one dispatch for each step.
    ///
    /// # Errors
    /// [`GpuError::Limit`] for a single dispatch on a device that does not permit enough buffers in a shader;
    /// errors of the driver's compiler.
    pub fn new(gpu: &Gpu, choice: Choice, dispatches: Dispatches) -> Result<Self, GpuError> {
        let steps = |decider| {
            let (clip_clock, compact) = (ClipClockPass::new(gpu)?, CompactPass::new(gpu)?);
            Ok::<_, GpuError>(Kernels::Each(Box::new(Steps { clip_clock, decider, compact })))
        };
        let kernels = match (choice, dispatches) {
            (Choice::Gate(gate), Dispatches::One) => Kernels::One(whole(gpu, gate)?, gate),
            (Choice::Gate(gate), Dispatches::Each) => steps(Decider::Gate(GatePass::new(gpu, gate)?))?,
            (Choice::Budget(most), _) => steps(Decider::Budget(BudgetPass::new(gpu)?, most))?,
        };
        Ok(Self { choice, kernels })
    }

    /// Prepares the decision for a crowd.
    ///
    /// # Errors
    /// [`InputError`] for a table of other clips or of a kind that the choice cannot use, and as
    /// [`GatePass::prepare`]; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        clips: &ClipBuffers,
        crowd: &Crowd,
        gate_state: &GateState,
        active: &Active,
    ) -> Result<DecideJob, Error> {
        let work = match &self.kernels {
            Kernels::One(kernel, gate) => one(kernel, *gate, gpu, clips, crowd, gate_state, active)?,
            Kernels::Each(steps) => Work::Each {
                clip_clock: steps.clip_clock.prepare(gpu, clips, crowd, gate_state)?,
                decision: steps.decider.prepare(gpu, crowd, gate_state, active)?,
                lists: steps.compact.prepare(gpu, crowd, active, Stages::of(gpu, active))?,
            },
        };
        Ok(DecideJob { choice: self.choice, work })
    }
}

/// The kernel that performs all steps.
fn whole(gpu: &Gpu, gate: Gate) -> Result<Kernel, GpuError> {
    let (needed, available) = (needed(), available(gpu));
    if needed > available {
        return Err(GpuError::Limit {
            pass: "animation/decide",
            limit: "maxStorageBuffersPerShaderStage",
            needed: needed.into(),
            available: available.into(),
            remedy: "take Dispatches::Each, as Dispatches::of would",
        });
    }
    bindings::decide::kernel(gpu, &bindings::decide::Constants { mode: gate::mode(gate) })
}

fn one(
    kernel: &Kernel,
    gate: Gate,
    gpu: &Gpu,
    clips: &ClipBuffers,
    crowd: &Crowd,
    gate_state: &GateState,
    active: &Active,
) -> Result<Work, Error> {
    let clip_clock = ClipClockTime::new(gpu, clips, crowd, gate_state)?;
    let gate = GateTime::new(gpu, gate, crowd, gate_state, active)?;
    let compact = Uniform::new(gpu, "compact", &CompactParams::new(gpu, crowd, active))?;
    let group = group(
        clip_clock::group(&clip_clock, clips, crowd, gate_state),
        gate::group(&gate, gate_state, active),
        compact::group(&compact, active),
    );
    let step = Step { groups: vec![group.bind(gpu, kernel)?], workgroups: [1; 3], kernel: kernel.clone() };
    Ok(Work::One { clip_clock, gate, job: Job::new(gpu, "animation/decide", vec![step])? })
}

/// The resources of all three kernels that `animation/decide` stands for.
fn group<'a>(
    clip_clock: bindings::clip_clock::Group<'a>,
    gate: bindings::gate::Group<'a>,
    compact: bindings::compact::Group<'a>,
) -> bindings::decide::Group<'a> {
    bindings::decide::Group {
        clip_clock_params: clip_clock.clip_clock_params,
        instances: clip_clock.instances,
        clips: clip_clock.clips,
        timelines: clip_clock.timelines,
        times: clip_clock.times,
        lods: clip_clock.lods,
        layer_weights: clip_clock.layer_weights,
        history: clip_clock.history,
        clip_clocks: clip_clock.clip_clocks,
        gate_params: gate.gate_params,
        animated_bones: gate.animated_bones,
        table: gate.table,
        sampled: gate.sampled,
        remaining: gate.remaining,
        bits: gate.bits,
        compact_params: compact.compact_params,
        slots: compact.slots,
        updated_bones: compact.updated_bones,
        counts: compact.counts,
        pairs: compact.pairs,
        pair_dispatch: compact.pair_dispatch,
        updated_instances: compact.updated_instances,
        instance_dispatches: compact.instance_dispatches,
    }
}

impl Decider {
    fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        gate_state: &GateState,
        active: &Active,
    ) -> Result<Decision, Error> {
        match self {
            Self::Gate(pass) => Ok(Decision::Gate(pass.prepare(gpu, crowd, gate_state, active)?)),
            Self::Budget(pass, most) => {
                let job = pass.prepare(gpu, crowd, gate_state, active)?;
                job.set(gpu, *most)?;
                Ok(Decision::Budget(job))
            }
        }
    }
}

/// A prepared decision: set time and frame, then record.
#[derive(Debug, Clone)]
pub struct DecideJob {
    choice: Choice,
    work: Work,
}

#[derive(Debug, Clone)]
enum Work {
    One { clip_clock: ClipClockTime, gate: GateTime, job: Job },
    Each { clip_clock: ClipClockJob, decision: Decision, lists: CompactJob },
}

#[derive(Debug, Clone)]
enum Decision {
    Gate(GateJob),
    Budget(BudgetJob),
}

impl DecideJob {
    /// Sets frame and time of the next submission, the time as
    /// [`super::super::keyframe_cursor::KeyframeCursorJob::set`] does.
    ///
    /// # Errors
    /// [`InputError`] for seconds that are not finite; [`GpuError`].
    pub fn set(&self, gpu: &Gpu, frame: &Frame, elapsed: f32) -> Result<(), Error> {
        let ahead = self.choice.ahead(frame);
        match &self.work {
            Work::One { clip_clock, gate, .. } => {
                clip_clock.set(gpu, elapsed, ahead)?;
                gate.set(gpu, frame)?;
            }
            Work::Each { clip_clock, decision, .. } => {
                clip_clock.set(gpu, elapsed, ahead)?;
                if let Decision::Gate(job) = decision {
                    job.set(gpu, frame)?;
                }
            }
        }
        Ok(())
    }

    /// Sets the number of bones that may be sampled from the next submission on.
    ///
    /// # Errors
    /// [`InputError`] if a gate decides; [`GpuError`].
    pub fn set_budget(&self, gpu: &Gpu, most: u32) -> Result<(), Error> {
        match &self.work {
            Work::Each { decision: Decision::Budget(job), .. } => Ok(job.set(gpu, most)?),
            _ => {
                Err(InputError::new("budget", most, "must be of a crowd that is under one, not a gate")
                    .into())
            }
        }
    }

    /// Records the decision.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "animation/decide"));
    }

    /// Adds the decision to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        match &self.work {
            Work::One { job, .. } => job.dispatch(pass),
            Work::Each { clip_clock, decision, lists } => {
                clip_clock.dispatch(pass);
                match decision {
                    Decision::Gate(job) => job.dispatch(pass),
                    Decision::Budget(job) => job.dispatch(pass),
                }
                lists.dispatch(pass);
            }
        }
    }
}
