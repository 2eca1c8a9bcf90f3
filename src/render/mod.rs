//! Drawing: a camera, an off-screen target, and passes that draw into the caller's render pass.

mod albedo;
mod camera;
mod crowd;
mod format;
mod offscreen;
pub mod picture;
mod pipeline;
pub mod posed;
pub mod relief;
mod renderer;
pub mod skinned;
mod square;
pub mod target;
pub mod terrain;

pub use albedo::Albedo;
pub use camera::Camera;
pub use crowd::{Character, CrowdScene};
pub use format::{DepthFormat, TargetFormat};
pub use offscreen::Offscreen;
pub use picture::Picture;
pub use relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer, ReliefScene};
pub use renderer::{Layer, Renderer, ScenePass};
pub use skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
pub use square::SquarePicture;
pub use target::Target;
pub use terrain::{FieldsId, Materials, Style, TerrainRenderer, TerrainScene};

pub use crate::surface::ColorTexture;
