// Clusters: runs of vertices that are skinned together.

// Number of vertices in a cluster. Influences lie in columns of as many words.
const CLUSTER: u32 = 64u;
