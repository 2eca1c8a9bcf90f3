//! Turns the gate's bit masks into lists:
//!
//! - the (instance, bone) pairs to sample;
//! - the slots whose model matrices must be recomputed, because they or an ancestor are sampled;
//! - the arguments of the indirect dispatches.
//!
//! Prefix sums make the order of the lists the same on every device.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{CompactJob, CompactPass};
