//! The texel loads of colour maps (`kernels/baseline/texels.wgsl`).

mod pass;
pub mod reference;

pub use pass::TexelsPass;
