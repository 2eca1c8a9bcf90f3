//! Cases of `kernels/mesh/`.

pub mod cluster;
