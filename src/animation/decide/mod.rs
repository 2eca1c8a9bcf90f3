//! The first half of a frame: from the time to the lists of what is sampled and concatenated. It consists of
//! `clip_clock`, `gate` (or `budget`) and `compact`, one after another. For a gate and a small crowd all of
//! them run in one dispatch, if a dispatch costs more than further processors gain and the device permits that
//! many buffer bindings in a shader. Both ways leave the same contents in every buffer.

use super::gate::{Frame, Gate};

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{DecideJob, DecidePass, Dispatches};

/// How the bones to be sampled are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// By a gate.
    Gate(Gate),
    /// By visibility, at most this many bones of the crowd.
    Budget(u32),
}

impl Choice {
    /// The seconds by which bones may be sampled ahead in a frame; only [`Gate::Bounded`] does so.
    pub fn ahead(self, frame: &Frame) -> f32 {
        if self == Self::Gate(Gate::Bounded) { frame.ahead } else { 0.0 }
    }
}
