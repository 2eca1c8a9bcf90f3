//! Benchmarks of `kernels/baseline/`.

pub mod copy;
pub mod loads;
pub mod words;
