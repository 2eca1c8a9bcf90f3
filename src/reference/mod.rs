//! The CPU twins: pure functions over slices that compute what the kernels compute, in the same order.
//! Written to be compared with the shaders line by line; also the CPU path of machines without a GPU.

pub mod animation;
pub mod baseline;
pub mod hash;
pub mod skinning;
pub mod surface;
pub mod terrain;
