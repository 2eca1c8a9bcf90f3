//! Selection of the clusters that are skinned in a frame, among instances that are seen, at their level of
//! detail: clusters with an updated bone, clusters of instances whose influences changed and, where morph
//! targets move vertices, clusters of instances whose weights changed. Skipping a bone thus saves its vertices,
//! and instances that are not seen cost nothing. The order of the list may differ between runs; its set does
//! not.
//!
//! An instance that is not seen keeps its vertices. When it is seen again, all of it is skinned, whatever
//! moved. Clusters beyond its level keep their vertices likewise, and are skinned when the level becomes finer.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
mod state;

pub use state::ClusterState;

#[cfg(feature = "gpu")]
pub use pass::{SKINNED_WORDS, SelectBuffers, SelectPass};
