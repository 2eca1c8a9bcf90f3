//! Twins of `kernels/skinning/`.

pub mod morph;
pub mod palette;
pub mod skin;
pub mod weights;
