//! The texel loads of colour maps (`kernels/baseline/texels.wgsl`).

pub(crate) mod bench;
mod pass;
pub(crate) mod reference;
pub(crate) mod verify;

pub(crate) use pass::TexelsPass;
