// Clusters: runs of vertices that are skinned together.

// Number of vertices in a cluster, and of words in a column of influences.
const CLUSTER: u32 = 64u;

// State of a cluster in a frame, if last positions are kept. Not skinned: last positions equal the current ones.
const CLUSTER_STILL: u32 = 0u;
// Skinned: last positions are those of the last frame.
const CLUSTER_MOVED: u32 = 1u;
// Skinned for the first time, or again after it was invisible: last positions equal the current ones.
const CLUSTER_FRESH: u32 = 2u;
