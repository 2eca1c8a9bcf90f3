// Layout of a max-mip pyramid's nodes in one plane. Level 0 lies at the left. The other levels are stacked to its right, from a
// column that is a multiple of four. Every level has ⌈cells / 2^level⌉ nodes per axis.
import package::wgsl::surface::ray::SURFACE_WRAP;

// Number of levels of a pyramid, from one node per cell up to a single node.
fn surface_levels(cells: vec2<u32>) -> u32 {
    let longest = max(cells.x, cells.y);
    return select(firstLeadingBit(longest - 1u) + 2u, 1u, longest <= 1u);
}

// Texel of a node, given the node's level (0 for cells) and its index at that level.
fn surface_atlas_at(cells: vec2<u32>, level: u32, index: vec2<i32>) -> vec2<i32> {
    if level == 0u {
        return index;
    }
    // Upper bound of the number of rows of levels 1 to level - 1. Level k has at most (r >> 1) + 1 rows, where
    // r = cells.y >> (k - 1). The bound adds r - (r >> 1) + 1 for each k instead, which is at least as large and has a short
    // sum.
    let above = cells.y - (cells.y >> (level - 1u)) + level - 1u;
    return index + vec2<i32>(vec2<u32>((cells.x + 3u) & ~3u, above));
}

// Index of the texel at the first corner of a cell, among the texels of all maps of a batch. `cell` may be one beyond the last
// cell along each axis.
fn surface_corner_index(size: vec2<u32>, address: u32, map: u32, cell: vec2<i32>) -> u32 {
    let texels = vec2<i32>(size);
    let wrapped = select(cell, vec2<i32>(0), cell >= texels);
    let clamped = clamp(cell - 1, vec2<i32>(0), texels - 1);
    let at = vec2<u32>(select(clamped, wrapped, address == SURFACE_WRAP));
    return (map * size.y + at.y) * size.x + at.x;
}
