//! The first half of a frame: from the time to lists of what is sampled and concatenated. It is `clip_clock`, `gate` (or
//! `budget`) and `compact`, one after another; for a small crowd under another gate than a budget all in one dispatch,
//! where a dispatch costs more than other processors gain and the device lets a shader bind that many buffers. Both ways
//! leave the same in every buffer.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::Dispatches;
#[cfg(feature = "gpu")]
pub use pass::{DecideJob, DecidePass};
