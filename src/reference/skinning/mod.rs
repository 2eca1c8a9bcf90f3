//! Twins of `kernels/skinning/`.

pub mod lod;
pub mod morph;
pub mod morph_weights;
pub mod palette;
pub mod picture;
pub mod select;
pub mod skin;
pub mod texture;
pub mod weights;
