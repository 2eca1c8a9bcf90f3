//! Drawing in the caller's render pass.
//!
//! A [`Renderer`] draws a [`Scene`](crate::scene::Scene) through a [`View`](crate::scene::View), into targets of one
//! [`TargetFormat`]: this is what an engine embeds, and [`scene`](crate::scene) begins with the order of calls.
//!
//! [`Offscreen`] is a target for programs without a window, and the shortest way to a picture.
//!
//! Without a scene, skinned meshes have a pass of their own over the caller's buffers: [`SkinnedRenderer`], and
//! [`CrowdScene`] for crowds of several characters. [`Target`] is an off-screen target for these.

mod albedo;
mod contents;
mod crowd;
mod format;
mod layer;
mod offscreen;
mod pipeline;
#[cfg(not(target_arch = "wasm32"))]
pub mod posed;
mod renderer;
mod shading;
pub mod skinned;
mod sun_shadow;
pub mod target;

pub use albedo::Albedo;
pub use contents::Contents;
pub use crowd::{Character, CrowdScene};
pub use format::{DepthFormat, TargetFormat};
pub use layer::Layer;
pub use offscreen::Offscreen;
pub use renderer::{Renderer, ScenePass};
pub use skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
pub use sun_shadow::SunShadow;
pub use target::Target;

pub use crate::surface::ColorTexture;
