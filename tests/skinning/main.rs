//! Skinning: the reference against geometry, and against code of its own in double precision.

mod blending;
mod fading;
mod gating;
mod levels;
mod scales;
mod shapes;
