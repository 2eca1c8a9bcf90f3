//! Benchmarks of `kernels/baseline/`.
