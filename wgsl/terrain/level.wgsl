// A level of subdivision for a batch of windows or patches: the input and output of its kernels. A thread makes the four fine
// points that belong to a coarse one: its `id` has the column and row of the coarse point, and the window.
import package::wgsl::hash::threefry2x32;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, injected};
import package::wgsl::terrain::offset::height_offset;

// One of the constants OFFSET_*.
override DISTRIBUTION: u32 = 0u;

struct Level {
    key: vec2<u32>,
    // Points along an edge of a window at the fine level.
    fine_width: u32,
    // Points along an edge of a window at the coarse level.
    coarse_width: u32,
    // World coordinates between neighbouring fine points.
    spacing: u32,
    // Range of the random offsets. With smooth interpolation, points on edges have a range of their own.
    range: u32,
    edge_range: u32,
    @align(16) features: FeatureGrid,
}

@group(0) @binding(0) var<uniform> level: Level;
// World coordinates of the first fine point of each window, in units of the spacing.
@group(0) @binding(1) var<storage, read> origins: array<vec2<i32>>;
@group(0) @binding(2) var<storage, read> coarse: array<i32>;
@group(0) @binding(3) var<storage, read_write> fine: array<i32>;

// Whether a thread may have points to write, for every start of the window in its first cell.
fn has_point(id: vec3<u32>) -> bool {
    return all(id.xy <= vec2<u32>(level.fine_width / 2u));
}

// Four coarse points. Those outside the window feed only fine points outside it, so any value will do.
fn coarse_points(window: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let last = vec4<i32>(i32(level.coarse_width) - 1);
    let rows = window * level.coarse_width + vec4<u32>(clamp(y, vec4<i32>(0), last));
    let at = rows * level.coarse_width + vec4<u32>(clamp(x, vec4<i32>(0), last));
    return vec4<i32>(coarse[at.x], coarse[at.y], coarse[at.z], coarse[at.w]);
}

// The random offsets of four fine points by their world coordinates, in units of the spacing.
fn offsets(range: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let words = threefry2x32(level.key, vec4<u32>(x) * level.spacing, vec4<u32>(y) * level.spacing);
    return height_offset(DISTRIBUTION, range, words);
}

// The heights of four points of the window after injection, given their places in the grid of features.
fn injected_four(window: u32, x: vec4<i32>, y: vec4<i32>, heights: vec4<i32>) -> vec4<i32> {
    var result = heights;
    if FEATURES != FEATURES_NONE {
        // A loop, because one driver's compiler takes gigabytes for branches that are inlined dozens of times.
        for (var lane = 0u; lane < 4u; lane++) {
            result[lane] = injected(level.features, window, vec2<i32>(x[lane], y[lane]), heights[lane]);
        }
    }
    return result;
}

// Stores a point, the one to its right, the one below it and the one diagonally below it, as far as they lie in the window.
fn store_four(window: u32, at: vec2<i32>, heights: vec4<i32>) {
    store(window, at, heights.x);
    store(window, at + vec2<i32>(1, 0), heights.y);
    store(window, at + vec2<i32>(0, 1), heights.z);
    store(window, at + vec2<i32>(1, 1), heights.w);
}

fn store(window: u32, at: vec2<i32>, height: i32) {
    let width = level.fine_width;
    if all(vec2<u32>(at) < vec2<u32>(width)) {
        fine[(window * width + u32(at.y)) * width + u32(at.x)] = height;
    }
}
