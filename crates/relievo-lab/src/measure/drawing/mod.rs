//! Draws a crowd by scenes that differ in nothing but their level of detail ("looks"), and measures what the frames of each
//! cost and how far what is drawn lies from its place.

pub use cost::FrameCost;
use glam::Vec3;
use image::RgbaImage;
use look::Look;
pub(crate) use parts::Parts;
use relievo::gpu::Gpu;
use relievo::render::{Offscreen, Renderer};
use relievo::scene::Camera;
use relievo::{Error, InputError};
pub(crate) use subject::DrawnModel;

use crate::harness::{TimedBy, Timer};
use crate::measure::options::{CrowdOptions, FIELD_OF_VIEW, PICTURE, SKY};
use crate::measure::placement::Placements;
use crate::measure::stage::Stage;

mod cost;
mod look;
mod parts;
mod subject;

/// Largest number of frames of a run that are timed.
const TIMED: u32 = 40;

/// Number of pairs of successive frames that are measured in a long run.
const PAIRS: u32 = 2;

/// The smallest number of frames: one that is timed as a whole, one in its parts, and a pair that is measured.
const LEAST_FRAMES: u32 = 4;

/// What a frame is played for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Aim {
    /// To let drivers compile, in the first frame.
    First,
    /// Only to come to the next, by looks whose frames depend on those before.
    Nothing,
    /// The time of all that is recorded, with the drawing.
    Whole,
    /// The times of what precedes the drawing, and of the drawing.
    Parts,
    /// Counts and displacements, in a frame that begins a pair of such frames or ends it.
    Measures { begins: bool },
}

impl Aim {
    /// The aim of frame `number` of `frames`. The first is not counted among these.
    fn of(number: u32, frames: u32) -> Self {
        let block = (frames / PAIRS).max(LEAST_FRAMES);
        let every = frames.div_ceil(TIMED);
        let Some(at) = number.checked_sub(1).map(|number| number % block) else { return Self::First };
        // A block that does not come to its end has no pair.
        let is_whole = number - 1 - at + block <= frames;
        match at {
            _ if is_whole && at + 2 >= block => Self::Measures { begins: at + 2 == block },
            _ if !at.is_multiple_of(every) => Self::Nothing,
            _ if (at / every).is_multiple_of(2) => Self::Whole,
            _ => Self::Parts,
        }
    }
}

/// Refuses a number of frames that is too small to take each time and each measurement once.
pub(crate) fn check_frames(options: &CrowdOptions) -> Result<(), InputError> {
    if options.frames >= LEAST_FRAMES {
        return Ok(());
    }
    let bound = format!("must be at least {LEAST_FRAMES}, as the crowd is drawn");
    Err(InputError::new("frames", options.frames, bound))
}

/// Looks at one crowd.
pub(crate) struct Drawing<'a> {
    gpu: &'a Gpu,
    options: &'a CrowdOptions,
    drawn: &'a DrawnModel,
    timer: Timer,
    target: Offscreen,
    renderer: Renderer,
    looks: Vec<Look>,
}

impl<'a> Drawing<'a> {
    /// Makes a look for each of `parts`.
    pub(crate) fn new(
        gpu: &'a Gpu,
        stage: &'a Stage<'a>,
        drawn: &'a DrawnModel,
        placements: &Placements,
        parts: &[Parts],
    ) -> Result<Self, Error> {
        let target = Offscreen::new(gpu, PICTURE)?;
        let mut renderer = Renderer::new(gpu, target.format())?;
        let (places, camera) = (placements.in_scene(), camera(stage, placements));
        let look = |parts: &Parts| Look::new(gpu, stage, drawn, &places, camera, parts);
        let looks = parts.iter().map(look).collect::<Result<Vec<_>, Error>>()?;
        looks.iter().try_for_each(|look| renderer.prepare(&look.scene))?;
        let timer = Timer::for_drawing(gpu)?;
        Ok(Self { gpu, options: stage.options, drawn, timer, target, renderer, looks })
    }

