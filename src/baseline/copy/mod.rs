//! A copy of bytes (`kernels/baseline/copy.wgsl`).

mod pass;
pub mod reference;

pub use pass::{CopyBuffers, CopyPass};
