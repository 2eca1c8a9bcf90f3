//! Meshes that follow skeletons: their vertices, what moves them, and how far they reach (A sections 8.4 and 9).

pub mod ball;
#[cfg(feature = "gpu")]
pub mod buffers;
pub mod clusters;
pub mod collapse;
pub mod export;
pub mod extent;
#[cfg(feature = "gpu")]
pub mod frame;
pub mod levels;
pub mod lod;
pub mod material;
pub mod mesh;
pub mod morph;
pub mod morph_weights;
pub mod palette;
pub mod picture;
mod pose;
pub mod select;
pub mod skin;
pub mod weights;

pub use extent::Extent;
pub use levels::{MeshLevels, add_levels, level_errors, own_levels};
pub use material::Material;
pub use mesh::{Mesh, MeshLevel, reaches};
pub use morph::{MorphTarget, WeightKeys};
pub use pose::poses_of;
pub use skin::{Blend, Vertex};
pub use weights::{Influence, Influences, Reduction};
