//! Crowds: what their animation takes on the device, and the same without a device.

#[cfg(feature = "gpu")]
mod buffers;
pub mod reference;

#[cfg(feature = "gpu")]
pub use buffers::{ClipBuffers, Crowd, Local, packed, unpacked};
