//! States of clusters whose last positions are kept.

use crate::shared::skinning::cluster::{CLUSTER_FRESH, CLUSTER_MOVED, CLUSTER_STILL};

/// The effect of a selection on an instance's cluster, if last positions are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ClusterState {
    /// Not skinned: last positions equal the current ones.
    Still = CLUSTER_STILL,
    /// Skinned: last positions are those of the last frame.
    Moved = CLUSTER_MOVED,
    /// Skinned for the first time, or again after it was invisible: last positions equal the current ones.
    Fresh = CLUSTER_FRESH,
}
