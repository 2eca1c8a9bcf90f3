// One level of diamond-square subdivision for a batch of windows onto the plane (B section 3.3.1).
//
// A thread owns 4 x CELL_ROWS coarse cells. It streams the coarse rows through registers and computes the
// diamonds on its rim again, so that threads need no barrier and a level is one dispatch.
import package::wgsl::hash::threefry2x32;
import package::wgsl::terrain::fixed::mean_of_sums;
import package::wgsl::terrain::offset::height_offset;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, feature_word, injected};

// Rows of coarse cells a thread: many for a software adapter, few for hardware.
override CELL_ROWS: u32 = 4u;
// Whether the coarse level is the base lattice, which is drawn here instead of loaded.
override FIRST: bool = false;
// OFFSET_*
override DISTRIBUTION: u32 = 0u;

struct Level {
    key: vec2<u32>,
    // Points along an edge of a window, and points a window.
    fine_width: u32,
    fine_points: u32,
    coarse_width: u32,
    coarse_points: u32,
    // World coordinates between neighbouring fine samples.
    fine_spacing: u32,
    fine_range: u32,
    base_range: u32,
    blocks_per_row: u32,
    // Threads a window, and windows.
    blocks: u32,
    windows: u32,
    @align(16) fine_features: FeatureGrid,
    @align(16) base_features: FeatureGrid,
}

@group(0) @binding(0) var<uniform> level: Level;
// World coordinates of each window's first fine sample, in units of fine_spacing.
@group(0) @binding(1) var<storage, read> origins: array<vec2<i32>>;
@group(0) @binding(2) var<storage, read> coarse: array<i32>;
@group(0) @binding(3) var<storage, read_write> fine: array<i32>;

// Columns -1 .. 4 of the coarse row at the thread's cells.
struct CoarseRow {
    left: i32,
    inner: vec4<i32>,
    right: i32,
}

// The centres of cells -1 .. 3 between two coarse rows.
struct DiamondRow {
    left: i32,
    inner: vec4<i32>,
}

// World coordinates of a thread's fine columns: those of coarse points, and those between.
struct Columns {
    even: vec4<u32>,
    odd: vec4<u32>,
}

// A place in one window: the fine sample at coarse point (0, 0) may lie one or two before the window.
struct Place {
    window: u32,
    origin: vec2<i32>,
    shift: vec2<i32>,
}

const LANES = vec4<i32>(0, 1, 2, 3);

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index >= level.blocks * level.windows {
        return;
    }
    let in_window = index % level.blocks;
    let block = vec2<i32>(vec2<u32>(in_window % level.blocks_per_row, in_window / level.blocks_per_row));
    let place = place_of(index / level.blocks);
    // Cells start at the coarse point that is, or lies one before, the window's first sample.
    let cell = place.shift - vec2<i32>(1) + block * vec2<i32>(4, i32(CELL_ROWS));
    subdivide(place, cell);
}

fn place_of(window: u32) -> Place {
    let origin = origins[window];
    // The coarse origin is ceil(origin / 2) - 1.
    let coarse_origin = ((origin + vec2<i32>(1)) >> vec2<u32>(1u)) - vec2<i32>(1);
    return Place(window, origin, origin - 2 * coarse_origin);
}

fn subdivide(place: Place, cell: vec2<i32>) {
    let columns = Columns(world_x(place, cell.x), world_x(place, cell.x) + vec4<u32>(level.fine_spacing));
    var here = coarse_row(place, cell);
    var upper = diamonds(place, columns, coarse_row(place, cell - vec2<i32>(0, 1)), here, cell - vec2<i32>(0, 1));
    let last = min(cell.y + i32(CELL_ROWS), (i32(level.fine_width) - 1 + place.shift.y) / 2 + 1);
    for (var y = cell.y; y < last; y++) {
        let at = vec2<i32>(cell.x, y);
        let fine_at = 2 * at - place.shift;
        let below = coarse_row(place, at + vec2<i32>(0, 1));
        let lower = diamonds(place, columns, here, below, at);
        let beside = vec4<i32>(here.inner.yzw, here.right);
        let top = drawn(
            place, columns.odd, fine_at + vec2<i32>(1, 0),
            mean_of_sums(here.inner + beside, upper.inner + lower.inner));
        store_row(place, fine_at, here.inner, top);
        let before = vec4<i32>(lower.left, lower.inner.xyz);
        let left = drawn(
            place, columns.even, fine_at + vec2<i32>(0, 1),
            mean_of_sums(here.inner + below.inner, before + lower.inner));
        store_row(place, fine_at + vec2<i32>(0, 1), left, lower.inner);
        here = below;
        upper = lower;
    }
}

// World coordinates of the coarse points from column `x` on.
fn world_x(place: Place, x: i32) -> vec4<u32> {
    return vec4<u32>(vec4<i32>(place.origin.x + 2 * x - place.shift.x) + 2 * LANES) * level.fine_spacing;
}

