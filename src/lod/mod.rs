//! Level of detail and culling of a scene's instances.
//!
//! - [`select`]: which instances a view sees, and their metric.
//! - [`decide`]: their levels of detail, from metrics, hysteresis and transitions.
//! - [`budget`]: by how much the levels are coarsened, so that the triangles fit.
//! - [`list`]: the lists from which the view draws them.
//! - [`sorted`]: draws of single instances.
//! - [`assign`]: the detail of gates and skinning, from the displacement that the views of a frame allow.
//! - [`attach`]: placements of meshes that follow bones, once the bones are posed.
//!
//! A scene (feature `gpu`) runs these kernels for you. They are public for programs that keep their own instances and
//! draws. In a frame, record [`select`], [`decide`] and [`list`] for each view; the first view is marked as
//! such ([`SelectView::is_first`](SelectView)). Then record [`assign`] for each character, and draw from the lists.
//!
//! Instances of all objects lie in one buffer of [`SceneInstance`]; those of an object take whole blocks of [`BLOCK`].
//! A view ([`SelectView`]) culls them by its planes ([`planes`]). Up to [`VIEW_CAMERAS`] cameras ([`LodCamera`]) limit
//! the displacement: usually the view's own camera; for a shadow map, those of the views that show the shadows.
//!
//! An instance's position is a cell of [`CELL_SIZE`] world units an edge, and an offset in world units. Planes and
//! cameras are relative to the corner of the view's cell. Errors of levels are in the model's units. So are allowed
//! displacements, once divided by an instance's largest scale.

#[doc(hidden)]
pub mod allowed;
pub mod assign;
pub mod attach;
pub mod budget;
mod camera;
pub mod criterion;
pub mod decide;
mod instance;
pub mod list;
#[doc(hidden)]
pub mod object;
pub mod select;
pub mod sorted;
pub mod transition;

pub use crate::shared::lod::budget_state::BudgetState;
pub use crate::shared::lod::instance::{
    CELL_SIZE, INSTANCE_ALIVE, INSTANCE_CARRIES, INSTANCE_CASTS, INSTANCE_FOLLOWS, SceneInstance,
    instance_flags_mask, instance_flags_word,
};
pub use crate::shared::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
pub use crate::shared::lod::view::{LodCamera, SelectView, VIEW_CAMERAS};
pub use camera::{Depth, is_mirrored, planes};
