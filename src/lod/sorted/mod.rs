//! The draws of single instances, for what is drawn instance by instance in an order that the host chooses: transparent
//! surfaces from back to front.
//!
//! The host knows no level of detail and no visibility, so each part of each such instance has a draw of its own, which the
//! device fills from [`select`](super::select)'s decision: of nothing if the view does not see the instance. Each draw has a
//! list of its own with one entry, as those of [`list`](super::list), which also tells how far the level has moved.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::lod::sorted::SortedDraw;
#[cfg(feature = "gpu")]
pub use pass::{SortedBuffers, SortedPass};
