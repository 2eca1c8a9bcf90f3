//! Draws of single instances in an order that the host chooses: transparent surfaces from back to front.
//!
//! The host knows neither level of detail nor visibility. So each part of each such instance has its own draw, which
//! the device fills from [`decide`](super::decide)'s decision; it draws nothing if the view does not see the instance.
//! Each draw has its own list with one entry, as in [`list`](super::list), which includes a morph and the weight of an instance that fades out.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::lod::sorted::SortedDraw;
#[cfg(feature = "gpu")]
pub use pass::{SortedBuffers, SortedPass};
