//! Skinning: meshes that follow skeletons, their levels of detail (LODs), and bounds of their motion (thesis A sections 8.4
//! and 9).

pub mod at_rest;
#[doc(hidden)]
pub mod attribute_weights;
#[cfg(feature = "gpu")]
pub(crate) mod bone_path;
pub mod bounding_sphere;
#[cfg(feature = "gpu")]
pub mod buffers;
pub mod character_levels;
pub mod clusters;
pub mod collapse;
mod cook;
pub mod export;
pub mod extent;
#[cfg(feature = "gpu")]
pub mod frame;
pub mod instance_lod;
mod joined_levels;
pub mod levels;
pub mod merged;
pub mod morph;
pub mod morph_weights;
mod motion_bounds;
#[cfg(feature = "gpu")]
pub mod paged;
pub mod pages;
pub mod palette;
mod pose;
pub mod select;
pub mod skin;
#[doc(hidden)]
pub mod tiers;
pub mod vertex;

pub use at_rest::{at_rest, still};
pub use character_levels::{level_errors, level_errors_within, own_levels};
pub use collapse::collapse_bones;
pub use cook::{cook, sparse_poses_of};
pub use extent::Extent;
pub use instance_lod::{FadeRange, InstanceLod};
pub use joined_levels::{Examined, join_levels, join_levels_in};
pub use levels::{MeshLevels, add_levels, add_levels_and_at_rest, add_levels_with_progress};
pub use merged::{Merged, merged};
#[cfg(feature = "gpu")]
pub(crate) use motion_bounds::{motion_bounds, spheres};
pub use pose::poses_of;
pub use tiers::SkeletonTier;
pub use vertex::{Blend, Vertex};
