//! Animation level of detail: decides which bones of which instances are sampled in a frame (A sections 10 to 12).
//!
//! A gate decides with integers, so that every device decides alike. It saves work: a bone that is not sampled keeps its last
//! local transform. It is concatenated only if one of its ancestors is active. Bones that their clip does not move cost nothing
//! under any gate.
//!
//! [`animation::frame`](super::frame) has the steps of a frame before and after the gate.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{GateJob, GatePass};

use super::gate_table::{AnimatedBones, BoundTable, ExpectationTable, PriorityTable};
use crate::asset::keyframe::RotationPath;

/// The method that chooses the bones to sample. Each variant owns the table by which it decides.
#[derive(Debug, Clone, PartialEq)]
pub enum Gate {
    /// Samples every bone that its clip moves.
    Off(AnimatedBones),
    /// Skips updates by A's rule (section 12.10): a bone *skips* one update per period of `priority · Ω · period` ticks.
    ///
    /// **Decided**: the period is the time between two *skipped* updates, as in A's example. A also calls it the time step of
    /// updates, which would update important bones least.
    ///
    /// **Decided**: at Ω = 1 no update is skipped, as A says of near objects. A's rule alone would still skip one per
    /// `priority · period` there.
    ///
    /// **Decided**: an update is skipped where the clock passes a multiple of the current period. A does not say where the
    /// period begins. With this choice, the clock needs no memory per bone when priority and Ω change. A hash of the instance's
    /// index offsets its clock by 0 to 65,535 ticks, so that instances do not skip in step.
    SkipPeriod {
        /// Priorities of each clip's bones.
        table: PriorityTable,
        /// Period in ticks for priority 1 at Ω = 1; A uses one second.
        period: u32,
    },
    /// Samples all bones of an instance together, in a fraction Ω of the frames. Engines call this update-rate optimization.
    Uniform(AnimatedBones),
    /// Samples a random fraction Ω of all bones, by a hash of frame and bone: on average as many as [`Gate::Uniform`].
    Random(AnimatedBones),
    /// Samples bones that may have moved further than the instance's error budget permits, parents first.
    ///
    /// A bone whose missed motion is within its fraction of the remaining budget is not sampled. What it does not use is left
    /// to the bones below it. A bone that missed more is sampled and leaves all of the budget. Bones thus take turns, and one
    /// uses what another does not need.
    ///
    /// No point, and no vertex under linear blend skinning, is ever further from its place than
    /// [`Lod::allowed`](super::lod::Lod::allowed). The bound does not hold for dual quaternions, because they are not convex
    /// combinations. Skinning refuses them under this gate.
    Bounded(BoundTable),
    /// Samples a limited number of bones of the crowd: those whose stale transforms are expected to be most visible. See
    /// [`super::budget`].
    Budget {
        /// Expected visible motion of each bone.
        table: ExpectationTable,
        /// Largest number of bones per frame. Instances that must be sampled in full are sampled even beyond it.
        bones: u32,
    },
}

impl Gate {
    /// Name of the gate on the command line and in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Off(_) => "off",
            Self::SkipPeriod { .. } => "skip-period",
            Self::Uniform(_) => "uniform",
            Self::Random(_) => "random",
            Self::Bounded(_) => "bounded",
            Self::Budget { .. } => "budget",
        }
    }

    /// The bones that each clip moves.
    pub fn animated_bones(&self) -> &AnimatedBones {
        match self {
            Self::Off(bones) | Self::Uniform(bones) | Self::Random(bones) => bones,
            Self::SkipPeriod { table, .. } => table.animated_bones(),
            Self::Bounded(table) => table.animated_bones(),
            Self::Budget { table, .. } => table.animated_bones(),
        }
    }

    /// Rotation path for which the gate's motion table was computed; `None` for gates that do not use motion.
    pub fn path(&self) -> Option<RotationPath> {
        match self {
            Self::Off(_) | Self::Uniform(_) | Self::Random(_) | Self::SkipPeriod { .. } => None,
            Self::Bounded(table) => Some(table.path()),
            Self::Budget { table, .. } => Some(table.path()),
        }
    }

    /// How far ahead of the frame's time bones may be sampled, in seconds; 0 except for [`Gate::Bounded`].
    pub fn ahead(&self, frame: &Frame) -> f32 {
        if matches!(self, Self::Bounded(_)) { frame.ahead } else { 0.0 }
    }
}

/// The time of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame {
    /// Monotonic clock in ticks; the caller chooses the length of a tick. It wraps at 2³².
    pub ticks: u32,
    /// Ticks since the previous frame.
    pub frame_ticks: u32,
    /// Number of frames so far.
    pub frame: u32,
    /// How far ahead of its time [`Gate::Bounded`] may sample a bone, in seconds. A bone whose error is split evenly before and
    /// after the sampled time stays valid twice as long. Use about the length of a frame; 0 disables it.
    pub ahead: f32,
}
