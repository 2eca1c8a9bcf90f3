//! Parity of `kernels/surface/`.

pub mod tangent;
