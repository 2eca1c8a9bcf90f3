//! The gates that can be measured, by name, with their parameters.

use relievo::InputError;
use relievo::asset::keyframe::RotationPath;
use relievo::ops::animation::Frame;
use relievo::ops::animation::priority::Weights;
use serde::Serialize;

use crate::measure::bounds::check;

/// Ticks per second.
pub(crate) const TICKS: u32 = 1 << 16;

/// The rotation path along which rotations are sampled.
pub(crate) const PATH: RotationPath = RotationPath::Slerp;

/// A gate with its parameters. Ω, from 0 to 1, is the level of detail of an instance at its distance: 1 is full
/// detail.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "mode", rename_all = "kebab-case")]
pub enum GateMode {
    /// Samples every bone that the clip moves.
    Off,
    /// A's rule (section 12.10): a bone skips one update each priority · Ω · period.
    SkipPeriod {
        /// Seconds between two skipped updates at priority 1 and Ω = 1, in 0..=65535.
        period: f64,
        /// Weights of the terms that make a bone's priority.
        weights: Weights,
    },
    /// Samples all bones of an instance together, in a fraction Ω of the frames.
    Uniform,
    /// Samples a random fraction Ω of the bones.
    Random,
    /// Samples the bones that have missed most motion on screen.
    Budget {
        /// The largest number of bones in a frame, over the whole crowd.
        #[serde(rename = "budget")]
        bones: u32,
    },
    /// Samples the bones whose error could become visible.
    Bounded {
        /// The largest error that may show, in pixels, in 0..=1e6.
        pixels: f32,
    },
}

/// A gate's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[expect(missing_docs, reason = "as those of GateMode")]
pub enum GateName {
    Off,
    SkipPeriod,
    Uniform,
    Random,
    Budget,
    Bounded,
}

impl GateName {
    /// All names, in the order of the variants.
    pub const ALL: [Self; 6] =
        [Self::Off, Self::SkipPeriod, Self::Uniform, Self::Random, Self::Budget, Self::Bounded];

    /// The name as command lines and reports have it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::SkipPeriod => "skip-period",
            Self::Uniform => "uniform",
            Self::Random => "random",
            Self::Budget => "budget",
            Self::Bounded => "bounded",
        }
    }
}

impl GateMode {
    /// The gate's name.
    pub fn name(&self) -> GateName {
        match self {
            Self::Off => GateName::Off,
            Self::SkipPeriod { .. } => GateName::SkipPeriod,
            Self::Uniform => GateName::Uniform,
            Self::Random => GateName::Random,
            Self::Budget { .. } => GateName::Budget,
            Self::Bounded { .. } => GateName::Bounded,
        }
    }

    /// Checks the gate's parameters.
    ///
    /// # Errors
    /// [`InputError`] for a period, weights or pixels out of their ranges.
    pub fn validate(&self) -> Result<(), InputError> {
        match self {
            Self::SkipPeriod { period, weights } => {
                check("period", *period, 0.0..=f64::from(u32::MAX / TICKS))?;
                weights.validate()
            }
            Self::Bounded { pixels } => check("pixels", (*pixels).into(), 0.0..=1e6),
            Self::Off | Self::Uniform | Self::Random | Self::Budget { .. } => Ok(()),
        }
    }

    /// The error that may show, in pixels.
    pub(crate) fn pixels(&self) -> f32 {
        if let Self::Bounded { pixels } = *self { pixels } else { 0.0 }
    }
}

/// The ticks of a frame at a rate in frames per second, and its time in seconds.
pub(crate) fn frame(number: u32, rate: f64) -> (Frame, f32) {
    let seconds = |number: u32| f64::from(number) / rate;
    let ticks = |number: u32| (seconds(number) * f64::from(TICKS)).round() as u64 as u32;
    let frame_ticks = ticks(number).wrapping_sub(number.checked_sub(1).map_or(0, ticks));
    let ahead = rate.recip() as f32;
    (Frame { ticks: ticks(number), frame_ticks, frame: number, ahead }, seconds(number) as f32)
}
