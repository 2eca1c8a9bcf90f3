//! Turns bits into lists: the pairs of instance and bone to be sampled, the slots to be concatenated because a
//! bone at or above them is sampled, and the arguments of the indirect dispatches. It uses prefix sums, so that
//! the order is the same on every device.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{CompactJob, CompactPass};
