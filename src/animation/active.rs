//! The work of a frame for a crowd: lists of what a gate chose.

#[cfg(feature = "gpu")]
mod buffers;

pub use crate::shared::animation::gate_state::PAIR_AHEAD;
#[cfg(feature = "gpu")]
pub use buffers::{Active, ActivePairs};
