//! A frame of a crowd under a gate in one piece, and the same without a device.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::GatedFrame;
