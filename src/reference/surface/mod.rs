//! Twins of `kernels/surface/`.

pub mod tangent;
