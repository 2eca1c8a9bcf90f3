//! Twins of `kernels/animation/`.

pub mod bounds;
pub mod budget;
pub mod compact;
pub mod concat;
pub mod crowd;
pub mod decide;
pub mod gate;
pub mod phase;
pub mod place;
pub mod sample;
