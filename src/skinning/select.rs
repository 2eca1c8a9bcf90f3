//! Which clusters are skinned in a frame: those with a bone that moved, and those of instances whose reduction changed.
//! Skipping a bone so saves its vertices. The list's order differs from run to run; what is skinned does not.

#[cfg(feature = "gpu")]
mod pass;

#[cfg(feature = "gpu")]
pub use pass::{SelectBuffers, SelectPass};
