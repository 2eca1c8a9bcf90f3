//! Surface mapping: every ray-height method over one result, the maps that accelerate them, and tangent frames
//! (B sections 3.1 and 4.2).

pub mod builtin;
pub mod cone_map;
pub mod height_pyramid;
pub mod linear_image;
pub mod map;
pub mod material;
pub mod measure;
pub mod mesh;
pub mod mips;
pub mod relief;
pub mod shade;
pub mod tangent;
#[cfg(feature = "gpu")]
pub mod texture;
pub mod view;

pub use builtin::BuiltInMap;
pub use linear_image::LinearImage;
pub use map::{Address, HeightMap};
pub use material::{Green, Material, Shadow};
pub use measure::Measured;
pub use mesh::{SurfaceMesh, SurfaceVertex};
pub use mips::Mips;
pub use relief::{Hit, March, Method, Outcome, Ray};
pub use shade::{Shade, ShadePoint, ShadeView};
#[cfg(feature = "gpu")]
pub use texture::{HeightBatch, SurfaceTextures};
pub use view::SquareView;
