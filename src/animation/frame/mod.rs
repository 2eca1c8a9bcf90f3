//! A prepared GPU frame of a crowd under a gate, from time to model matrices.

#[cfg(feature = "gpu")]
mod pass;

#[cfg(feature = "gpu")]
pub use pass::GatedFrame;
