//! Where instances stand on the timeline that all bones of their clip share, in whole numbers: what gates decide by.
//! Comes before `animation/gate`. Whether an instance has to be sampled in full is found here
//! too: at its first frame, after it was hidden, when its clip changed, when the host asks for it
//! ([`Lod::REFRESH`](super::lod::Lod::REFRESH)), and when layers above its clip begin or end to count, or change their
//! clips. While they count, sums of motion, which know of one clip alone, mean nothing.

pub use crate::shared::animation::clip_clock::BLENDED;
pub use crate::shared::animation::gate_state::ClipClock;

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
pub(crate) mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{ClipClockJob, ClipClockPass};

/// What asks for a pose besides the time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum UpdateReason {
    /// Nothing: the gate decides.
    Free = 0,
    /// Nobody sees it: nothing is sampled.
    Hidden = 1,
    /// Its stored pose means nothing: everything is sampled.
    Forced = 2,
    /// Layers lie above its clip: gates that decide by motion sample everything, others decide on every bone.
    Blended = 3,
}

impl UpdateReason {
    /// Whether gates that decide by motion sample everything.
    pub fn forces_motion(self) -> bool {
        matches!(self, Self::Forced | Self::Blended)
    }
}

impl ClipClock {
    /// A phase from its parts; nothing may be sampled ahead.
    pub fn new(row: u32, fraction: u32, reason: UpdateReason, clip: u32) -> Self {
        let fraction_and_reason = (reason as u32) << 20 | fraction;
        Self { row, fraction_and_reason, clip, ahead_row: row, ahead_fraction: fraction }
    }

    /// Whether bones may be sampled ahead.
    pub fn is_ahead(&self) -> bool {
        (self.ahead_row, self.ahead_fraction) != (self.row, self.fraction())
    }

    /// The way to the next row, 0 to 65536.
    pub fn fraction(&self) -> u32 {
        self.fraction_and_reason & 0xf_ffff
    }

    /// What asks for a pose besides the time.
    pub fn reason(&self) -> UpdateReason {
        match self.fraction_and_reason >> 20 {
            0 => UpdateReason::Free,
            1 => UpdateReason::Hidden,
            2 => UpdateReason::Forced,
            _ => UpdateReason::Blended,
        }
    }
}
