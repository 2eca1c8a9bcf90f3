//! A copy of bytes (`kernels/baseline/copy.wgsl`).

pub use pass::{CopyBuffers, CopyPass};

mod pass;
pub mod reference;
