//! Playing a crowd: what a frame does and takes, on the device or the CPU.

use serde::Serialize;

use super::errors::{Errors, Jump, Meter};
use super::placement::Placements;
use super::stage::Stage;
use crate::Error;
use crate::asset::Affine;

/// Frames of a run that are timed.
const TIMED: u32 = 40;

/// What a frame did.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Played {
    /// Bones that were sampled.
    pub interpolated: usize,
    /// Bones whose matrices were computed.
    pub concatenated: usize,
    /// What it took, where that was asked for.
    pub times: Option<Times>,
}

/// How a frame is timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Timing {
    None,
    /// In one piece, as a renderer records it.
    Whole,
    /// Each stage by itself, which costs more: they cannot share a compute pass.
    Stages,
}

impl Timing {
    /// Frames that are timed take turns.
    fn of(number: u32, frames: u32) -> Self {
        let every = frames.div_ceil(TIMED);
        match number / every % 2 {
            _ if number == 0 || !number.is_multiple_of(every) => Self::None,
            0 => Self::Whole,
            _ => Self::Stages,
        }
    }
}

/// Nanoseconds of a frame.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Times {
    /// With the gate.
    pub gated: FrameTimes,
    /// Without.
    pub full: FrameTimes,
}

/// What was measured of a frame.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FrameTimes {
    pub gate: Option<f64>,
    pub sample: Option<f64>,
    pub local_to_model: Option<f64>,
    pub whole: Option<f64>,
}

/// Nanoseconds by stage, and of whole frames; on the CPU the latter alone. Medians over the frames that were timed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StageTimes {
    /// The search for clip clocks, the decision and the lists.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gate: Option<f64>,
    /// Keyframes' interpolation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sample: Option<f64>,
    /// From local transforms to the model's space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub local_to_model: Option<f64>,
    /// The whole frame, recorded in one piece.
    pub total: f64,
}

/// A crowd under a gate, and the same in full.
pub(crate) trait Play {
    /// Brings both to a frame.
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error>;
    /// The gated crowd's model matrices.
    fn stale(&self) -> &[Affine];
    /// The full crowd's.
    fn fresh(&self) -> &[Affine];
}

/// What a run found.
pub(crate) struct Found {
    pub interpolated: u64,
    pub concatenated: u64,
    pub errors: Errors,
    pub jump: Jump,
    /// Medians.
    pub gated: StageTimes,
    pub full: StageTimes,
}

/// Plays all frames, and measures all but the first. `step` is called after each.
pub(crate) fn play(
    crowds: &mut impl Play,
    stage: &Stage<'_>,
    placements: &Placements,
    is_timed: bool,
    step: impl Fn(),
) -> Result<Found, Error> {
    let mut meter = Meter::new(&stage.radii, stage.projection, placements);
    let (mut interpolated, mut concatenated, mut times) = (0, 0, Vec::new());
    let frames = stage.options.frames;
    for number in 0..=frames {
        let timing = if is_timed { Timing::of(number, frames) } else { Timing::None };
        let played = crowds.play(number, timing)?;
        if number > 0 {
            interpolated += played.interpolated as u64;
            concatenated += played.concatenated as u64;
            times.extend(played.times);
            meter.add(crowds.stale(), crowds.fresh());
        }
        step();
    }
    let (errors, jump) = meter.finish();
    let [gated, full] = [|times: &Times| times.gated, |times: &Times| times.full]
        .map(|of| medians(&times.iter().map(of).collect::<Vec<_>>()));
    Ok(Found { interpolated, concatenated, errors, jump, gated, full })
}

/// The median, where there is one.
pub(crate) fn middle(mut times: Vec<f64>) -> Option<f64> {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied()
}

fn medians(times: &[FrameTimes]) -> StageTimes {
    let median = |of: &dyn Fn(&FrameTimes) -> Option<f64>| middle(times.iter().filter_map(of).collect());
    let [gate, sample, local_to_model] =
        [median(&|taken| taken.gate), median(&|taken| taken.sample), median(&|taken| taken.local_to_model)];
    // The stages' sum where no whole frame was timed.
    let sum = [gate, sample, local_to_model].into_iter().flatten().sum();
    StageTimes { gate, sample, local_to_model, total: median(&|taken| taken.whole).unwrap_or(sum) }
}

impl FrameTimes {
    /// Of a frame in one piece.
    pub(crate) fn of_whole(nanoseconds: f64) -> Self {
        Self { whole: Some(nanoseconds), ..Self::default() }
    }
}

impl StageTimes {
    /// Divided by so many bones.
    pub(crate) fn a_bone(&self, bones: usize) -> Self {
        let each = |time: Option<f64>| time.map(|time| time / bones as f64);
        Self {
            gate: each(self.gate),
            sample: each(self.sample),
            local_to_model: each(self.local_to_model),
            total: self.total / bones as f64,
        }
    }
}
