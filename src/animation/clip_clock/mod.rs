//! Clip clocks. A clip clock is the integer position of an instance on the timeline that all bones of its clip share. Gates read
//! clip clocks, so this operation runs before `animation/gate`.
//!
//! The operation also finds the instances that must be sampled in full. Instances are sampled in full:
//!
//! - in their first frame, and after they were hidden;
//! - when their clip changes;
//! - when the host asks for it ([`BoneSampling::Forced`](super::lod::BoneSampling::Forced));
//! - when a layer above their base clip gains its first weight, loses all weight, or changes its clip.
//!
//! While layers above the base have weight, accumulated motion cannot be used, because it describes a single clip.

pub use crate::shared::animation::clip_clock::BLENDED;
use crate::shared::animation::gate_state;
pub use crate::shared::animation::gate_state::ClipClock;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{ClipClockJob, ClipClockPass};

/// Reason to update a pose apart from the passing of time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum UpdateReason {
    /// No special reason: the gate decides.
    Free = gate_state::UPDATE_REASON_FREE,
    /// The instance is not visible: no bone is sampled.
    Hidden = gate_state::UPDATE_REASON_HIDDEN,
    /// The stored pose is invalid: all bones are sampled.
    Forced = gate_state::UPDATE_REASON_FORCED,
    /// Layers above the base clip have weight. Gates that decide by motion sample all bones; other gates decide per bone as
    /// usual.
    Blended = gate_state::UPDATE_REASON_BLENDED,
}

impl UpdateReason {
    /// Returns whether gates that decide by motion must sample all bones.
    pub fn forces_motion(self) -> bool {
        matches!(self, Self::Forced | Self::Blended)
    }
}

impl ClipClock {
    /// Packs a clip clock without a look-ahead time, so no bone is sampled ahead. `fraction` is the progress from `row` to the
    /// next row, 0 to 65536.
    pub fn new(row: u32, fraction: u32, reason: UpdateReason, clip: u32) -> Self {
        let fraction_and_reason = gate_state::progress_word(fraction, reason as u32);
        Self { row, fraction_and_reason, clip, ahead_row: row, ahead_fraction: fraction }
    }

    /// Whether the look-ahead pose differs from the current pose, so that bones may be sampled ahead of the frame's time.
    pub fn is_ahead(&self) -> bool {
        (self.ahead_row, self.ahead_fraction) != (self.row, self.fraction())
    }

    /// Progress from the current row to the next, 0 to 65536.
    pub fn fraction(&self) -> u32 {
        gate_state::progress_fraction(self.fraction_and_reason)
    }

    /// Reason to update the pose apart from the passing of time.
    pub fn reason(&self) -> UpdateReason {
        match gate_state::progress_reason(self.fraction_and_reason) {
            gate_state::UPDATE_REASON_FREE => UpdateReason::Free,
            gate_state::UPDATE_REASON_HIDDEN => UpdateReason::Hidden,
            gate_state::UPDATE_REASON_FORCED => UpdateReason::Forced,
            _ => UpdateReason::Blended,
        }
    }
}
