//! Plays a crowd and counts and times the work of each frame, on the device or the CPU.

use relievo::Error;
use relievo::asset::Affine;
use serde::Serialize;

use crate::measure::errors::{Errors, Jump, Meter};
use crate::measure::placement::Placements;
use crate::measure::stage::Stage;
use crate::measure::tally::middle;

/// Largest number of frames of a run that are timed.
const TIMED: u32 = 40;

/// What a frame computed.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Played {
    /// Number of bones that were sampled.
    pub interpolated: usize,
    /// Number of bones whose matrices were computed.
    pub concatenated: usize,
    /// The times of the frame under the gate and in full, if it was timed.
    pub times: Option<[FrameTimes; 2]>,
}

/// How a frame is timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Timing {
    None,
    /// Times the frame as a whole, as a renderer records it.
    Whole,
    /// Times each stage separately. The sum exceeds the whole, because the stages cannot share a compute
    /// pass.
    Stages,
}

impl Timing {
    /// The timing of a frame; timed frames alternate between the two kinds.
    fn of(number: u32, frames: u32) -> Self {
        let every = frames.div_ceil(TIMED);
        match number / every % 2 {
            _ if number == 0 || !number.is_multiple_of(every) => Self::None,
            0 => Self::Whole,
            _ => Self::Stages,
        }
    }
}

/// The times of a frame in nanoseconds, as far as they were taken: gate, sample, local to model, and the whole.
pub(crate) type FrameTimes = [Option<f64>; 4];

/// The times of a frame that was timed only as a whole.
pub(crate) fn of_whole(nanoseconds: f64) -> FrameTimes {
    [None, None, None, Some(nanoseconds)]
}

/// Times by stage and of the whole frame, in nanoseconds per bone of the crowd; on the CPU only the whole is measured.
/// Medians over the frames that were timed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StageTimes {
    /// The search for clip clocks, the decision of the gate, and the lists of active bones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gate: Option<f64>,
    /// The interpolation between keyframes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sample: Option<f64>,
    /// The concatenation of local transforms to model matrices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub local_to_model: Option<f64>,
    /// The whole frame, recorded as one piece.
    pub total: f64,
}

/// A crowd under a gate, and the same crowd in full.
pub(crate) trait Play {
    /// Advances both crowds to a frame.
    fn play(&mut self, number: u32, timing: Timing) -> Result<Played, Error>;
    /// Model matrices of the gated crowd.
    fn stale(&self) -> &[Affine];
    /// Model matrices of the crowd in full.
    fn fresh(&self) -> &[Affine];
}

/// The measurements of a run.
pub(crate) struct Found {
    pub interpolated: u64,
    pub concatenated: u64,
    pub errors: Errors,
    pub jump: Jump,
    /// Median times of the crowd under the gate, and in full.
    pub times: [StageTimes; 2],
}

/// Plays all frames, and measures all but the first. Calls `step` after each frame.
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
    let pairs = stage.pairs() as f64;
    let medians = |crowd: usize| {
        let all: Vec<FrameTimes> = times.iter().map(|both: &[FrameTimes; 2]| both[crowd]).collect();
        let median = |at: usize| Some(middle(all.iter().filter_map(|times| times[at]).collect())? / pairs);
        let [gate, sample, local_to_model, whole] = std::array::from_fn(median);
        // If no whole frame was timed, the sum of the stages stands for it.
        let sum = || [gate, sample, local_to_model].into_iter().flatten().sum();
        StageTimes { gate, sample, local_to_model, total: whole.unwrap_or_else(sum) }
    };
    Ok(Found { interpolated, concatenated, errors, jump, times: [0, 1].map(medians) })
}
