//! Selection of the clusters to skin in a frame, among visible instances at their level of detail: clusters with an
//! updated bone, clusters of instances whose influences changed, and clusters that morph targets move if the instance's
//! weights changed.
//!
//! A skipped bone thus saves its vertices, and invisible instances cost nothing. The order of the list may differ
//! between runs; its set does not. An invisible instance keeps its vertices. Once it is visible again, all of it is
//! skinned, whatever moved. Clusters beyond its level keep their vertices likewise, and are skinned when the level
//! becomes finer.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
mod state;

pub use state::ClusterState;

#[cfg(feature = "gpu")]
pub use pass::{ClusterSelectBuffers, ClusterSelectPass, SKINNED_WORDS};
