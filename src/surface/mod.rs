//! Surface mapping: methods that find where a ray meets a height field, the maps that accelerate them, and tangent frames (thesis
//! B, sections 3.1 and 4.2).

#[cfg(feature = "gpu")]
#[doc(hidden)]
pub mod color;
pub mod cone_map;
#[cfg(feature = "gpu")]
pub(crate) mod height_batch;
pub mod height_pyramid;
pub mod linear_image;
pub mod map;
mod material;
pub mod mesh;
pub mod mips;
mod options;
pub mod relief;
pub mod tangent;

#[cfg(feature = "gpu")]
pub use color::ColorTexture;
#[cfg(feature = "gpu")]
pub use height_batch::HeightMapBatch;
pub use linear_image::LinearImage;
pub use map::{Address, HeightMap};
pub use material::{Green, ReliefMaterial, ReliefShadow};
pub use mesh::{SurfaceMesh, SurfaceVertex};
pub use mips::Mips;
#[cfg(feature = "gpu")]
pub use options::ReliefMaps;
pub use options::ReliefOptions;
#[cfg(feature = "gpu")]
pub use relief::textures::SurfaceTextures;
pub use relief::{March, Outcome, ReliefHit, ReliefMethod, ReliefRay};
