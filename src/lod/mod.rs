//! Level of detail in scenes: which instances a view sees and how fine ([`select`]), in which order it draws them
//! ([`list`]), and what gates and skinning make of the displacement that the views of a frame allow ([`assign`]).
//! Meshes that are attached to bones are placed once these are posed ([`attach`]).
//!
//! Instances of all objects lie in one buffer of [`SceneInstance`], those of an object in whole blocks of [`BLOCK`]. A view
//! ([`SelectView`]) sees them through its planes ([`planes`]), and has up to [`VIEW_CAMERAS`] cameras ([`LodCamera`]) that
//! decide how far anything may be off: usually its own, for a shadow map those of the views that show the shadows.

pub mod assign;
pub mod attach;
mod camera;
mod instance;
pub mod list;
mod object;
pub mod select;

pub use crate::shared::lod::instance::{
    CELL_SIZE, INSTANCE_ALIVE, INSTANCE_CARRIES, INSTANCE_CASTS, INSTANCE_MASK_SHIFT, SceneInstance,
};
pub use crate::shared::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
pub use crate::shared::lod::view::{LodCamera, SelectView, VIEW_CAMERAS};
pub use camera::planes;

#[cfg(feature = "verify")]
pub(crate) mod verify;
