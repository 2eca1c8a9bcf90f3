// Clusters: runs of vertices that are skinned together.

// Number of vertices in a cluster, and of words in a column of influences.
const CLUSTER: u32 = 64u;

// State of a cluster in a frame, where last positions are kept: the frame did not change it.
const CLUSTER_STILL: u32 = 0u;
// The frame skinned it: its last positions are those of the frame before.
const CLUSTER_MOVED: u32 = 1u;
// The frame skinned it for the first time, or for the first time since it was not visible: its last positions are the positions
// of the same frame.
const CLUSTER_FRESH: u32 = 2u;
