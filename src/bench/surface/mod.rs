//! Benchmarks of `kernels/surface/`.

pub mod cone_map;
pub mod height_pyramid;
pub mod relief;
pub mod shade;
pub mod tangent;
