//! Tangent frames of meshes: the reference of `kernels/surface/tangent.wgsl`. It lies with the data that it is also
//! used to import.

pub use crate::asset::tangents::{Frame, frames, tangents};