fn diamonds(place: Place, columns: Columns, above: CoarseRow, below: CoarseRow, cell: vec2<i32>) -> DiamondRow {
    let fine_at = 2 * cell - place.shift + vec2<i32>(1);
    let sums = above.inner + below.inner;
    let beside = vec4<i32>(sums.yzw, above.right + below.right);
    let left = mean_of_sums(vec4<i32>(above.left + below.left), vec4<i32>(sums.x)).x;
    return DiamondRow(
        drawn_one(place, columns.odd.x - 2u * level.fine_spacing, fine_at - vec2<i32>(2, 0), left),
        drawn(place, columns.odd, fine_at, mean_of_sums(sums, beside)));
}

// Adds the random offset to four means at fine samples `at`, `at` + (2, 0), … whose world coordinates are x
// and injects features.
fn drawn(place: Place, x: vec4<u32>, at: vec2<i32>, means: vec4<i32>) -> vec4<i32> {
    let world_y = u32(place.origin.y + at.y) * level.fine_spacing;
    let words = threefry2x32(level.key, x, vec4<u32>(world_y));
    let heights = means + height_offset(DISTRIBUTION, level.fine_range, words);
    if FEATURES == FEATURES_NONE {
        return heights;
    }
    return injected_four(level.fine_features, place.window, at, 2, heights);
}

fn drawn_one(place: Place, x: u32, at: vec2<i32>, mean: i32) -> i32 {
    let world_y = u32(place.origin.y + at.y) * level.fine_spacing;
    let words = threefry2x32(level.key, vec4<u32>(x), vec4<u32>(world_y));
    let height = mean + height_offset(DISTRIBUTION, level.fine_range, words).x;
    if FEATURES == FEATURES_NONE {
        return height;
    }
    return injected(level.fine_features, place.window, at, height);
}

fn coarse_row(place: Place, cell: vec2<i32>) -> CoarseRow {
    if FIRST {
        let inner = base_points(place, cell);
        let rim = base_points(place, cell - vec2<i32>(1, 0)).x;
        return CoarseRow(rim, inner, base_points(place, cell + vec2<i32>(4, 0)).x);
    }
    // Points outside the window feed only samples outside it: any value will do.
    let last = i32(level.coarse_width) - 1;
    let row = place.window * level.coarse_points + u32(clamp(cell.y, 0, last)) * level.coarse_width;
    let x = clamp(vec4<i32>(cell.x) + LANES, vec4<i32>(0), vec4<i32>(last));
    let inner = vec4<i32>(
        coarse[row + u32(x.x)], coarse[row + u32(x.y)], coarse[row + u32(x.z)], coarse[row + u32(x.w)]);
    let left = coarse[row + u32(clamp(cell.x - 1, 0, last))];
    return CoarseRow(left, inner, coarse[row + u32(min(cell.x + 4, last))]);
}

// Four points of the base lattice from coarse point `cell` on.
fn base_points(place: Place, cell: vec2<i32>) -> vec4<i32> {
    let fine_at = place.origin + 2 * cell - place.shift;
    let world_x = vec4<u32>(vec4<i32>(fine_at.x) + 2 * LANES) * level.fine_spacing;
    let world_y = u32(fine_at.y) * level.fine_spacing;
    let heights = height_offset(
        DISTRIBUTION, level.base_range, threefry2x32(level.key, world_x, vec4<u32>(world_y)));
    if FEATURES == FEATURES_NONE {
        return heights;
    }
    return injected_four(level.base_features, place.window, cell, 1, heights);
}

// Injects features at four points `step` apart.
fn injected_four(grid: FeatureGrid, window: u32, at: vec2<i32>, step: i32, heights: vec4<i32>) -> vec4<i32> {
    // The words of the first and the last cover all four; mostly there is nothing in them.
    let first = feature_word(grid, window, at);
    let last = feature_word(grid, window, at + vec2<i32>(3 * step, 0));
    if (first.mask | last.mask) == 0u {
        return heights;
    }
    // A loop, since some drivers' compilers choke on four copies at every call.
    var result = heights;
    for (var lane = 0; lane < 4; lane++) {
        let point = injected(grid, window, at + vec2<i32>(lane * step, 0), heights[lane]);
        result = select(result, vec4<i32>(point), LANES == vec4<i32>(lane));
    }
    return result;
}

fn store_row(place: Place, at: vec2<i32>, even: vec4<i32>, odd: vec4<i32>) {
    let row = place.window * level.fine_points + u32(at.y) * level.fine_width;
    // A row outside the window has no columns.
    let width = select(0u, level.fine_width, u32(at.y) < level.fine_width);
    let x = vec4<u32>(vec4<i32>(at.x) + 2 * LANES);
    store(row, width, x.x, even.x);
    store(row, width, x.x + 1u, odd.x);
    store(row, width, x.y, even.y);
    store(row, width, x.y + 1u, odd.y);
    store(row, width, x.z, even.z);
    store(row, width, x.z + 1u, odd.z);
    store(row, width, x.w, even.w);
    store(row, width, x.w + 1u, odd.w);
}

fn store(row: u32, width: u32, x: u32, height: i32) {
    if x < width {
        fine[row + x] = height;
    }
}
