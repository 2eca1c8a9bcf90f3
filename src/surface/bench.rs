//! Benchmarks of `kernels/surface/`.
