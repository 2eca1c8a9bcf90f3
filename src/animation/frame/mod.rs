//! A frame of a crowd under a gate as one object, on the device.

#[cfg(feature = "gpu")]
mod pass;

#[cfg(feature = "gpu")]
pub use pass::GatedFrame;
