//! Work lists of one frame of a crowd: the bones and instances that the gate chose to update.

#[cfg(feature = "gpu")]
mod buffers;

pub use crate::shared::animation::gate_state::PAIR_AHEAD;
#[cfg(feature = "gpu")]
pub use buffers::{Active, ActivePairs};
