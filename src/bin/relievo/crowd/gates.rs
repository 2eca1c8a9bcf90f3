//! Gates by name, with their tables.

use clap::ValueEnum;
use relievo::InputError;
use relievo::animation::order::Order;
use relievo::animation::priority::{self, USER_DEFAULT, Weights};
use relievo::animation::{AnimatedBones, BoundTable, ClipSet, ExpectationTable, Frame, Gate, PriorityTable};
use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Clip, Skeleton};
use serde::Serialize;

/// Ticks a second.
pub const TICKS: u32 = 1 << 16;

/// How rotations are sampled.
pub const PATH: RotationPath = RotationPath::Slerp;

/// The gates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    Off,
    SkipPeriod,
    Uniform,
    Random,
    Budget,
    Bounded,
}

impl Mode {
    /// The name on command lines and in reports.
    pub fn name(self) -> &'static str {
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

/// What gates are made from.
pub struct Source<'a> {
    pub skeleton: &'a Skeleton,
    pub clip: &'a Clip,
    pub order: &'a Order,
    pub set: &'a ClipSet,
    /// For each bone, how far points that follow it lie from its origin.
    pub bone_radii: &'a [f32],
    pub weights: &'a Weights,
}

impl Source<'_> {
    /// The gate itself, with its table; `period` in seconds, `budget` in bones.
    pub fn gate(&self, mode: Mode, period: f64, budget: u32) -> Result<Gate, InputError> {
        let Self { skeleton, clip, order, set, bone_radii, weights } = self;
        let clips = [*clip];
        Ok(match mode {
            Mode::Off => Gate::Off(AnimatedBones::new(order, set, &clips)?),
            Mode::Uniform => Gate::Uniform(AnimatedBones::new(order, set, &clips)?),
            Mode::Random => Gate::Random(AnimatedBones::new(order, set, &clips)?),
            Mode::SkipPeriod => {
                let user = vec![USER_DEFAULT; skeleton.len()];
                let priorities = priority::Priorities::new(skeleton, clip, true, weights, &user)?;
                let table = PriorityTable::new(order, set, &clips, &[priorities])?;
                Gate::SkipPeriod { table, period: (period * f64::from(TICKS)).round() as u32 }
            }
            Mode::Budget => {
                let table = ExpectationTable::new(skeleton, set, &clips, bone_radii, PATH)?;
                Gate::Budget { table, bones: budget }
            }
            Mode::Bounded => Gate::Bounded(BoundTable::new(skeleton, set, &clips, bone_radii, PATH)?),
        })
    }
}

/// When a frame is, at a rate; and its seconds.
pub fn frame(number: u32, rate: f64) -> (Frame, f32) {
    let seconds = |number: u32| f64::from(number) / rate;
    let ticks = |number: u32| (seconds(number) * f64::from(TICKS)).round() as u64 as u32;
    let frame_ticks = ticks(number).wrapping_sub(number.checked_sub(1).map_or(0, ticks));
    let ahead = rate.recip() as f32;
    (Frame { ticks: ticks(number), frame_ticks, frame: number, ahead }, seconds(number) as f32)
}
