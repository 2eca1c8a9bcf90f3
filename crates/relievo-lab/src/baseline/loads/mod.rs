//! Texel loads (`kernels/baseline/loads.wgsl`).

pub use pass::LoadsPass;

mod pass;
pub mod reference;
