// A level of subdivision for a batch of windows or patches: the input and output of its kernels. A thread computes the four
// fine points that belong to a coarse point. The thread's `id` has the column and row of the coarse point, and the window.
import package::wgsl::hash::threefry2x32;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, injected};
import package::wgsl::terrain::offset::height_offset;

// Distribution of the random offsets: one of the constants OFFSET_*.
override DISTRIBUTION: u32 = 0u;

// Parameters of a level of subdivision.
struct Level {
    // Key of the random words.
    key: vec2<u32>,
    // Number of points along an edge of a window at the fine level.
    fine_width: u32,
    // Number of points along an edge of a window at the coarse level.
    coarse_width: u32,
    // Difference of world coordinates between neighbouring fine points.
    spacing: u32,
    // Range of the random offsets, in 1/65536 units. With smooth interpolation, this range applies to the centers of cells.
    range: u32,
    // Range of the random offsets of points on edges, with smooth interpolation, in 1/65536 units.
    edge_range: u32,
    // Feature grids of the windows.
    @align(16) features: FeatureGrid,
}

// Parameters of the level.
@group(0) @binding(0) var<uniform> level: Level;
// World coordinates of the first fine point of each window, in multiples of the spacing.
@group(0) @binding(1) var<storage, read> origins: array<vec2<i32>>;
// Heights of the coarse points of all windows, row by row, in 1/65536 units.
@group(0) @binding(2) var<storage, read> coarse: array<i32>;
// Out: heights of the fine points of all windows, row by row, in 1/65536 units.
@group(0) @binding(3) var<storage, read_write> fine: array<i32>;

// Whether a thread may have fine points to write. A window starts at the first or at the second fine point of its first cell;
// the test covers both cases.
fn has_point(id: vec3<u32>) -> bool {
    return all(id.xy <= vec2<u32>(level.fine_width / 2u));
}

// Heights of four coarse points. Points outside the window may get any value, because they feed only fine points outside the
// window.
fn coarse_points(window: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let last = vec4<i32>(i32(level.coarse_width) - 1);
    let rows = window * level.coarse_width + vec4<u32>(clamp(y, vec4<i32>(0), last));
    let at = rows * level.coarse_width + vec4<u32>(clamp(x, vec4<i32>(0), last));
    return vec4<i32>(coarse[at.x], coarse[at.y], coarse[at.z], coarse[at.w]);
}

// Random offsets of four fine points. (x, y) are their world coordinates in multiples of the spacing.
fn offsets(range: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let words = threefry2x32(level.key, vec4<u32>(x) * level.spacing, vec4<u32>(y) * level.spacing);
    return height_offset(DISTRIBUTION, range, words);
}

// Heights of four points of the window after injection. (x, y) are the positions of the points in the feature grid.
fn injected_four(window: u32, x: vec4<i32>, y: vec4<i32>, heights: vec4<i32>) -> vec4<i32> {
    var result = heights;
    if FEATURES != FEATURES_NONE {
        // This is a loop because one driver's compiler takes gigabytes for branches that are inlined dozens of times.
        for (var lane = 0u; lane < 4u; lane++) {
            result[lane] = injected(level.features, window, vec2<i32>(x[lane], y[lane]), heights[lane]);
        }
    }
    return result;
}

// Stores four points: the point at `at`, the point to its right, the point below, and the point diagonally below. Points
// outside the window are skipped.
fn store_four(window: u32, at: vec2<i32>, heights: vec4<i32>) {
    store(window, at, heights.x);
    store(window, at + vec2<i32>(1, 0), heights.y);
    store(window, at + vec2<i32>(0, 1), heights.z);
    store(window, at + vec2<i32>(1, 1), heights.w);
}

// Stores a point if it lies in the window.
fn store(window: u32, at: vec2<i32>, height: i32) {
    let width = level.fine_width;
    if all(vec2<u32>(at) < vec2<u32>(width)) {
        fine[(window * width + u32(at.y)) * width + u32(at.x)] = height;
    }
}
