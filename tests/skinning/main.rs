//! Skinning: the reference compared with geometry, and with independent code in double precision.

mod blending;
mod borders;
mod collapse;
mod fading;
mod flat;
mod gating;
#[cfg(feature = "verify")]
#[path = "../harness/mod.rs"]
mod harness;
mod hull;
mod levels;
mod merged;
mod reduced;
mod rigs;
mod scales;
mod shapes;
#[cfg(feature = "verify")]
mod updated;