    /// Plays all frames, and returns the cost of each look; those before `measured` are timed alone. Calls `step` after each
    /// frame.
    pub(crate) fn run(&mut self, measured: usize, step: impl Fn()) -> Result<Vec<FrameCost>, Error> {
        let CrowdOptions { frames, rate, .. } = *self.options;
        let seconds = rate.recip() as f32;
        for number in 0..=frames {
            let aim = Aim::of(number, frames);
            // Looks take turns, and each begins as often as any other.
            for turn in 0..self.looks.len() {
                let look = (number as usize + turn) % self.looks.len();
                self.looks[look].scene.advance(if number > 0 { seconds } else { 0.0 })?;
                let is_left = look < measured && matches!(aim, Aim::Measures { .. });
                self.play(look, if is_left { Aim::Nothing } else { aim })?;
            }
            step();
        }
        let instances = self.options.instances;
        Ok(self.looks.iter().map(|look| look.cost(self.drawn, instances)).collect())
    }

    /// The clock that takes the times.
    pub(crate) fn timed_by(gpu: &Gpu) -> Result<TimedBy, Error> {
        Ok(Timer::for_drawing(gpu)?.timed_by())
    }

    /// Draws the last frame of a look.
    pub(crate) fn picture(&self, look: usize) -> Result<RgbaImage, Error> {
        let (target, renderer, look) = (&self.target, &self.renderer, &self.looks[look]);
        self.gpu.try_run("frame", |encoder| draw(target, renderer, look, encoder))?;
        target.read(self.gpu)
    }

    /// Plays a frame of a look.
    fn play(&mut self, look: usize, aim: Aim) -> Result<(), Error> {
        let Self { gpu, timer, target, renderer, looks, .. } = self;
        let look = &mut looks[look];
        match aim {
            Aim::First => gpu.try_run("frame", |encoder| {
                look.compute(encoder)?;
                draw(target, renderer, look, encoder)
            }),
            Aim::Nothing if !look.is_gated => Ok(()),
            Aim::Nothing => gpu.try_run("frame", |encoder| look.compute(encoder)),
            Aim::Whole => {
                let frame = timed(gpu, timer, |encoder| {
                    look.compute(encoder)?;
                    draw(target, renderer, look, encoder)
                })?;
                look.times.frame.push(frame);
                Ok(())
            }
            Aim::Parts => {
                let compute = timed(gpu, timer, |encoder| look.compute(encoder))?;
                let draw = timed(gpu, timer, |encoder| draw(target, renderer, look, encoder))?;
                look.times.compute.push(compute);
                look.times.draw.push(draw);
                Ok(())
            }
            Aim::Measures { begins } => {
                look.scene.set_statistics(true)?;
                gpu.try_run("frame", |encoder| look.compute(encoder))?;
                look.measure(begins)?;
                look.scene.set_statistics(false)
            }
        }
    }
}

/// Records the drawing of a look.
fn draw(
    target: &Offscreen,
    renderer: &Renderer,
    look: &Look,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), Error> {
    Ok(target.record(encoder, SKY, |pass| look.draw(renderer, pass))?)
}

/// Records, submits and waits, and returns how many nanoseconds it took.
fn timed(
    gpu: &Gpu,
    timer: &Timer,
    record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<(), Error>,
) -> Result<f64, Error> {
    let mut recorded = Ok(());
    let time = timer.measure(gpu, |encoder| recorded = record(encoder))?;
    recorded?;
    Ok(time.nanoseconds)
}

/// The camera of a crowd, at the origin: it looks along −Z and sees all of it.
fn camera(stage: &Stage<'_>, placements: &Placements) -> Camera {
    let deepest = placements.origins.iter().map(|origin| origin[2]).fold(0.0, f32::max);
    let far = 2.0 * deepest + 4.0 * stage.options.size * stage.metres_a_unit;
    Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, FIELD_OF_VIEW, [stage.projection.near, far], PICTURE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_aim_comes_about() {
        for frames in [4, 5, 11, 60, 240, 1000] {
            let aims: Vec<Aim> = (0..=frames).map(|number| Aim::of(number, frames)).collect();
            let count = |aim: Aim| aims.iter().filter(|other| **other == aim).count();
            let timed = count(Aim::Whole) + count(Aim::Parts);
            assert!((2..=TIMED as usize + 2).contains(&timed), "{frames}: {timed}");
            assert!(count(Aim::Whole).abs_diff(count(Aim::Parts)) <= PAIRS as usize + 1, "{frames}");
            assert!(count(Aim::Parts) > 0 && aims[0] == Aim::First, "{frames}");
            let pair = [true, false].map(|begins| Aim::Measures { begins });
            let pairs = aims.windows(2).filter(|two| **two == pair).count();
            assert!(pairs > 0 && pair.map(count) == [pairs; 2], "{frames}: {pairs}");
        }
    }
}
