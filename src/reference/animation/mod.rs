//! Twins of `kernels/animation/`.

pub mod bounds;
pub mod concat;
pub mod place;
pub mod sample;
