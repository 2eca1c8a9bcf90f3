//! Surface mapping: every ray-height method over one result, the maps that accelerate them, and tangent frames
//! (B sections 3.1 and 4.2).

pub mod builtin;
pub mod map;
pub mod tangent;

pub use builtin::BuiltInMap;
pub use map::{Address, HeightMap};
