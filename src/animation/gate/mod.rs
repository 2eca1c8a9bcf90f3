//! Animation level of detail: which bones of which instances are sampled in a frame (A sections 10 to 12).
//!
//! A gate decides from integers, so that every device decides alike. It saves work: a bone that is not sampled
//! keeps its last local transform and, unless a bone above it is active, is not concatenated either. Bones that
//! their clip does not move cost nothing under any gate.
//!
//! [`animation::frame`](super::frame) has the steps of a frame before and after the gate.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{GateJob, GatePass};

use super::gate_table::{AnimatedBones, BoundTable, ExpectationTable, PriorityTable};
use crate::asset::keyframe::RotationPath;

/// How the bones to be sampled are chosen. Each gate owns the table by which it decides.
#[derive(Debug, Clone, PartialEq)]
pub enum Gate {
    /// Every bone that moves is sampled.
    Off(AnimatedBones),
    /// A's rule (section 12.10): a bone *skips* one update per period of `priority · Ω · period` ticks.
    ///
    /// **Decided**: the period is the time between two *skipped* updates, as in A's example. A also calls it the time
    /// step of updates, which would update important bones least.
    ///
    /// **Decided**: at Ω = 1 no update is skipped, as A says of near objects. A's rule alone would still skip one per
    /// `priority · period` there.
    ///
    /// **Decided**: an update is skipped where the clock passes a multiple of the current period. A does not say from
    /// when it counts. The clock needs no memory per bone where priority and Ω change. A hash of the instance's number
    /// sets its clock forward by 0 to 65,535 ticks, so that instances do not skip in step.
    SkipPeriod {
        /// The priorities of each clip's bones.
        table: PriorityTable,
        /// The period in ticks for priority 1 at Ω = 1; A uses one second.
        period: u32,
    },
    /// All bones of an instance together, in a fraction Ω of the frames; engines call this update-rate
    /// optimization.
    Uniform(AnimatedBones),
    /// A random fraction Ω of all bones, by a hash of frame and bone: on average as many as [`Gate::Uniform`].
    Random(AnimatedBones),
    /// Bones that may have moved further than the instance permits, parents first. A bone that missed no more
    /// than its fraction of the remaining error budget is not sampled, and passes the rest on to the bones
    /// below it. A bone that missed more is sampled, and passes on all of it. Bones thus take turns, and one
    /// uses what another does not. No point, and no vertex under linear blending, is ever further from its place
    /// than [`Lod::allowed`](super::lod::Lod::allowed). Dual quaternions are not convex combinations, so that
    /// the bound does not hold for them; skinning refuses them under this gate.
    Bounded(BoundTable),
    /// At most this many bones of the crowd, those whose stale transforms are expected to be most visible: see
    /// [`super::budget`].
    Budget {
        /// The motion of each bone as it is expected to be visible.
        table: ExpectationTable,
        /// The largest number of bones in a frame. Instances that must be sampled in full are sampled beyond
        /// it.
        bones: u32,
    },
}

impl Gate {
    /// The gate's name on the command line and in reports.
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

    /// The rotation path for which the gate's table of motion was computed; `None` for gates that do not use
    /// motion.
    pub fn path(&self) -> Option<RotationPath> {
        match self {
            Self::Off(_) | Self::Uniform(_) | Self::Random(_) | Self::SkipPeriod { .. } => None,
            Self::Bounded(table) => Some(table.path()),
            Self::Budget { table, .. } => Some(table.path()),
        }
    }

    /// The seconds by which bones may be sampled ahead in a frame; only [`Gate::Bounded`] does so.
    pub fn ahead(&self, frame: &Frame) -> f32 {
        if matches!(self, Self::Bounded(_)) { frame.ahead } else { 0.0 }
    }
}

/// The time of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame {
    /// A monotonic clock; the caller chooses the length of a tick. It wraps at 2³².
    pub ticks: u32,
    /// Ticks since the last frame.
    pub frame_ticks: u32,
    /// Number of frames so far.
    pub frame: u32,
    /// Seconds by which [`Gate::Bounded`] may sample a bone ahead of its time: a bone that is off by as much
    /// before as after can stay twice as long. Use about the length of a frame; 0 disables it.
    pub ahead: f32,
}
