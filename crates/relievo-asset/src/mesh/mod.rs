//! Mesh simplification: the same surface with fewer triangles (thesis A sections 2 to 5, thesis B sections 3.2 and 4.3). This
//! module also measures the distance between the original and the simplified surface.

pub mod nearest;
pub mod progressive;
pub mod ray;
pub mod simplify;

pub use progressive::ProgressiveMesh;
pub use simplify::{
    Collapse, Cost, Seams, Simplified, SimplifyOptions, Stopped, Surface, simplify, simplify_within,
};
