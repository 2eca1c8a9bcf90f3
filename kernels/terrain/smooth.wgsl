// One level of smooth subdivision for a batch of windows of the plane: four-point interpolation (Dyn, Levin and Gregory 1987)
// in both directions, with random offsets. The first stage computes the centers of coarse cells. The second stage computes the
// points on edges from them, and writes all fine points of the window.
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, injected};
import package::wgsl::terrain::fixed::{four_point, limited, mean_of_two};
import package::wgsl::terrain::level::{coarse_points, has_point, level, offsets, origins, store_four};

// Stage of the kernel: one of the constants below.
override STAGE: u32 = 0u;

// Stage: a thread computes the center of a coarse cell.
const CENTERS: u32 = 0u;
// Stage: a thread writes the four fine points that belong to a coarse point.
const EDGES: u32 = 1u;

// Extra margin of this kernel's feature grids on every side, in points, compared with the kernel `terrain/height`. Edge points
// of a window depend on centers up to three points outside the window.
const FEATURE_SHIFT = 2;

// Heights at the centers of all windows' coarse cells, row by row, in 1/65536 units. Cell i lies between the coarse points i + 1
// and i + 2, in both directions. The first stage writes them; the second stage reads them.
@group(0) @binding(4) var<storage, read_write> centers: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if STAGE == CENTERS {
        if all(id.xy < vec2<u32>(center_width())) {
            centers[center_index(id.z, id.x, id.y)] = center_at(id.z, vec2<i32>(id.xy));
        }
    } else if has_point(id) {
        write_points(id.z, vec2<i32>(id.xy));
    }
}

// Number of centers along an edge of a window.
fn center_width() -> u32 {
    return level.coarse_width - 3u;
}

// Index of a cell's center.
fn center_index(window: u32, x: u32, y: u32) -> u32 {
    return (window * center_width() + y) * center_width() + x;
}

// Height of the center of a cell, from the 4 × 4 coarse points around it.
fn center_at(window: u32, cell: vec2<i32>) -> i32 {
    let rows = cell.y + vec4<i32>(0, 1, 2, 3);
    // Along each row, then across the rows.
    let along = four_point(
        coarse_points(window, vec4<i32>(cell.x), rows), coarse_points(window, vec4<i32>(cell.x + 1), rows),
        coarse_points(window, vec4<i32>(cell.x + 2), rows), coarse_points(window, vec4<i32>(cell.x + 3), rows));
    let height = four_point(along.xxxx, along.yyyy, along.zzzz, along.wwww);
    // The coarse window begins three coarse points before the coarse point at or before the first fine point.
    let at = 2 * (cell - 2) + 1 - (origins[window] & vec2<i32>(1));
    return drawn(window, level.range, at, height.x);
}

// Writes the fine points that belong to the coarse point of a thread: the point itself, the points on the edges to the right and
// below, and the center.
fn write_points(window: u32, thread: vec2<i32>) {
    let cell = thread + 3;
    let at = 2 * thread - (origins[window] & vec2<i32>(1));
    let steps = vec4<i32>(-1, 0, 1, 2);
    let row = coarse_points(window, cell.x + steps, cell.yyyy);
    let column = coarse_points(window, cell.xxxx, cell.y + steps);
    // Centers of the two cells before and the two after an edge.
    let beside_row = centers_at(window, cell.xxxx - 1, cell.y - 2 + steps);
    let beside_column = centers_at(window, cell.x - 2 + steps, cell.yyyy - 1);
    let middles = four_point(
        vec4<i32>(row.x, column.x, beside_row.x, beside_column.x), vec4<i32>(row.y, column.y, beside_row.y, beside_column.y),
        vec4<i32>(row.z, column.z, beside_row.z, beside_column.z), vec4<i32>(row.w, column.w, beside_row.w, beside_column.w));
    let edges = mean_of_two(middles.xyxy, middles.zwzw);
    let right = drawn(window, level.edge_range, at + vec2<i32>(1, 0), edges.x);
    let below = drawn(window, level.edge_range, at + vec2<i32>(0, 1), edges.y);
    store_four(window, at, vec4<i32>(row.y, right, below, beside_row.z));
}

// Heights at the centers of four cells.
fn centers_at(window: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    return vec4<i32>(
        centers[center_index(window, u32(x.x), u32(y.x))], centers[center_index(window, u32(x.y), u32(y.y))],
        centers[center_index(window, u32(x.z), u32(y.z))], centers[center_index(window, u32(x.w), u32(y.w))]);
}

// Adds a random offset to an interpolated height, and injects a feature. `at` is the position of the point in the window.
fn drawn(window: u32, range: u32, at: vec2<i32>, interpolated: i32) -> i32 {
    let world = origins[window] + at;
    var height = limited(vec4<i32>(interpolated)).x + offsets(range, world.xxxx, world.yyyy).x;
    if FEATURES != FEATURES_NONE {
        height = injected(level.features, window, at + FEATURE_SHIFT, height);
    }
    return limited(vec4<i32>(height)).x;
}
