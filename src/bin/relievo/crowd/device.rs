//! The crowd on the device.

use relievo::Error;
use relievo::animation::budget::{BudgetJob, BudgetPass};
use relievo::animation::compact::{self, Active, CompactJob, CompactPass};
use relievo::animation::concat::{ConcatActiveJob, ConcatJob, ConcatPass, Walk};
use relievo::animation::crowd::{ClipBuffers, Crowd};
use relievo::animation::gate::{GateJob, GatePass, Gating};
use relievo::animation::phase::{PhaseJob, PhasePass};
use relievo::animation::place::{PlaceJob, PlacePass};
use relievo::animation::sample::{SampleActiveJob, SamplePass};
use relievo::animation::{Affine, Frame, GateTable, Lod};
use relievo::gpu::{Gpu, Job, TimedBy, Timer};
use relievo::reference::animation::crowd::Choice;

use super::gates::{PATH, frame};
use super::play::{Play, Played, Stages, Times};
use super::stage::Stage;

/// Both crowds.
pub struct Device {
    gpu: Gpu,
    timer: Timer,
    rate: f64,
    pub(super) gated: Gated,
    pub(super) full: Full,
    stale: Vec<Affine>,
    fresh: Vec<Affine>,
}

/// The crowd under a gate.
pub(super) struct Gated {
    pub(super) crowd: Crowd,
    pub(super) active: Active,
    place: PlaceJob,
    phase: PhaseJob,
    decide: Decide,
    compact: CompactJob,
    sample: SampleActiveJob,
    concat: ConcatActiveJob,
}

enum Decide {
    Gate(GateJob),
    Budget(BudgetJob),
}

impl Decide {
    fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        match self {
            Self::Gate(job) => job.record(encoder),
            Self::Budget(job) => job.record(encoder),
        }
    }
}

/// Everything of everybody.
pub(super) struct Full {
    pub(super) crowd: Crowd,
    place: PlaceJob,
    sample: Job,
    concat: ConcatJob,
}

impl Device {
    pub fn new(
        gpu: &Gpu,
        stage: &Stage<'_>,
        table: &GateTable,
        choice: Choice,
        lods: &[Lod],
    ) -> Result<Self, Error> {
        let clips = ClipBuffers::new(gpu, &stage.set)?;
        Ok(Self {
            gpu: gpu.clone(),
            timer: Timer::new(gpu)?,
            rate: stage.plan.rate,
            gated: Gated::new(gpu, stage, &clips, table, choice, lods)?,
            full: Full::new(gpu, stage, &clips)?,
            stale: Vec::new(),
            fresh: Vec::new(),
        })
    }

    /// What clock takes the times.
    pub fn timed_by(gpu: &Gpu) -> Result<TimedBy, Error> {
        Ok(Timer::new(gpu)?.timed_by())
    }

    /// Chooses the frame that is recorded next.
    pub fn set(&self, number: u32) -> Result<(), Error> {
        let (frame, elapsed) = frame(number, self.rate);
        self.gated.set(&self.gpu, &frame, elapsed)?;
        self.full.place.set(&self.gpu, elapsed)
    }

    fn timed(&self, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> Result<f64, Error> {
        Ok(self.timer.measure(&self.gpu, record)?.nanoseconds)
    }

    /// Both crowds, stage by stage.
    fn play_timed(&self) -> Result<Times, Error> {
        let Self { gated, full, .. } = self;
        let gate = self.timed(|encoder| gated.record_gate(encoder))?;
        let sample = self.timed(|encoder| gated.record_sample(encoder))?;
        let concat = self.timed(|encoder| gated.concat.record(encoder))?;
        let full_sample = self.timed(|encoder| full.record_sample(encoder))?;
        let full_concat = self.timed(|encoder| full.concat.record(encoder))?;
        let stages = |gate: Option<f64>, sample, concat| Stages {
            gate,
            sample: Some(sample),
            concat: Some(concat),
            total: gate.unwrap_or(0.0) + sample + concat,
        };
        Ok(Times { gated: stages(Some(gate), sample, concat), full: stages(None, full_sample, full_concat) })
    }
}

impl Play for Device {
    fn play(&mut self, number: u32, is_timed: bool) -> Result<Played, Error> {
        self.set(number)?;
        let times = if is_timed {
            Some(self.play_timed()?)
        } else {
            self.gpu.run("frame", |encoder| {
                self.gated.record(encoder);
                self.full.record(encoder);
            })?;
            None
        };
        let active = &self.gated.active;
        self.stale = self.gated.crowd.models.read_blocking(&self.gpu)?;
        self.fresh = self.full.crowd.models.read_blocking(&self.gpu)?;
        let dirty = active.dirty.read_blocking(&self.gpu)?;
        Ok(Played {
            interpolated: active.pairs.dispatched.read_blocking(&self.gpu)?[3] as usize,
            concatenated: dirty.iter().map(|word| word.count_ones() as usize).sum(),
            times,
        })
    }

