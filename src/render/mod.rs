//! Drawing in the caller's render pass.
//!
//! A [`Renderer`] draws a [`Scene`](crate::scene::Scene) through a [`View`](crate::scene::View) into targets of one
//! [`TargetFormat`]. Engines embed the renderer. The documentation of [`scene`](crate::scene) begins with the order of calls.
//!
//! [`Offscreen`] is a target for programs without a window, and the shortest way to a picture.

mod attachments;
mod format;
mod layer;
mod offscreen;
mod output;
mod renderer;
mod shading;
mod sun_shadow;
pub mod target;

#[doc(inline)]
pub use crate::surface::LinearImage;
pub use attachments::Attachments;
pub use format::{DepthFormat, TargetFormat};
pub use layer::Layer;
pub use offscreen::Offscreen;
pub use output::OutputProgram;
pub use renderer::{Renderer, ScenePass};
pub use sun_shadow::SunShadow;

pub use crate::surface::ColorTexture;
