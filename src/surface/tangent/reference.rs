//! Tangent frames of meshes: the CPU reference of `kernels/surface/tangent.wgsl`. The code is in `asset`, because the model
//! import also uses it.

#[doc(inline)]
pub use crate::asset::tangents::{TangentFrame, frames, tangents};
