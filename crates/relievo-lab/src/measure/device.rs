//! Plays a crowd on the device.

use relievo::Error;
use relievo::asset::Affine;
use relievo::gpu::{Gpu, Job, compute_pass};
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::frame::GatedFrame;
use relievo::ops::animation::keyframe_cursor::{KeyframeCursorJob, KeyframeCursorPass};
use relievo::ops::animation::local_to_model::LocalToModelPass;
use relievo::ops::animation::sample::SamplePass;
use relievo::ops::animation::{Gate, Lod};

use crate::harness::{TimedBy, Timer};
use crate::measure::gates::{PATH, frame};
use crate::measure::play::{FrameTimes, Play, Played, Timing, of_whole};
use crate::measure::stage::Stage;

/// The crowd under a gate, and the same crowd in full: there every bone of every instance is sampled and concatenated.
pub(crate) struct Device {
    gpu: Gpu,
    timer: Timer,
    rate: f64,
    gated: Crowd,
    frame: GatedFrame,
    full: Crowd,
    cursors: KeyframeCursorJob,
    sample: Job,
    local_to_model: Job,
    stale: Vec<Affine>,
    fresh: Vec<Affine>,
}

impl Device {
    pub(crate) fn new(gpu: &Gpu, stage: &Stage<'_>, gate: &Gate, lods: &[Lod]) -> Result<Self, Error> {
        let (clips, skeleton) = (ClipBuffers::new(gpu, &stage.set)?, &stage.subject.model.skeleton);
        let crowd = || Ok::<_, Error>(Crowd::new(gpu, &stage.set, &stage.instances)?.with_path(PATH));
        let [gated, full] = [crowd()?, crowd()?];
        let frame = GatedFrame::new(gpu, skeleton, &clips, &gated, gate)?;
        frame.state.write_lods(gpu, lods)?;
        Ok(Self {
            gpu: gpu.clone(),
            timer: Timer::new(gpu)?,
            rate: stage.options.rate,
            gated,
            frame,
            cursors: KeyframeCursorPass::new(gpu)?.prepare(gpu, &clips, &full)?,
            sample: SamplePass::new(gpu, PATH)?.prepare(gpu, &clips, &full)?,
            local_to_model: LocalToModelPass::new(gpu)?.prepare(gpu, skeleton, &full)?,
            full,
            stale: Vec::new(),
            fresh: Vec::new(),
        })
    }

    /// The clock that takes the times.
    pub(crate) fn timed_by(gpu: &Gpu) -> Result<TimedBy, Error> {
        Ok(Timer::new(gpu)?.timed_by())
    }

    fn timed(&self, dispatch: impl FnOnce(&mut wgpu::ComputePass<'_>)) -> Result<f64, Error> {
        let record = |encoder: &mut _| dispatch(&mut compute_pass(encoder, "timed"));
        Ok(self.timer.measure(&self.gpu, record)?.nanoseconds)
    }

    fn sample_full(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.cursors.dispatch(pass);
        self.sample.dispatch(pass);
    }

    fn play_full(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.sample_full(pass);
        self.local_to_model.dispatch(pass);
    }

    /// Plays a frame of both crowds and times each as a whole.
    fn play_whole(&self) -> Result<[FrameTimes; 2], Error> {
        let gated = self.timed(|pass| self.frame.dispatch(pass))?;
        let full = self.timed(|pass| self.play_full(pass))?;
        Ok([gated, full].map(of_whole))
    }

    /// Plays a frame of both crowds and times each stage.
    fn play_stages(&self) -> Result<[FrameTimes; 2], Error> {
        let frame = &self.frame;
        let gate = self.timed(|pass| frame.dispatch_gate(pass))?;
        let sample = self.timed(|pass| frame.dispatch_sample(pass))?;
        let local_to_model = self.timed(|pass| frame.dispatch_local_to_model(pass))?;
        let gated = [Some(gate), Some(sample), Some(local_to_model), None];
        let sample = self.timed(|pass| self.sample_full(pass))?;
        let local_to_model = self.timed(|pass| self.local_to_model.dispatch(pass))?;
        Ok([gated, [None, Some(sample), Some(local_to_model), None]])
    }
}

impl Play for Device {
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error> {
        let (frame, elapsed) = frame(number, self.rate);
        self.frame.set(&self.gpu, &frame, elapsed)?;
        self.cursors.set(&self.gpu, elapsed)?;
        let times = match timing {
            Timing::Whole => Some(self.play_whole()?),
            Timing::Stages => Some(self.play_stages()?),
            Timing::None => {
                self.gpu.run("frame", |encoder| {
                    self.frame.record(encoder);
                    self.play_full(&mut compute_pass(encoder, "full"));
                })?;
                None
            }
        };
        self.stale = self.gated.model_matrices().read_blocking(&self.gpu)?;
        self.fresh = self.full.model_matrices().read_blocking(&self.gpu)?;
        let active = &self.frame.active;
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
