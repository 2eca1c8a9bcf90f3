// One level of diamond-square subdivision for a batch of patches that are generated alone and whose neighbours
// wrap around (B section 3.3.1). A thread owns a block of coarse points, four wide, and writes four samples for each: the point
// itself, and those to the right of it, below it and diagonally below it. It streams the coarse rows through registers, and
// computes the diamonds above and to the left of its block a second time.
import package::wgsl::hash::threefry2x32;
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::order::block_in_order;
import package::wgsl::terrain::fixed::{held, mean_of_sums};
import package::wgsl::terrain::offset::height_offset;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, feature_at, injected, injected_lanes};

// One of the constants OFFSET_*.
override DISTRIBUTION: u32 = 0u;
// Whether the coarse level consists of the four corners.
override FIRST: bool = false;

struct WrapLevel {
    // Heights of the corners (0, 0), (1, 0), (0, 1), (1, 1).
    corners: vec4<i32>,
    fine_features: FeatureGrid,
    base_features: FeatureGrid,
    blocks: Blocks,
    key: vec2<u32>,
    // Samples along an edge of a patch at the fine and at the coarse level.
    fine_width: u32,
    coarse_width: u32,
    fine_spacing: u32,
    range: u32,
    // Samples per patch at the fine and at the coarse level.
    fine_points: u32,
    coarse_points: u32,
}

@group(0) @binding(0) var<uniform> level: WrapLevel;
// World coordinates of the first sample of each patch.
@group(0) @binding(1) var<storage, read> origins: array<vec2<i32>>;
@group(0) @binding(2) var<storage, read> coarse: array<i32>;
@group(0) @binding(3) var<storage, read_write> fine: array<i32>;

const LANES = vec4<u32>(0u, 1u, 2u, 3u);

// The four columns of coarse points of a thread, and what depends on them alone.
struct Columns {
    patch_index: u32,
    points: vec4<u32>,
    // The cells to the right of the points, and the one to the left of the first: behind the last cell comes the first.
    cells: vec4<u32>,
    left_cell: u32,
    // World coordinates of the points, of the samples to the right of them, and of the center of the cell to the left.
    even: vec4<u32>,
    odd: vec4<u32>,
    left: u32,
    // Of the patch's first row.
    top: u32,
}

// A coarse row: the left and right corners of the cells, and the points.
struct CoarseRow {
    points: vec4<i32>,
    left: vec4<i32>,
    right: vec4<i32>,
    // The corners of the cell to the left.
    rim: vec2<i32>,
}

// The centers of a row of cells.
struct DiamondRow {
    inner: vec4<i32>,
    left: i32,
}

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let block = block_in_order(level.blocks, thread);
    if !block.there {
        return;
    }
    // A power of two.
    let cells = level.coarse_width - 1u;
    let columns = columns_of(block.window, 4u * block.at.x, cells - 1u);
    let first = level.blocks.rows * block.at.y;
    let last = min(first + level.blocks.rows, level.coarse_width);
    // Above the first row lie the last row's diamonds.
    let above = (first + cells - 1u) & (cells - 1u);
    var upper = diamonds(columns, above, row_of(columns, above), row_of(columns, above + 1u));
    var here = row_of(columns, first);
    for (var y = first; y < min(last, cells); y++) {
        let below = row_of(columns, y + 1u);
        let lower = diamonds(columns, y, here, below);
        write_rows(columns, y, here, below, upper.inner, lower);
        here = below;
        upper = lower;
    }
    // Below the last row lie the first row's diamonds, and no row of samples.
    for (var y = cells; y < last; y++) {
        let lower = diamonds(columns, 0u, row_of(columns, 0u), row_of(columns, 1u));
        store_four(columns, 0u, 2u * y, here.points);
        store_four(columns, 1u, 2u * y, held(squares_beside(columns, y, here, upper.inner, lower.inner)));
    }
}

// The columns from coarse column `first` on; `mask` is the number of the last cell.
fn columns_of(patch_index: u32, first: u32, mask: u32) -> Columns {
    let points = min(vec4<u32>(first) + LANES, vec4<u32>(mask + 1u));
    let cells = points & vec4<u32>(mask);
    let left_cell = (points.x + mask) & mask;
    let origin = vec2<u32>(origins[patch_index]);
    let spacing = level.fine_spacing;
    let even = origin.x + 2u * cells * spacing;
    return Columns(
        patch_index, points, cells, left_cell, even, even + spacing, origin.x + (2u * left_cell + 1u) * spacing, origin.y);
}

