// Clusters: runs of vertices that are skinned together.

// Number of vertices in a cluster. Influences lie in columns of as many words.
const CLUSTER: u32 = 64u;

// What the last frame did to a cluster of an instance whose last positions are kept: nothing.
const CLUSTER_STILL: u32 = 0u;
// It was skinned, so its last positions are those before.
const CLUSTER_MOVED: u32 = 1u;
// It was skinned for the first time, or again after it was not seen, so its last positions are those of that frame.
const CLUSTER_FRESH: u32 = 2u;
