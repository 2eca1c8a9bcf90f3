//! Level of detail and culling of a scene's instances.
//!
//! - [`select`]: which instances a view sees, and the metric of each.
//! - [`decide`]: levels of detail of these instances, from metrics, hysteresis and transitions.
//! - [`budget`]: the factor that coarsens the levels, so that the triangles fit a limit.
//! - [`list`]: the lists of instances that the view draws.
//! - [`sorted`]: draws of single instances, in an order that the host chooses.
//! - [`assign`]: the detail of bone gates and skinning, from the displacement that the views of a frame allow.
//! - [`attach`]: placements of meshes that follow bones, once the bones are posed.
//!
//! A scene (feature `gpu`) runs these kernels for you. They are public for programs that keep their own instances and draws. In a
//! frame, record [`select`], [`decide`] and [`list`] for each view, and set [`SelectView::is_first`](SelectView) in the first
//! view. Then record [`assign`] for each character, and draw from the lists.
//!
//! Instances of all objects lie in one buffer of [`SceneInstance`]. Each object takes whole blocks of [`BLOCK`] instances. A view
//! ([`SelectView`]) culls instances by its planes ([`planes`]). Up to [`VIEW_CAMERAS`] cameras ([`LodCamera`]) limit how far
//! levels of detail may displace surfaces. Usually there is one, the view's own camera. A shadow map has the cameras of the views
//! that show the shadows.
//!
//! An instance's position consists of a cell and an offset in world units. A cell is a cube with an edge of [`CELL_SIZE`] world
//! units. Planes and cameras are relative to the corner of the view's cell. Errors of levels are in model units. An allowed
//! displacement in world units, divided by the instance's largest scale, is in model units.

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
    CELL_SIZE, INSTANCE_ALIVE, INSTANCE_CARRIES, INSTANCE_CASTS, INSTANCE_FOLLOWS, INSTANCE_WHOLE,
    SceneInstance, instance_flags_mask, instance_flags_word,
};
pub use crate::shared::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
pub use crate::shared::lod::view::{LodCamera, SelectView, VIEW_CAMERAS};
pub use camera::{Depth, is_mirrored, planes};

// `relievo-asset` repeats the constant of the shaders.
const _: () = assert!(crate::asset::gltf::OBJECT_LEVELS == OBJECT_LEVELS as usize);
