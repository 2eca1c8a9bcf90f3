//! Draws of single instances in an order that the host chooses: transparent surfaces from back to front.
//!
//! The host knows neither the level of detail nor the visibility of an instance. So each part of each sorted instance has its own
//! draw, which the device fills from the decision of [`decide`](super::decide). The draw is empty if the view does not see the
//! instance. Each draw has its own list with one entry, in the format of [`list`](super::list). The entry includes the steps of a
//! geomorph or the weight of an instance that fades out.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::lod::sorted::SortedDraw;
#[cfg(feature = "gpu")]
pub use pass::{SortedBuffers, SortedPass};
