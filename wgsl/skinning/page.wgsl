// Pages of skinned vertices. A page holds the vertices of one cluster of one instance.

// Page index of a cluster that has no page.
const NO_PAGE: u32 = 4294967295u;
