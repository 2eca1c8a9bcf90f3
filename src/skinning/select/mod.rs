//! Which clusters are skinned in a frame, of instances that are seen, at their level of detail: those with a bone that
//! moved, those of instances whose influences count otherwise, and where morph targets move vertices, those of instances
//! whose weights changed. Skipping a bone so saves its vertices, and what is not seen costs nothing. The list's order
//! differs from run to run; what is skinned does not.
//!
//! An instance that is not seen keeps the vertices that it had. Seen again, all of it is skinned, whatever moved.
//! Clusters beyond its level keep their vertices likewise, and are skinned once the level is a finer one.

#[cfg(feature = "verify")]
pub(crate) mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub(crate) mod verify;

#[cfg(feature = "gpu")]
pub use pass::{SKINNED_WORDS, SelectBuffers, SelectPass};
