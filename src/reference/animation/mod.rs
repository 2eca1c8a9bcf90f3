//! Twins of `kernels/animation/`.

pub mod concat;
pub mod place;
pub mod sample;
