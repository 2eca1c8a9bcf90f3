// One level of diamond-square subdivision for a batch of patches that are generated alone and whose neighbours
// wrap around (B section 3.3.1). A thread owns a block of coarse points, four wide, and writes four samples for each: the point
// itself, and those to the right of it, below it and diagonally below it. It streams the coarse rows through registers, and
// computes the diamonds above and to the left of its block a second time.
import package::wgsl::hash::threefry2x32;
import package::wgsl::terrain::blocks::{Block, Blocks, block_of};
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

// The four coarse points of a block, and the corners of the cells whose diamonds they need.
struct Columns {
    // Coarse columns; the last one has no cell of its own.
    points: vec4<u32>,
    // The cells to the right of the points, and the one to the left of the first: behind the last cell comes the first.
    cells: vec4<u32>,
    left_cell: u32,
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
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = block_of(level.blocks, group, groups, lane);
    if !block.there {
        return;
    }
    // A power of two.
    let cells = level.coarse_width - 1u;
    let points = min(vec4<u32>(4u * block.at.x) + LANES, vec4<u32>(cells));
    let before = (points.x + cells - 1u) & (cells - 1u);
    let columns = Columns(points, points & vec4<u32>(cells - 1u), before);
    let first = level.blocks.rows * block.at.y;
    let last = min(first + level.blocks.rows, level.coarse_width);
    // Above the first row lie the last row's diamonds.
    let above = (first + cells - 1u) & (cells - 1u);
    var upper = diamonds(
        block.window, columns, above, row_of(block.window, columns, above),
        row_of(block.window, columns, above + 1u));
    var here = row_of(block.window, columns, first);
    for (var y = first; y < last; y++) {
        // Below the last row lie the first row's diamonds.
        let cell = y & (cells - 1u);
        var corners = here;
        if cell != y {
            corners = row_of(block.window, columns, 0u);
        }
        let below = row_of(block.window, columns, cell + 1u);
        let lower = diamonds(block.window, columns, cell, corners, below);
        write_rows(block, columns, y, here, below, upper.inner, lower);
        here = below;
        upper = lower;
    }
}

fn row_of(patch_index: u32, columns: Columns, y: u32) -> CoarseRow {
    let next = columns.cells + vec4<u32>(1u);
    let left = vec4<i32>(
        coarse_point(patch_index, vec2<u32>(columns.cells.x, y)), coarse_point(patch_index, vec2<u32>(columns.cells.y, y)),
        coarse_point(patch_index, vec2<u32>(columns.cells.z, y)), coarse_point(patch_index, vec2<u32>(columns.cells.w, y)));
    let right = vec4<i32>(
        coarse_point(patch_index, vec2<u32>(next.x, y)), coarse_point(patch_index, vec2<u32>(next.y, y)),
        coarse_point(patch_index, vec2<u32>(next.z, y)), coarse_point(patch_index, vec2<u32>(next.w, y)));
    let rim = vec2<i32>(
        coarse_point(patch_index, vec2<u32>(columns.left_cell, y)),
        coarse_point(patch_index, vec2<u32>(columns.left_cell + 1u, y)));
    // The last point is the right corner of the cell before it.
    let points = select(vec4<i32>(rim.y, right.xyz), left, columns.cells == columns.points);
    return CoarseRow(points, left, right, rim);
}

fn diamonds(patch_index: u32, columns: Columns, y: u32, above: CoarseRow, below: CoarseRow) -> DiamondRow {
    let means = mean_of_sums(above.left + below.left, above.right + below.right);
    let rim = above.rim + below.rim;
    let mean = mean_of_sums(vec4<i32>(rim.x), vec4<i32>(rim.y));
    let x = 2u * columns.cells + vec4<u32>(1u);
    let left_x = vec4<u32>(2u * columns.left_cell + 1u);
    let row = 2u * y + 1u;
    return DiamondRow(drawn(patch_index, x, row, means), drawn(patch_index, left_x, row, mean).x);
}

// Writes the two fine rows that belong to a coarse row; there is only one for the last.
fn write_rows(
    block: Block, columns: Columns, y: u32, here: CoarseRow, below: CoarseRow, upper: vec4<i32>, lower: DiamondRow,
) {
    let first = 8u * block.at.x;
    store_four(block.window, first, 2u * y, here.points);
    let beside = drawn(
        block.window, 2u * columns.points + vec4<u32>(1u), 2u * y,
        mean_of_sums(here.points + here.right, upper + lower.inner));
    store_four(block.window, first + 1u, 2u * y + 1u, lower.inner);
    let before = vec4<i32>(lower.left, lower.inner.xyz);
    let under = drawn(
        block.window, 2u * columns.points, 2u * y + 1u,
        mean_of_sums(here.points + below.points, before + lower.inner));
    store_four(block.window, first + 1u, 2u * y, held(beside));
    store_four(block.window, first, 2u * y + 1u, held(under));
}

fn coarse_point(patch_index: u32, at: vec2<u32>) -> i32 {
    if FIRST {
        let height = level.corners[at.x + 2u * at.y];
        if FEATURES == FEATURES_NONE {
            return height;
        }
        return injected(level.base_features, patch_index, vec2<i32>(at), height);
    }
    return coarse[patch_index * level.coarse_points + at.y * level.coarse_width + at.x];
}

// Adds random offsets to means at the fine samples (x[i], y) and injects features.
fn drawn(patch_index: u32, x: vec4<u32>, y: u32, means: vec4<i32>) -> vec4<i32> {
    let origin = vec2<u32>(origins[patch_index]);
    // The edge of a patch has a power of two of intervals.
    let mask = level.fine_width - 2u;
    let world_x = origin.x + (x & vec4<u32>(mask)) * level.fine_spacing;
    let world_y = vec4<u32>(origin.y + (y & mask) * level.fine_spacing);
    let words = threefry2x32(level.key, world_x, world_y);
    var heights = means + height_offset(DISTRIBUTION, level.range, words);
    if FEATURES != FEATURES_NONE {
        for (var lane = 0u; lane < 4u; lane++) {
            let chosen = LANES == vec4<u32>(lane);
            let column = i32(dot(select(vec4<u32>(0u), x, chosen), vec4<u32>(1u)));
            let feature = feature_at(level.fine_features, patch_index, vec2<i32>(column, i32(y)));
            heights = injected_lanes(feature, chosen, heights);
        }
    }
    return heights;
}

// Stores every other sample of a row.
fn store_four(patch_index: u32, x: u32, y: u32, heights: vec4<i32>) {
    let row = patch_index * level.fine_points + y * level.fine_width;
    let width = select(0u, level.fine_width, y < level.fine_width);
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
