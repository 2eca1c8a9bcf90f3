//! Clip clocks: the integer position of each instance on the timeline that all bones of its clip share. Gates
//! decide by them, so this operation runs before `animation/gate`. It also finds whether an instance must be
//! sampled in full: in its first frame, after it was hidden, when its clip changes, when the host asks for it
//! ([`Sampling::Forced`](super::lod::Sampling::Forced)), and when layers above its clip gain or lose all weight, or
//! change their clips. While such layers have weight, sums of motion, which describe a single clip, cannot be
//! used.

pub use crate::shared::animation::clip_clock::BLENDED;
use crate::shared::animation::gate_state;
pub use crate::shared::animation::gate_state::ClipClock;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{ClipClockJob, ClipClockPass};

/// The reason, other than time, to update a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum UpdateReason {
    /// There is none: the gate decides.
    Free = gate_state::UPDATE_REASON_FREE,
    /// The instance is not seen: nothing is sampled.
    Hidden = gate_state::UPDATE_REASON_HIDDEN,
    /// The stored pose is invalid: everything is sampled.
    Forced = gate_state::UPDATE_REASON_FORCED,
    /// Layers have weight above the clip: gates that decide by motion sample everything, other gates decide for
    /// every bone.
    Blended = gate_state::UPDATE_REASON_BLENDED,
}

impl UpdateReason {
    /// Whether gates that decide by motion sample everything.
    pub fn forces_motion(self) -> bool {
        matches!(self, Self::Forced | Self::Blended)
    }
}

impl ClipClock {
    /// A clip clock from its parts, without sampling ahead.
    pub fn new(row: u32, fraction: u32, reason: UpdateReason, clip: u32) -> Self {
        let fraction_and_reason = gate_state::progress_word(fraction, reason as u32);
        Self { row, fraction_and_reason, clip, ahead_row: row, ahead_fraction: fraction }
    }

    /// Whether bones may be sampled ahead.
    pub fn is_ahead(&self) -> bool {
        (self.ahead_row, self.ahead_fraction) != (self.row, self.fraction())
    }

    /// The fraction of the way to the next row, 0 to 65536.
    pub fn fraction(&self) -> u32 {
        gate_state::progress_fraction(self.fraction_and_reason)
    }

    /// The reason, other than time, to update the pose.
    pub fn reason(&self) -> UpdateReason {
        match gate_state::progress_reason(self.fraction_and_reason) {
            gate_state::UPDATE_REASON_FREE => UpdateReason::Free,
            gate_state::UPDATE_REASON_HIDDEN => UpdateReason::Hidden,
            gate_state::UPDATE_REASON_FORCED => UpdateReason::Forced,
            _ => UpdateReason::Blended,
        }
    }
}
