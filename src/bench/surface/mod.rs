//! Benchmarks of `kernels/surface/`.

pub mod tangent;
