//! Drawing in the caller's render pass.
//!
//! A [`Renderer`] draws a [`Scene`](crate::scene::Scene) through a [`View`](crate::scene::View), into targets of one
//! [`TargetFormat`]: this is what an engine embeds, and [`scene`](crate::scene) begins with the order of calls.
//!
//! Without a scene, each kind of thing has a pass of its own over the caller's buffers: [`TerrainRenderer`],
//! [`ReliefRenderer`], [`SkinnedRenderer`], and [`CrowdScene`] for crowds of several characters. [`Camera`] and [`Target`]
//! are a simple camera and an off-screen target for these; a scene has [cameras](crate::scene::Camera) of its own.

mod albedo;
mod camera;
mod contents;
mod crowd;
mod format;
mod layer;
mod offscreen;
#[cfg(not(target_arch = "wasm32"))]
pub mod picture;
mod pipeline;
#[cfg(not(target_arch = "wasm32"))]
pub mod posed;
pub mod relief;
mod renderer;
mod shading;
pub mod skinned;
#[cfg(not(target_arch = "wasm32"))]
mod square;
mod sun_shadow;
pub mod target;
pub mod terrain;

pub use albedo::Albedo;
pub use camera::Camera;
pub use contents::Contents;
pub use crowd::{Character, CrowdScene};
pub use format::{DepthFormat, TargetFormat};
pub use layer::Layer;
pub use offscreen::Offscreen;
#[cfg(not(target_arch = "wasm32"))]
pub use picture::Picture;
pub use relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer, ReliefScene};
pub use renderer::{Renderer, ScenePass};
pub use skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
#[cfg(not(target_arch = "wasm32"))]
pub use square::SquarePicture;
pub use sun_shadow::SunShadow;
pub use target::Target;
pub use terrain::{FieldsId, Materials, Style, TerrainRenderer, TerrainScene};

pub use crate::surface::ColorTexture;
