//! Animation level of detail: a gate decides which bones of which instances are sampled in a frame (thesis A, sections 10 to 12).
//!
//! Gates compute with integers, so every device makes the same decisions. A bone that is not sampled keeps its last local
//! transform; its model matrix is recomputed only if an ancestor is active. Bones that a clip does not move cost nothing under
//! any gate.
//!
//! [`animation::frame`](super::frame) shows the steps of a frame before and after the gate.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{GateJob, GatePass};

use super::gate_table::{AnimatedBones, BoundTable, ExpectationTable, PriorityTable};
use super::order::Order;
use crate::InputError;
use crate::asset::keyframe::RotationPath;

/// Method that chooses the bones to sample. Each variant contains the table that the method needs.
#[derive(Debug, Clone, PartialEq)]
pub enum Gate {
    /// Samples every bone that the instance's clip moves.
    Off(AnimatedBones),
    /// Skips updates by the rule of thesis A (section 12.10): a bone *skips* one update in each period. The current period is
    /// `priority · Ω · period` ticks long.
    ///
    /// **Decided**: the period is the time between two *skipped* updates, as in the example of thesis A. The thesis also calls it
    /// the time step of updates. With that meaning, important bones would be updated least often.
    ///
    /// **Decided**: at Ω = 1 no update is skipped, as thesis A says of near objects. The rule alone would still skip one update
    /// per `priority · period` ticks.
    ///
    /// **Decided**: an update is skipped when the clock passes a multiple of the current period. Thesis A does not say where the
    /// period begins. This choice needs no memory per bone when priority and Ω change. A hash of the instance's index offsets the
    /// instance's clock by 0 to 65,535 ticks, so that instances do not skip in step.
    SkipPeriod {
        /// Priority of each bone at each key time of each clip.
        table: PriorityTable,
        /// Period in ticks for priority 1 at Ω = 1; thesis A uses one second.
        period: u32,
    },
    /// Samples all bones of an instance together, in a fraction Ω of the frames. Engines call this update-rate optimization.
    Uniform(AnimatedBones),
    /// Samples a random fraction Ω of all bones, chosen by a hash of frame and bone. On average, it samples as many bones as
    /// [`Gate::Uniform`].
    Random(AnimatedBones),
    /// Samples bones that may have moved further than the instance's error budget allows. Parents are decided before their
    /// children.
    ///
    /// Each bone may use a fraction of the remaining budget. A bone whose missed motion is within this fraction is not sampled;
    /// its missed motion is subtracted from the budget of the bones below it. A bone that missed more is sampled and subtracts
    /// nothing. Bones thus take turns. Budget that one bone does not need is available to others.
    ///
    /// Under linear blend skinning, no point or vertex is ever further from its exact position than
    /// [`Lod::allowed`](super::lod::Lod::allowed). The bound does not hold for dual quaternions, because dual quaternion blends
    /// are not convex combinations. Skinning by dual quaternions is refused under this gate.
    Bounded(BoundTable),
    /// Samples a limited number of the crowd's bones: the bones whose stale transforms are expected to be most visible. See
    /// [`super::budget`].
    Budget {
        /// Expected visible motion of each bone.
        table: ExpectationTable,
        /// Largest number of bones per frame. Instances that must be sampled in full are sampled even beyond this limit.
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

    /// Table of the bones that each clip moves.
    pub fn animated_bones(&self) -> &AnimatedBones {
        match self {
            Self::Off(bones) | Self::Uniform(bones) | Self::Random(bones) => bones,
            Self::SkipPeriod { table, .. } => table.animated_bones(),
            Self::Bounded(table) => table.animated_bones(),
            Self::Budget { table, .. } => table.animated_bones(),
        }
    }

    /// Marks bones that the gate never skips: each is sampled in every frame that shows its instance, if the clip moves it. `bones`
    /// says so for each bone of `order`'s skeleton, by bone index.
    ///
    /// # Errors
    /// [`InputError`] if `order` or `bones` has another number of bones than the gate.
    pub fn never_skip(&mut self, order: &Order, bones: &[bool]) -> Result<(), InputError> {
        let table = match self {
            Self::Off(bones) | Self::Uniform(bones) | Self::Random(bones) => bones,
            Self::SkipPeriod { table, .. } => table.animated_bones_mut(),
            Self::Bounded(table) => table.animated_bones_mut(),
            Self::Budget { table, .. } => table.animated_bones_mut(),
        };
        InputError::check_same("order.slots.len", order.slots.len(), table.bones(), "as the gate's bones")?;
        InputError::check_len("bones", bones.len(), table.bones(), "a bone")?;
        table.set_always(|slot| bones[order.slots[slot].bone as usize]);
        Ok(())
    }

    /// Rotation path that the gate's motion table was computed for; `None` for gates that do not use motion.
    pub fn path(&self) -> Option<RotationPath> {
        match self {
            Self::Off(_) | Self::Uniform(_) | Self::Random(_) | Self::SkipPeriod { .. } => None,
            Self::Bounded(table) => Some(table.path()),
            Self::Budget { table, .. } => Some(table.path()),
        }
    }

    /// How far ahead of the frame's time bones may be sampled, in seconds; always 0 for gates other than [`Gate::Bounded`].
    pub fn ahead(&self, frame: &Frame) -> f32 {
        if matches!(self, Self::Bounded(_)) { frame.ahead } else { 0.0 }
    }
}

/// Clock values of a frame: the input of a gate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame {
    /// Monotonic clock in ticks, which wraps at 2³². The caller chooses the length of a tick.
    pub ticks: u32,
    /// Ticks since the previous frame.
    pub frame_ticks: u32,
    /// Number of frames since the start.
    pub frame: u32,
    /// How far ahead of the frame's time [`Gate::Bounded`] may sample a bone, in seconds; 0 disables sampling ahead. A bone that
    /// is sampled ahead stays within its allowed error both before and after the sampled time. Its sample is thus valid for twice
    /// as long. Use about the length of a frame.
    pub ahead: f32,
}
