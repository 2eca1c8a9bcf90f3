// Where a max-mip pyramid keeps its nodes: all levels in one plane. Level 0 stands at the left; the others stand
// below each other at its right, from a column that is a multiple of four. Every level has ⌈cells / 2^level⌉ nodes an axis.

// Levels from one node a cell up to one node in all.
fn surface_levels(cells: vec2<u32>) -> u32 {
    let longest = max(cells.x, cells.y);
    return select(firstLeadingBit(longest - 1u) + 2u, 1u, longest <= 1u);
}

// The texel of a node: its level, 0 for cells, and its index at that level.
fn surface_atlas_at(cells: vec2<u32>, level: u32, index: vec2<i32>) -> vec2<i32> {
    if level == 0u {
        return index;
    }
    // At least the rows of the levels between: (r >> 1) + 1 ≥ ⌈r / 2⌉ for what is left of them at each.
    let above = cells.y - (cells.y >> (level - 1u)) + level - 1u;
    return index + vec2<i32>(vec2<u32>((cells.x + 3u) & ~3u, above));
}
