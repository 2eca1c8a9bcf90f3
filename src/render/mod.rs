//! Drawing: a camera, an off-screen target, and passes that draw into the caller's render pass.

mod albedo;
mod camera;
mod crowd;
mod format;
#[cfg(not(target_arch = "wasm32"))]
pub mod picture;
mod pipeline;
#[cfg(not(target_arch = "wasm32"))]
pub mod posed;
pub mod relief;
mod renderer;
pub mod skinned;
#[cfg(not(target_arch = "wasm32"))]
mod square;
pub mod target;
pub mod terrain;

pub use albedo::Albedo;
pub use camera::Camera;
pub use crowd::{Character, CrowdScene};
pub use format::{DepthFormat, TargetFormat};
#[cfg(not(target_arch = "wasm32"))]
pub use picture::Picture;
pub use relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer, ReliefScene};
pub use renderer::{Layer, Renderer, ScenePass};
pub use skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
#[cfg(not(target_arch = "wasm32"))]
pub use square::SquarePicture;
pub use target::Target;
pub use terrain::{FieldsId, Materials, Style, TerrainRenderer, TerrainScene};

pub use crate::surface::ColorTexture;