fn row_of(columns: Columns, y: u32) -> CoarseRow {
    let cells = columns.cells;
    let first = coarse_point(columns, cells.x, y);
    let right = vec4<i32>(
        coarse_point(columns, cells.x + 1u, y), coarse_point(columns, cells.y + 1u, y),
        coarse_point(columns, cells.z + 1u, y), coarse_point(columns, cells.w + 1u, y));
    let rim = vec2<i32>(
        coarse_point(columns, columns.left_cell, y), coarse_point(columns, columns.left_cell + 1u, y));
    // The right corner of a cell is the left one of the next, and the point there; behind the last cell comes the first, whose
    // left corner is another point.
    let left = select(vec4<i32>(first, right.xyz), vec4<i32>(first), cells == vec4<u32>(0u));
    let points = select(vec4<i32>(rim.y, right.xyz), left, cells == columns.points);
    return CoarseRow(points, left, right, rim);
}

fn diamonds(columns: Columns, y: u32, above: CoarseRow, below: CoarseRow) -> DiamondRow {
    let means = mean_of_sums(above.left + below.left, above.right + below.right);
    let rim = above.rim + below.rim;
    let mean = mean_of_sums(vec4<i32>(rim.x), vec4<i32>(rim.y));
    let row = 2u * y + 1u;
    let left = drawn(columns, vec4<u32>(columns.left), vec4<u32>(2u * columns.left_cell + 1u), row, mean).x;
    return DiamondRow(drawn(columns, columns.odd, 2u * columns.cells + 1u, row, means), left);
}

// Writes the two fine rows that belong to a coarse row. Samples that are known already are stored first, between the draws of
// random words.
fn write_rows(columns: Columns, y: u32, here: CoarseRow, below: CoarseRow, upper: vec4<i32>, lower: DiamondRow) {
    store_four(columns, 0u, 2u * y, here.points);
    let beside = held(squares_beside(columns, y, here, upper, lower.inner));
    store_four(columns, 1u, 2u * y + 1u, lower.inner);
    let before = vec4<i32>(lower.left, lower.inner.xyz);
    let under = held(drawn(
        columns, columns.even, 2u * columns.points, 2u * y + 1u,
        mean_of_sums(here.points + below.points, before + lower.inner)));
    store_four(columns, 1u, 2u * y, beside);
    store_four(columns, 0u, 2u * y + 1u, under);
}

// The samples to the right of the coarse points of a row.
fn squares_beside(columns: Columns, y: u32, here: CoarseRow, upper: vec4<i32>, lower: vec4<i32>) -> vec4<i32> {
    let means = mean_of_sums(here.points + here.right, upper + lower);
    return drawn(columns, columns.odd, 2u * columns.points + 1u, 2u * y, means);
}

fn coarse_point(columns: Columns, x: u32, y: u32) -> i32 {
    if FIRST {
        let height = level.corners[x + 2u * y];
        if FEATURES == FEATURES_NONE {
            return height;
        }
        return injected(level.base_features, columns.patch_index, vec2<i32>(vec2<u32>(x, y)), height);
    }
    return coarse[columns.patch_index * level.coarse_points + y * level.coarse_width + x];
}

// Adds random offsets to means at the fine samples (x[i], y) and injects features; `world_x` are world coordinates.
fn drawn(columns: Columns, world_x: vec4<u32>, x: vec4<u32>, y: u32, means: vec4<i32>) -> vec4<i32> {
    // The edge of a patch has a power of two of intervals.
    let mask = level.fine_width - 2u;
    let world_y = vec4<u32>(columns.top + (y & mask) * level.fine_spacing);
    let words = threefry2x32(level.key, world_x, world_y);
    var heights = means + height_offset(DISTRIBUTION, level.range, words);
    if FEATURES != FEATURES_NONE {
        for (var lane = 0u; lane < 4u; lane++) {
            let chosen = LANES == vec4<u32>(lane);
            let column = i32(dot(select(vec4<u32>(0u), x, chosen), vec4<u32>(1u)));
            let feature = feature_at(level.fine_features, columns.patch_index, vec2<i32>(column, i32(y)));
            heights = injected_lanes(feature, chosen, heights);
        }
    }
    return heights;
}

// Stores every other sample of a row, from the one `shift` samples to the right of the first point on.
fn store_four(columns: Columns, shift: u32, y: u32, heights: vec4<i32>) {
    let row = columns.patch_index * level.fine_points + y * level.fine_width;
    let width = select(0u, level.fine_width, y < level.fine_width);
    let x = 2u * columns.points.x + shift;
    store(row, width, x, heights.x);
    store(row, width, x + 2u, heights.y);
    store(row, width, x + 4u, heights.z);
    store(row, width, x + 6u, heights.w);
}

fn store(row: u32, width: u32, x: u32, height: i32) {
    if x < width {
        fine[row + x] = height;
    }
}
