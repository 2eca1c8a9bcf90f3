//! A frame of a crowd under a gate as one object, on the device and on the CPU.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::GatedFrame;
