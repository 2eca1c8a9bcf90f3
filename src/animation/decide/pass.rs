//! The GPU pass of `kernels/animation/decide.wgsl`, and of the separate kernels that it replaces.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::clip_clock::pass::{self as clip_clock, ClipClockTime};
use crate::animation::clip_clock::{ClipClockJob, ClipClockPass};
use crate::animation::compact::pass as compact;
use crate::animation::compact::{CompactJob, CompactPass, Stages};
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::gate::pass::{self as gate_pass, Decider, GateTime, Mode, UploadedGate, no_budget};
use crate::animation::gate::{Frame, Gate, GateJob, GatePass};
use crate::animation::gate_state::GateState;
use crate::animation::updated_bones::UpdatedBones;
use crate::gpu::bindings::animation as bindings;
use crate::gpu::shaders::{self, BindingKind};
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform, Upload, compute_pass};
use crate::shared::animation::compact::CompactParams;

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
    fn of(gpu: &Gpu, crowd: &Crowd) -> Self {
        let is_small = Stages::of(gpu, crowd) == Stages::One;
        if is_small && needed() <= available(gpu) { Self::One } else { Self::Each }
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
    /// Whether bones may be sampled ahead of their time.
    leads: bool,
    kernels: Kernels,
}

#[derive(Debug, Clone)]
enum Kernels {
    One(UploadedGate, Kernel),
    Each(Box<Steps>),
}

#[derive(Debug, Clone)]
struct Steps {
    clip_clock: ClipClockPass,
    gate: GatePass,
    compact: CompactPass,
}

impl DecidePass {
    /// Uploads a gate's table and compiles the pipelines that are fastest for a crowd of this size.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, gate: &Gate, crowd: &Crowd) -> Result<Self, GpuError> {
        Self::with_dispatches(gpu, gate, Dispatches::of(gpu, crowd))
    }

    /// The same with so many dispatches. A budget takes a dispatch for each step in any case.
    ///
    /// # Errors
    /// [`GpuError::Limit`] for a single dispatch on a device that does not permit enough buffers in a shader;
    /// errors of the driver's compiler.
    pub fn with_dispatches(gpu: &Gpu, gate: &Gate, dispatches: Dispatches) -> Result<Self, GpuError> {
        let leads = matches!(gate, Gate::Bounded(_));
        let kernels = match dispatches {
            Dispatches::One => match Decider::new(gpu, gate, |mode| whole(gpu, mode))? {
                Decider::Gate(gate, kernel) => Kernels::One(gate, kernel),
                Decider::Budget(pass) => Kernels::each(gpu, GatePass::of_budget(*pass))?,
            },
            Dispatches::Each => Kernels::each(gpu, GatePass::new(gpu, gate)?)?,
        };
        Ok(Self { leads, kernels })
    }

    /// Prepares the decision for a crowd.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for clips of another set than the crowd's, and as [`GatePass::prepare`];
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        clips: &ClipBuffers,
        crowd: &Crowd,
        state: &GateState,
        active: &Active,
    ) -> Result<DecideJob, Error> {
        let work = match &self.kernels {
            Kernels::One(gate, kernel) => one(gate, kernel, gpu, clips, crowd, state, active)?,
            Kernels::Each(steps) => Work::Each {
                clip_clock: steps.clip_clock.prepare(gpu, clips, crowd, state)?,
                gate: steps.gate.prepare(gpu, crowd, state, active)?,
                lists: steps.compact.prepare(gpu, crowd, active)?,
            },
        };
        Ok(DecideJob { leads: self.leads, work, updated: active.updated_bones.clone() })
    }
}

impl Kernels {
    fn each(gpu: &Gpu, gate: GatePass) -> Result<Self, GpuError> {
        let (clip_clock, compact) = (ClipClockPass::new(gpu)?, CompactPass::new(gpu)?);
        Ok(Self::Each(Box::new(Steps { clip_clock, gate, compact })))
    }
}

/// The kernel that performs all steps.
fn whole(gpu: &Gpu, mode: Mode) -> Result<Kernel, GpuError> {
    let constants = bindings::decide::Constants { mode: mode.constant() };
    bindings::decide::kernel(gpu, &constants)
        .map_err(|error| error.with_remedy("take several dispatches, as DecidePass::new does"))
}

