// A level of subdivision for a batch of windows onto the plane: what its kernels read and write, the base lattice, and random
// offsets.
import package::wgsl::hash::threefry2x32;
import package::wgsl::terrain::blocks::Blocks;
import package::wgsl::terrain::offset::height_offset;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, feature_at, feature_bits, injected_lanes};

// Whether the coarse level is the base lattice, which is computed here and not loaded.
override FIRST: bool = false;
// One of the constants OFFSET_*.
override DISTRIBUTION: u32 = 0u;

struct Level {
    key: vec2<u32>,
    // Points along an edge of a window, and points per window.
    fine_width: u32,
    fine_points: u32,
    coarse_width: u32,
    coarse_points: u32,
    // World coordinates between neighbouring fine samples.
    fine_spacing: u32,
    fine_range: u32,
    // The range of offsets of the level between coarse and fine, if there is one.
    middle_range: u32,
    // The range of offsets of points on edges, where interpolation is smooth.
    edge_range: u32,
    base_range: u32,
    // Blocks of coarse cells.
    @align(16) blocks: Blocks,
    @align(16) fine_features: FeatureGrid,
    @align(16) base_features: FeatureGrid,
}

@group(0) @binding(0) var<uniform> level: Level;
// World coordinates of the first fine sample of each window, in units of fine_spacing.
@group(0) @binding(1) var<storage, read> origins: array<vec2<i32>>;
@group(0) @binding(2) var<storage, read> coarse: array<i32>;
@group(0) @binding(3) var<storage, read_write> fine: array<i32>;

// World coordinates of the fine columns of four cells: those of coarse points, and those between them.
struct Columns {
    even: vec4<u32>,
    odd: vec4<u32>,
}

// A window at one level.
struct Place {
    window: u32,
    // World coordinates of the window's first sample at this level, in units of spacing.
    origin: vec2<i32>,
    // How far before the window the sample at coarse point (0, 0) lies: one or two samples.
    shift: vec2<i32>,
    spacing: u32,
    range: u32,
}

const LANES = vec4<i32>(0, 1, 2, 3);

fn columns_of(place: Place, x: i32) -> Columns {
    let even = vec4<u32>(vec4<i32>(place.origin.x + 2 * x - place.shift.x) + 2 * LANES) * place.spacing;
    return Columns(even, even + vec4<u32>(place.spacing));
}

// The fine sample at a coarse point.
fn fine_at(place: Place, cell: vec2<i32>) -> vec2<i32> {
    return 2 * cell - place.shift;
}

fn offsets(place: Place, x: vec4<u32>, y: vec4<u32>) -> vec4<i32> {
    return height_offset(DISTRIBUTION, place.range, threefry2x32(level.key, x, y));
}

fn world_y(place: Place, at: vec2<i32>) -> vec4<u32> {
    return vec4<u32>(u32(place.origin.y + at.y) * place.spacing);
}

// Points outside the window feed only samples outside it, so any value will do.
fn loaded(place: Place, cell: vec2<i32>) -> i32 {
    let at = vec2<u32>(clamp(cell, vec2<i32>(0), vec2<i32>(i32(level.coarse_width) - 1)));
    return coarse[place.window * level.coarse_points + at.y * level.coarse_width + at.x];
}

// Four points of the base lattice, starting at coarse point `cell`.
fn base_points(place: Place, cell: vec2<i32>) -> vec4<i32> {
    let words = threefry2x32(level.key, columns_of(place, cell.x).even, world_y(place, fine_at(place, cell)));
    let heights = height_offset(DISTRIBUTION, level.base_range, words);
    if FEATURES == FEATURES_NONE {
        return heights;
    }
    var result = heights;
    for (var rest = feature_bits(level.base_features, place.window, cell) & 15u; rest != 0u; rest &= rest - 1u) {
        let column = i32(countTrailingZeros(rest));
        let feature = feature_at(level.base_features, place.window, cell + vec2<i32>(column, 0));
        result = injected_lanes(feature, LANES == vec4<i32>(column), result);
    }
    return result;
}

// Stores every other sample of a row.
fn store_four(place: Place, at: vec2<i32>, heights: vec4<i32>) {
    let row = place.window * level.fine_points + u32(at.y) * level.fine_width;
    // A row outside the window has no columns to store.
    let width = select(0u, level.fine_width, u32(at.y) < level.fine_width);
    let x = vec4<u32>(vec4<i32>(at.x) + 2 * LANES);
    store(row, width, x.x, heights.x);
    store(row, width, x.y, heights.y);
    store(row, width, x.z, heights.z);
    store(row, width, x.w, heights.w);
}

fn store(row: u32, width: u32, x: u32, height: i32) {
    if x < width {
        fine[row + x] = height;
    }
}
