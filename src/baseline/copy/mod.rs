//! A copy of bytes (`kernels/baseline/copy.wgsl`).

#[cfg(feature = "verify")]
pub(crate) mod bench;
mod pass;
pub(crate) mod reference;
#[cfg(feature = "verify")]
pub(crate) mod verify;

pub(crate) use pass::{CopyBuffers, CopyPass};
