// One level of diamond-square subdivision for a batch of patches that are generated alone and whose neighbours
// wrap around (B section 3.3.1). A thread owns one coarse point and writes four samples: the point itself, and
// those to the right of it, below it and diagonally below it. Threads compute the three diamonds that they
// share a second time.
import package::wgsl::hash::threefry2x32;
import package::wgsl::terrain::fixed::mean_of_four;
import package::wgsl::terrain::offset::height_offset;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, injected};

// One of the constants OFFSET_*.
override DISTRIBUTION: u32 = 0u;
// Whether the coarse level consists of the four corners.
override FIRST: bool = false;

struct WrapLevel {
    // Heights of the corners (0, 0), (1, 0), (0, 1), (1, 1).
    corners: vec4<i32>,
    fine_features: FeatureGrid,
    base_features: FeatureGrid,
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

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= level.coarse_width {
        return;
    }
    let patch_index = id.z;
    let cell = vec2<i32>(id.xy);
    let cells = i32(level.coarse_width) - 1;
    // The cell before the first one is the last one, and the other way around.
    let own = cell % cells;
    let before = (cell + vec2<i32>(cells - 1)) % cells;
    let here = coarse_point(patch_index, cell);
    let right = coarse_point(patch_index, min(cell + vec2<i32>(1, 0), vec2<i32>(cells)));
    let below = coarse_point(patch_index, min(cell + vec2<i32>(0, 1), vec2<i32>(cells)));
    let centers = diamonds(patch_index, own, vec2<i32>(before.x, own.y), vec2<i32>(own.x, before.y));
    let squares = drawn(
        patch_index,
        vec4<i32>(2 * cell.x + 1, 2 * cell.x, 0, 0),
        vec4<i32>(2 * cell.y, 2 * cell.y + 1, 0, 0),
        mean_of_four(
            vec4<i32>(here), vec4<i32>(right, below, 0, 0),
            vec4<i32>(centers.x), vec4<i32>(centers.z, centers.y, 0, 0)));
    store(patch_index, 2 * cell, here);
    store(patch_index, 2 * cell + vec2<i32>(1, 0), squares.x);
    store(patch_index, 2 * cell + vec2<i32>(0, 1), squares.y);
    store(patch_index, 2 * cell + vec2<i32>(1, 1), centers.x);
}

// The centers of three cells.
fn diamonds(patch_index: u32, a: vec2<i32>, b: vec2<i32>, c: vec2<i32>) -> vec4<i32> {
    let top_left = corner_of_cells(patch_index, a, b, c, vec2<i32>(0, 0));
    let top_right = corner_of_cells(patch_index, a, b, c, vec2<i32>(1, 0));
    let bottom_left = corner_of_cells(patch_index, a, b, c, vec2<i32>(0, 1));
    let bottom_right = corner_of_cells(patch_index, a, b, c, vec2<i32>(1, 1));
    return drawn(
        patch_index,
        2 * vec4<i32>(a.x, b.x, c.x, 0) + vec4<i32>(1),
        2 * vec4<i32>(a.y, b.y, c.y, 0) + vec4<i32>(1),
        mean_of_four(top_left, top_right, bottom_left, bottom_right));
}

fn corner_of_cells(patch_index: u32, a: vec2<i32>, b: vec2<i32>, c: vec2<i32>, corner: vec2<i32>) -> vec4<i32> {
    return vec4<i32>(
        coarse_point(patch_index, a + corner), coarse_point(patch_index, b + corner),
        coarse_point(patch_index, c + corner), 0);
}

fn coarse_point(patch_index: u32, at: vec2<i32>) -> i32 {
    if FIRST {
        let height = level.corners[at.x + 2 * at.y];
        if FEATURES == FEATURES_NONE {
            return height;
        }
        return injected(level.base_features, patch_index, at, height);
    }
    return coarse[patch_index * level.coarse_points + u32(at.y) * level.coarse_width + u32(at.x)];
}

// Adds random offsets to means at fine samples (x[i], y[i]) and injects features.
fn drawn(patch_index: u32, x: vec4<i32>, y: vec4<i32>, means: vec4<i32>) -> vec4<i32> {
    let origin = vec2<u32>(origins[patch_index]);
    let edge = i32(level.fine_width) - 1;
    let world_x = origin.x + vec4<u32>(x % vec4<i32>(edge)) * level.fine_spacing;
    let world_y = origin.y + vec4<u32>(y % vec4<i32>(edge)) * level.fine_spacing;
    let words = threefry2x32(level.key, world_x, world_y);
    let heights = means + height_offset(DISTRIBUTION, level.range, words);
    if FEATURES == FEATURES_NONE {
        return heights;
    }
    return vec4<i32>(
        injected(level.fine_features, patch_index, vec2<i32>(x.x, y.x), heights.x),
        injected(level.fine_features, patch_index, vec2<i32>(x.y, y.y), heights.y),
        injected(level.fine_features, patch_index, vec2<i32>(x.z, y.z), heights.z),
        heights.w);
}

fn store(patch_index: u32, at: vec2<i32>, height: i32) {
    if all(vec2<u32>(at) < vec2<u32>(level.fine_width)) {
        fine[patch_index * level.fine_points + u32(at.y) * level.fine_width + u32(at.x)] = height;
    }
}
