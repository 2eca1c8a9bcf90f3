//! The texel loads of colour maps (`kernels/baseline/texels.wgsl`).

pub use pass::TexelsPass;

mod pass;
pub mod reference;
