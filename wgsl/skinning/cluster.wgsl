// Clusters: groups of consecutive vertices that are skinned together.

// Number of vertices in a cluster. A column of influences has the same number of words, one per vertex.
const CLUSTER: u32 = 64u;

// Cluster state: not skinned in this frame, so its last positions equal the current ones. States exist only if last positions
// are kept.
const CLUSTER_STILL: u32 = 0u;
// Cluster state: skinned in this frame. Its last positions come from the last frame.
const CLUSTER_MOVED: u32 = 1u;
// Cluster state: skinned for the first time, or again after it was invisible. Its last positions equal the current ones.
const CLUSTER_FRESH: u32 = 2u;
