//! Twins of `kernels/animation/`.

pub mod concat;
pub mod sample;
