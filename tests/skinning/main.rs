//! Skinning: the reference compared with geometry, and with independent code in double precision.

mod blending;
mod borders;
mod collapse;
mod fading;
mod flat;
#[path = "../lod/foreign.rs"]
mod foreign;
mod gating;
use relievo_testing as harness;
mod hull;
mod joined;
mod levels;
mod merged;
mod reduced;
mod rigs;
mod scales;
mod shapes;
mod updated;