fn one(
    gate: &UploadedGate,
    kernel: &Kernel,
    gpu: &Gpu,
    clips: &ClipBuffers,
    crowd: &Crowd,
    state: &GateState,
    active: &Active,
) -> Result<Work, Error> {
    let table = &gate.table;
    let clip_clock = ClipClockTime::new(gpu, clips, crowd, state)?;
    let gate = GateTime::new(gpu, gate, crowd, state, active)?;
    let compact = Uniform::new(gpu, "compact", &CompactParams::new(gpu, crowd, active))?;
    let group = group(
        clip_clock::group(&clip_clock, clips, crowd, state),
        gate_pass::group(&gate, table, state, active),
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

/// A prepared decision: set time and frame, then record.
#[derive(Debug, Clone)]
pub struct DecideJob {
    leads: bool,
    work: Work,
    updated: UpdatedBones,
}

#[derive(Debug, Clone)]
enum Work {
    One { clip_clock: ClipClockTime, gate: GateTime, job: Job },
    Each { clip_clock: ClipClockJob, gate: GateJob, lists: CompactJob },
}

impl DecideJob {
    /// Sets frame and time of the next submission, the time as
    /// [`super::super::keyframe_cursor::KeyframeCursorJob::set`] does.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for seconds that are not finite; [`GpuError`].
    pub fn set(&self, gpu: &Gpu, frame: &Frame, elapsed: f32) -> Result<(), Error> {
        self.set_through(&mut &*gpu, frame, elapsed)
    }

    /// As [`DecideJob::set`], written by `upload`.
    ///
    /// # Errors
    /// As [`DecideJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, frame: &Frame, elapsed: f32) -> Result<(), Error> {
        let ahead = if self.leads { frame.ahead } else { 0.0 };
        match &self.work {
            Work::One { clip_clock, gate, .. } => {
                clip_clock.set(upload, elapsed, ahead)?;
                gate.set(upload, frame)?;
            }
            Work::Each { clip_clock, gate, .. } => {
                clip_clock.set_through(upload, elapsed, ahead)?;
                gate.set_through(upload, frame)?;
            }
        }
        Ok(())
    }

    /// Sets the number of bones that may be sampled from the next submission on.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) unless the gate is [`Gate::Budget`]; [`GpuError`].
    pub fn set_budget(&self, gpu: &Gpu, bones: u32) -> Result<(), Error> {
        match &self.work {
            Work::One { .. } => Err(no_budget(bones).into()),
            Work::Each { gate, .. } => gate.set_budget(gpu, bones),
        }
    }

    /// Records the decision.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "animation/decide"));
    }

    /// Adds the decision to a compute pass that is being recorded, and tells the readers of
    /// [`Active::updated_bones`].
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.updated.update();
        match &self.work {
            Work::One { job, .. } => job.dispatch(pass),
            Work::Each { clip_clock, gate, lists } => {
                clip_clock.dispatch(pass);
                gate.dispatch(pass);
                lists.dispatch(pass);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::clip_set::ClipSet;
    use crate::animation::gate_table::{AnimatedBones, ExpectationTable};
    use crate::animation::instance::{Instance, Wrap};
    use crate::animation::order::Order;
    use crate::asset::keyframe::RotationPath;
    use crate::gpu::Options;

    /// One dispatch is chosen for small crowds on processors alone, and never for a budget.
    #[test]
    fn small_crowds_on_processors_are_decided_in_one_dispatch() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let model = crate::samples::creature().expect("valid");
        let clips = [&model.clips[0]];
        let set = ClipSet::new(&clips).expect("one skeleton");
        let (skeleton, bone_radii) = (&model.skeleton, vec![0.1; model.skeleton.len()]);
        let bones = AnimatedBones::new(&Order::new(skeleton), &set, &clips).expect("fits");
        let table = ExpectationTable::new(skeleton, &set, &clips, &bone_radii, RotationPath::Slerp);
        let (gate, budget) = (Gate::Off(bones), Gate::Budget { table: table.expect("fits"), bones: 5 });
        let has_room = available(&gpu) >= needed();
        for (instances, is_few) in [(100, true), (1000, false)] {
            let plays = vec![Instance::new(0, Wrap::Loop, 0.0, 1.0); instances];
            let crowd = Crowd::new(&gpu, &set, &plays).expect("fits");
            let is_small = is_few && gpu.adapter().is_software();
            assert_eq!(Stages::of(&gpu, &crowd) == Stages::One, is_small);
            for (gate, is_budget) in [(&gate, false), (&budget, true)] {
                let pass = DecidePass::new(&gpu, gate, &crowd).expect("compiled");
                let is_one = matches!(pass.kernels, Kernels::One(..));
                assert_eq!(is_one, is_small && has_room && !is_budget, "{instances}, {}", gate.name());
            }
        }
        // A budget has no kernel of all steps.
        let one = DecidePass::with_dispatches(&gpu, &budget, Dispatches::One).expect("in several");
        assert!(matches!(one.kernels, Kernels::Each(_)));
    }
    /// A device that another program opened, with WebGPU's default limits, is not asked for more.
    #[test]
    fn one_dispatch_needs_a_device_that_allows_it() {
        let own = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
        let is_own = |adapter: &wgpu::Adapter| adapter.get_info().name == own.adapter().name;
        let adapter = all.into_iter().find(is_own).expect("the suite's");
        let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()));
        let (device, queue) = opened.expect("a device");
        let foreign = Gpu::from_wgpu(device, queue);
        let model = crate::samples::creature().expect("valid");
        let clips = [&model.clips[0]];
        let set = ClipSet::new(&clips).expect("one skeleton");
        let bones = AnimatedBones::new(&Order::new(&model.skeleton), &set, &clips).expect("fits");
        let gate = Gate::Off(bones);
        let refused = DecidePass::with_dispatches(&foreign, &gate, Dispatches::One).expect_err("too many");
        assert!(matches!(refused, GpuError::Limit { available: 8, .. }), "{refused}");
    }
}
