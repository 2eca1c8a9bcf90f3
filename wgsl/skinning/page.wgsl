// Pages of skinned vertices.

// Page index of a cluster without a page.
const NO_PAGE: u32 = 4294967295u;
