//! Skinning: the reference against geometry, and against code of its own in double precision.

mod blending;
mod collapse;
mod fading;
mod gating;
#[cfg(feature = "verify")]
#[path = "../harness/mod.rs"]
mod harness;
mod levels;
mod rigs;
mod scales;
mod shapes;
