//! States of clusters, used if vertex positions of the previous frame are kept.

use crate::shared::skinning::cluster::{CLUSTER_FRESH, CLUSTER_MOVED, CLUSTER_STILL};

/// The effect of a selection on one cluster of an instance, used if vertex positions of the previous frame are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ClusterState {
    /// Not skinned: the previous positions equal the current positions.
    Still = CLUSTER_STILL,
    /// Skinned: the previous positions are the positions before this skinning.
    Moved = CLUSTER_MOVED,
    /// Skinned for the first time or after an invisible frame: the previous positions are set to the current positions.
    Fresh = CLUSTER_FRESH,
}
