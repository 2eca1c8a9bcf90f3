// Pages of skinned vertices.

// The page of a cluster that has none.
const NO_PAGE: u32 = 4294967295u;