    fn stale(&self) -> &[Affine] {
        &self.stale
    }

    fn fresh(&self) -> &[Affine] {
        &self.fresh
    }
}

impl Gated {
    fn new(
        gpu: &Gpu,
        stage: &Stage<'_>,
        clips: &ClipBuffers,
        table: &GateTable,
        choice: Choice,
        lods: &[Lod],
    ) -> Result<Self, Error> {
        let skeleton = &stage.plan.model.skeleton;
        let crowd = Crowd::new(gpu, &stage.set, &stage.instances)?;
        let gating = Gating::new(gpu, table, &crowd)?;
        gating.lods.write(gpu, lods)?;
        let active = Active::new(gpu, &stage.order, &crowd)?;
        let decide = match choice {
            Choice::Gate(gate) => {
                Decide::Gate(GatePass::new(gpu, gate)?.prepare(gpu, &crowd, &gating, &active)?)
            }
            Choice::Budget(budget) => {
                let job = BudgetPass::new(gpu)?.prepare(gpu, &crowd, &gating, &active)?;
                job.set(gpu, budget)?;
                Decide::Budget(job)
            }
        };
        Ok(Self {
            place: PlacePass::new(gpu)?.prepare_active(gpu, clips, &crowd, &gating, &active)?,
            phase: PhasePass::new(gpu)?.prepare(gpu, clips, &crowd, &gating)?,
            decide,
            compact: CompactPass::new(gpu)?.prepare(
                gpu,
                &crowd,
                &active,
                compact::Stages::of(gpu, &active),
            )?,
            sample: SamplePass::new(gpu, PATH)?.prepare_active(gpu, clips, &crowd, &active.pairs)?,
            concat: ConcatPass::new(gpu, Walk::of(gpu))?.prepare_active(gpu, skeleton, &crowd, &active)?,
            crowd,
            active,
        })
    }

    fn set(&self, gpu: &Gpu, frame: &Frame, elapsed: f32) -> Result<(), Error> {
        self.place.set(gpu, elapsed)?;
        self.phase.set(gpu, elapsed)?;
        if let Decide::Gate(job) = &self.decide {
            job.set(gpu, frame)?;
        }
        Ok(())
    }

    fn record_gate(&self, encoder: &mut wgpu::CommandEncoder) {
        self.phase.record(encoder);
        self.decide.record(encoder);
        self.compact.record(encoder);
    }

    fn record_sample(&self, encoder: &mut wgpu::CommandEncoder) {
        self.place.record(encoder);
        self.sample.record(encoder);
    }

    pub(super) fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.record_gate(encoder);
        self.record_sample(encoder);
        self.concat.record(encoder);
    }
}

impl Full {
    fn new(gpu: &Gpu, stage: &Stage<'_>, clips: &ClipBuffers) -> Result<Self, Error> {
        let crowd = Crowd::new(gpu, &stage.set, &stage.instances)?;
        Ok(Self {
            place: PlacePass::new(gpu)?.prepare(gpu, clips, &crowd)?,
            sample: SamplePass::new(gpu, PATH)?.prepare(gpu, clips, &crowd)?,
            concat: ConcatPass::new(gpu, Walk::of(gpu))?.prepare(gpu, &stage.plan.model.skeleton, &crowd)?,
            crowd,
        })
    }

    fn record_sample(&self, encoder: &mut wgpu::CommandEncoder) {
        self.place.record(encoder);
        self.sample.record(encoder);
    }

    pub(super) fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.record_sample(encoder);
        self.concat.record(encoder);
    }
}
