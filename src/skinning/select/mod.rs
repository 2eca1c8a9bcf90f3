//! Selection of the clusters to skin in a frame. Only visible instances at their level of detail count. A cluster is
//! selected if one of its bones was updated, if its instance's influences changed, or if morph targets move it and
//! their weights changed.
//!
//! Vertices whose bones are not updated are therefore not skinned again, and invisible instances cost nothing. The
//! order of the list may differ between runs; the set of clusters does not. Vertices of an invisible instance keep
//! their values. Once the instance is visible again, all of it is skinned. Clusters beyond an instance's level of
//! detail also keep their values, and are skinned when a finer level includes them.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
mod state;

pub use state::ClusterState;

#[cfg(feature = "gpu")]
pub use pass::{ClusterSelectBuffers, ClusterSelectPass, SKINNED_WORDS};
