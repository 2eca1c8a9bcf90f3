//! Turns bit masks into lists: the (instance, bone) pairs to sample, the slots to concatenate because they or an ancestor are
//! sampled, and the arguments of the indirect dispatches. Prefix sums make the order the same on every device.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{CompactJob, CompactPass};
