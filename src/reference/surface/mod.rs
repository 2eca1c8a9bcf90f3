//! Twins of surface mapping: the functions of `wgsl/surface/`, one file each, the kernels, and the exact
//! intersection that errors are measured against.

pub mod cone;
pub mod cone_map;
pub mod exact;
pub mod flat;
pub mod grid;
pub mod height;
pub mod height_pyramid;
pub mod linear;
pub mod picture;
pub mod quadtree;
pub mod relief;
pub mod shade;
pub mod shadow;
pub mod tangent;
