//! Texel loads (`kernels/baseline/loads.wgsl`).

mod pass;
pub mod reference;

pub use pass::LoadsPass;
