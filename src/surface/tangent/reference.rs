//! Tangent frames of meshes: the CPU reference of `kernels/surface/tangent.wgsl`. The code is in `asset`, because the model
//! import uses it too.

pub use crate::asset::tangents::{TangentFrame, frames, tangents};
