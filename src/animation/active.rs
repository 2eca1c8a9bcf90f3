//! Work lists of a frame for a crowd: the bones and instances that a gate chose.

#[cfg(feature = "gpu")]
mod buffers;

pub use crate::shared::animation::gate_state::PAIR_AHEAD;
#[cfg(feature = "gpu")]
pub use buffers::{Active, ActivePairs};
