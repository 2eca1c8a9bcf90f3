//! What selections say of clusters whose last positions are kept.

use crate::shared::skinning::cluster::{CLUSTER_FRESH, CLUSTER_MOVED, CLUSTER_STILL};

/// What a selection did to a cluster of an instance whose last positions are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ClusterState {
    /// Nothing: its last positions are those that it has.
    Still = CLUSTER_STILL,
    /// It is skinned: its last positions are those before.
    Moved = CLUSTER_MOVED,
    /// It is skinned for the first time, or again after it was not seen: its last positions are those of this frame.
    Fresh = CLUSTER_FRESH,
}
