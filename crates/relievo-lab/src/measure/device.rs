//! Plays a crowd on the device.

use relievo::Error;
use relievo::animation::crowd::{ClipBuffers, Crowd};
use relievo::animation::frame::GatedFrame;
use relievo::animation::keyframe_cursor::{KeyframeCursorJob, KeyframeCursorPass};
use relievo::animation::local_to_model::{LocalToModelJob, LocalToModelPass};
use relievo::animation::sample::SamplePass;
use relievo::animation::{Gate, Lod};
use relievo::asset::Affine;
use relievo::gpu::{Gpu, Job, compute_pass};

use crate::harness::{TimedBy, Timer};
use crate::measure::gates::{PATH, frame};
use crate::measure::play::{FrameTimes, Play, Played, Times, Timing};
use crate::measure::stage::Stage;

/// The crowd under a gate, and the same crowd in full.
pub(crate) struct Device {
    gpu: Gpu,
    timer: Timer,
    rate: f64,
    pub(crate) gated: Gated,
    pub(crate) full: Full,
    stale: Vec<Affine>,
    fresh: Vec<Affine>,
}

/// The crowd under a gate.
pub(crate) struct Gated {
    pub(crate) crowd: Crowd,
    pub(crate) frame: GatedFrame,
}

/// The crowd in full: every bone of every instance is sampled and concatenated.
pub(crate) struct Full {
    pub(crate) crowd: Crowd,
    cursors: KeyframeCursorJob,
    sample: Job,
    local_to_model: LocalToModelJob,
}

impl Device {
    pub(crate) fn new(gpu: &Gpu, stage: &Stage<'_>, gate: &Gate, lods: &[Lod]) -> Result<Self, Error> {
        let clips = ClipBuffers::new(gpu, &stage.set)?;
        Ok(Self {
            gpu: gpu.clone(),
            timer: Timer::new(gpu)?,
            rate: stage.options.rate,
            gated: Gated::new(gpu, stage, &clips, gate, lods)?,
            full: Full::new(gpu, stage, &clips)?,
            stale: Vec::new(),
            fresh: Vec::new(),
        })
    }

    /// The clock that takes the times.
    pub(crate) fn timed_by(gpu: &Gpu) -> Result<TimedBy, Error> {
        Ok(Timer::new(gpu)?.timed_by())
    }

    /// Sets the frame that is recorded next.
    pub(crate) fn set(&self, number: u32) -> Result<(), Error> {
        let (frame, elapsed) = frame(number, self.rate);
        self.gated.frame.set(&self.gpu, &frame, elapsed)?;
        self.full.cursors.set(&self.gpu, elapsed)
    }

    fn timed(&self, dispatch: impl FnOnce(&mut wgpu::ComputePass<'_>)) -> Result<f64, Error> {
        let record = |encoder: &mut _| dispatch(&mut compute_pass(encoder, "timed"));
        Ok(self.timer.measure(&self.gpu, record)?.nanoseconds)
    }

    /// Plays a frame of both crowds and times each as a whole.
    fn play_whole(&self) -> Result<Times, Error> {
        let Self { gated, full, .. } = self;
        let frame = &gated.frame;
        Ok(Times {
            gated: FrameTimes::of_whole(self.timed(|pass| frame.dispatch(pass))?),
            full: FrameTimes::of_whole(self.timed(|pass| full.dispatch(pass))?),
        })
    }

    /// Plays a frame of both crowds and times each stage.
    fn play_stages(&self) -> Result<Times, Error> {
        let Self { gated, full, .. } = self;
        let frame = &gated.frame;
        let stages = |gate, sample, local_to_model| FrameTimes { gate, sample, local_to_model, whole: None };
        Ok(Times {
            gated: stages(
                Some(self.timed(|pass| frame.dispatch_gate(pass))?),
                Some(self.timed(|pass| frame.dispatch_sample(pass))?),
                Some(self.timed(|pass| frame.dispatch_local_to_model(pass))?),
            ),
            full: stages(
                None,
                Some(self.timed(|pass| full.dispatch_sample(pass))?),
                Some(self.timed(|pass| full.local_to_model.dispatch(pass))?),
            ),
        })
    }
}

impl Play for Device {
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error> {
        self.set(number)?;
        let times = match timing {
            Timing::Whole => Some(self.play_whole()?),
            Timing::Stages => Some(self.play_stages()?),
            Timing::None => {
                self.gpu.run("frame", |encoder| {
                    self.gated.frame.record(encoder);
                    self.full.record(encoder);
                })?;
                None
            }
        };
        let active = &self.gated.frame.active;
        self.stale = self.gated.crowd.model_matrices().read_blocking(&self.gpu)?;
        self.fresh = self.full.crowd.model_matrices().read_blocking(&self.gpu)?;
        let bits = active.bits.read_blocking(&self.gpu)?;
        let updated_bones = &bits[active.updated_words()];
        Ok(Played {
            interpolated: active.pairs.dispatched.read_blocking(&self.gpu)?[3] as usize,
            concatenated: updated_bones.iter().map(|word| word.count_ones() as usize).sum(),
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
        gate: &Gate,
        lods: &[Lod],
    ) -> Result<Self, Error> {
        let skeleton = &stage.subject.model.skeleton;
        let crowd = Crowd::new(gpu, &stage.set, &stage.instances)?.with_path(PATH);
        let frame = GatedFrame::new(gpu, skeleton, clips, &crowd, gate)?;
        frame.state.write_lods(gpu, lods)?;
        Ok(Self { crowd, frame })
    }
}

impl Full {
    fn new(gpu: &Gpu, stage: &Stage<'_>, clips: &ClipBuffers) -> Result<Self, Error> {
        let crowd = Crowd::new(gpu, &stage.set, &stage.instances)?.with_path(PATH);
        Ok(Self {
            cursors: KeyframeCursorPass::new(gpu)?.prepare(gpu, clips, &crowd)?,
            sample: SamplePass::new(gpu, PATH)?.prepare(gpu, clips, &crowd)?,
            local_to_model: LocalToModelPass::new(gpu)?.prepare(
                gpu,
                &stage.subject.model.skeleton,
                &crowd,
            )?,
            crowd,
        })
    }

    fn dispatch_sample(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.cursors.dispatch(pass);
        self.sample.dispatch(pass);
    }

    fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.dispatch_sample(pass);
        self.local_to_model.dispatch(pass);
    }

    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "full"));
    }
}
