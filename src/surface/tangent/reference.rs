//! Tangent frames of meshes: the CPU reference of `kernels/surface/tangent.wgsl`. The code lies in `asset`,
//! because the import uses it too.

pub use crate::asset::tangents::{TangentFrame, frames, tangents};
