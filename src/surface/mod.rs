//! Surface mapping: every ray-height method over one result, the maps that accelerate them, and tangent frames
//! (B sections 3.1 and 4.2).

pub mod map;

pub use map::{Address, HeightMap};
