//! Level of detail in scenes: which instances a view sees and how fine ([`select`]), in which order it draws them
//! ([`list`]), how it draws instances one by one ([`sorted`]), and what gates and skinning make of the displacement that the views
//! of a frame allow ([`assign`]). Meshes that are attached to bones are placed once these are posed ([`attach`]).
//!
//! A scene (feature `gpu`) runs these kernels for you. They are public for programs that keep instances and draws of their
//! own: in a frame, record [`select`] and [`list`] for each view, the first of which says so
//! ([`SelectView::is_first`](SelectView)), then [`assign`] for each character, then draw from the lists.
//!
//! Instances of all objects lie in one buffer of [`SceneInstance`], those of an object in whole blocks of [`BLOCK`]. A view
//! ([`SelectView`]) sees them through its planes ([`planes`]), and has up to [`VIEW_CAMERAS`] cameras ([`LodCamera`]) that
//! decide how far anything may be off: usually its own, for a shadow map those of the views that show the shadows.
//!
//! Positions of instances are a cell of [`CELL_SIZE`] world units an edge and an offset in world units. Planes and cameras
//! are relative to the corner of the view's cell. Errors of levels are in the model's units, allowed displacements
//! too, once an instance's largest scale has divided them.

#[doc(hidden)]
pub mod allowed;
pub mod assign;
pub mod attach;
mod camera;
#[doc(hidden)]
pub mod criterion;
mod instance;
pub mod list;
#[doc(hidden)]
pub mod object;
pub mod select;
pub mod sorted;
#[doc(hidden)]
pub mod transition;

pub use crate::shared::lod::instance::{
    CELL_SIZE, INSTANCE_ALIVE, INSTANCE_CARRIES, INSTANCE_CASTS, INSTANCE_FOLLOWS, SceneInstance,
    instance_flags_mask, instance_flags_word,
};
pub use crate::shared::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
pub use crate::shared::lod::view::{LodCamera, SelectView, VIEW_CAMERAS};
pub use camera::{is_mirrored, planes};
