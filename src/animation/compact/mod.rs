//! From bits to lists: the pairs of instance and bone that are sampled, the slots that are concatenated since a bone
//! above them is sampled, and the arguments of the indirect dispatches that do it. By prefix sums, in the same order on
//! every device.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
pub(crate) mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub(crate) use pass::Stages;
#[cfg(feature = "gpu")]
pub use pass::{CompactJob, CompactPass};
