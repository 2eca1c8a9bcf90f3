//! The first half of a frame: from the time to lists of what is sampled and concatenated. It is `clip_clock`, `gate` (or
//! `budget`) and `compact`, one after another; for a gate and a small crowd all in one dispatch, where a dispatch costs
//! more than other processors gain and the device lets a shader bind that many buffers. Both ways leave the same in every
//! buffer.

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

/// Who decides which bones are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// A gate.
    Gate(Gate),
    /// At most so many bones of the crowd.
    Budget(u32),
}

impl Choice {
    /// By how many seconds bones may be sampled ahead in a frame: nothing but [`Gate::Bounded`] does so.
    pub fn ahead(self, frame: &Frame) -> f32 {
        if self == Self::Gate(Gate::Bounded) { frame.ahead } else { 0.0 }
    }
}
