// One level of smooth subdivision for a batch of windows of the plane: four-point interpolation (Dyn, Levin and Gregory 1987)
// in both directions, with random offsets. The first stage computes the centers of coarse cells. The second stage computes the
// points on edges from them, and writes all fine points of the window. A thread goes down `ROWS` rows, which share most of the points
// that they are interpolated from.
import package::wgsl::terrain::fixed::{four_point, limited, mean_of_two};
import package::wgsl::terrain::level::{coarse_points, injected_four, level, offsets, origins, store_four};

// Stage of the kernel: one of the constants below.
override STAGE: u32 = 0u;

// Stage: a thread computes the centers of coarse cells.
const CENTERS: u32 = 0u;
// Stage: a thread writes the fine points that belong to coarse points, four for each.
const EDGES: u32 = 1u;

// Number of coarse cells or points of a thread, one below the other: one for each component of a vector.
const ROWS: u32 = 4u;

// Extra margin of this kernel's feature grids on every side, in points, compared with the kernel `terrain/height`. Edge points
// of a window depend on centers up to three points outside the window.
const FEATURE_SHIFT = 2;

// Heights at the centers of all windows' coarse cells, row by row, in 1/65536 units. Cell i lies between the coarse points i + 1
// and i + 2, in both directions. The first stage writes them; the second stage reads them.
@group(0) @binding(4) var<storage, read_write> centers: array<i32>;

@compute @workgroup_size(16, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(vec2<u32>(id.x, ROWS * id.y));
    if STAGE == CENTERS {
        write_centers(id.z, at);
    } else if id.x <= level.fine_width / 2u {
        write_points(id.z, at);
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

// Writes the heights of the centers of four cells, the first of them `cell`, each from the 4 × 4 coarse points around it.
fn write_centers(window: u32, cell: vec2<i32>) {
    let rows = cell.y + vec4<i32>(0, 1, 2, 3);
    // Along each row, then across the rows.
    let first = along_rows(window, cell.x, rows);
    let second = along_rows(window, cell.x, rows + 4);
    let heights = four_point(
        first, vec4<i32>(first.yzw, second.x), vec4<i32>(first.zw, second.xy), vec4<i32>(first.w, second.xyz));
    // The coarse window begins three coarse points before the coarse point at or before the first fine point.
    let shift = origins[window] & vec2<i32>(1);
    let drawn_heights = drawn(window, level.range, vec4<i32>(2 * (cell.x - 2) + 1 - shift.x), 2 * (rows - 2) + 1 - shift.y, heights);
    for (var row = 0u; row < ROWS; row++) {
        let at = vec2<u32>(u32(cell.x), u32(cell.y) + row);
        if all(at < vec2<u32>(center_width())) {
            centers[center_index(window, at.x, at.y)] = drawn_heights[row];
        }
    }
}

// Heights halfway between the second and the third of four coarse points of each row, the first in the column `x`.
fn along_rows(window: u32, x: i32, rows: vec4<i32>) -> vec4<i32> {
    return four_point(
        coarse_points(window, vec4<i32>(x), rows), coarse_points(window, vec4<i32>(x + 1), rows),
        coarse_points(window, vec4<i32>(x + 2), rows), coarse_points(window, vec4<i32>(x + 3), rows));
}

// Writes the fine points of four coarse points of a column, from `thread` on. A coarse point has four fine points: itself, those on the
// edges to the right and below, and the center.
fn write_points(window: u32, thread: vec2<i32>) {
    let shift = origins[window] & vec2<i32>(1);
    let x = vec4<i32>(thread.x + 3);
    let y = thread.y + 3 + vec4<i32>(0, 1, 2, 3);
    // The coarse points of the column from the row above, and centers of the cells to the right of it.
    let column = coarse_points(window, x, y - 1);
    let column_below = coarse_points(window, x, y + 3);
    let middle = centers_at(window, x - 1, y - 3);
    let middle_below = centers_at(window, x - 1, y + 1);
    let own = vec4<i32>(column.yzw, column_below.x);
    let center = vec4<i32>(middle.zw, middle_below.xy);
    // An edge lies between two coarse points of its line, and between two centers across it.
    let right = mean_of_two(
        four_point(coarse_points(window, x - 1, y), own, coarse_points(window, x + 1, y), coarse_points(window, x + 2, y)),
        four_point(middle, vec4<i32>(middle.yzw, middle_below.x), center, vec4<i32>(middle.w, middle_below.xyz)));
    let below = mean_of_two(
        four_point(column, own, vec4<i32>(column.zw, column_below.xy), vec4<i32>(column.w, column_below.xyz)),
        four_point(centers_at(window, x - 3, y - 1), centers_at(window, x - 2, y - 1), center, centers_at(window, x, y - 1)));
    let at_x = vec4<i32>(2 * thread.x - shift.x);
    let at_y = 2 * (thread.y + vec4<i32>(0, 1, 2, 3)) - shift.y;
    let drawn_right = drawn(window, level.edge_range, at_x + 1, at_y, right);
    let drawn_below = drawn(window, level.edge_range, at_x, at_y + 1, below);
    for (var row = 0u; row < ROWS; row++) {
        let heights = vec4<i32>(own[row], drawn_right[row], drawn_below[row], center[row]);
        store_four(window, vec2<i32>(at_x.x, at_y[row]), heights);
    }
}

// Heights at the centers of four cells. Cells outside the window may get any value, because they feed only fine points outside the
// window.
fn centers_at(window: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let rows = min(vec4<u32>(y), vec4<u32>(center_width() - 1u));
    return vec4<i32>(
        centers[center_index(window, u32(x.x), rows.x)], centers[center_index(window, u32(x.y), rows.y)],
        centers[center_index(window, u32(x.z), rows.z)], centers[center_index(window, u32(x.w), rows.w)]);
}

// Adds random offsets to four interpolated heights, and injects features. (x, y) are the positions of the points in the window.
fn drawn(window: u32, range: u32, x: vec4<i32>, y: vec4<i32>, interpolated: vec4<i32>) -> vec4<i32> {
    let origin = origins[window];
    let heights = limited(interpolated) + offsets(range, origin.x + x, origin.y + y);
    return limited(injected_four(window, x + FEATURE_SHIFT, y + FEATURE_SHIFT, heights));
}
