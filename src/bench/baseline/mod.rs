//! Benchmarks of `kernels/baseline/`.

pub mod copy;
pub mod words;
