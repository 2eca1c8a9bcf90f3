//! Parity of `kernels/baseline/`.
