//! Levels of detail of the instances that a view sees.
//!
//! [`select`](super::select) gives each visible instance a metric. A view draws the coarsest level whose threshold the metric
//! reaches. Thresholds depend on the level of the last frame (hysteresis), so that small changes of a metric near a threshold do
//! not change the level. A budget scales the metric ([`budget`](super::budget)). The object's
//! [`Transition`](super::transition::Transition) says how the level changes: the decision names the levels that are drawn.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{DecideBuffers, DecidePass};

pub use crate::shared::lod::decide::UNSEEN_LEVEL;
