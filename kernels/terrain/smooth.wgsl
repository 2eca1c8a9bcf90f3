// One level of smooth subdivision for a batch of windows of the plane: four-point interpolation (Dyn, Levin and Gregory 1987)
// in both directions, with random offsets. A thread computes all centers on which its edge points depend, in the cells around
// its coarse point. Threads therefore need no barrier, and a level is one dispatch.
import package::wgsl::terrain::fixed::{four_point, limited, mean_of_two};
import package::wgsl::terrain::level::{coarse_points, has_point, injected_four, level, offsets, origins, store_four};

// Extra margin of this kernel's feature grids on every side, in points, compared with the kernel `terrain/height`. Edge points
// of a window depend on centers up to three points outside the window.
const FEATURE_SHIFT = 2;

// Heights along a row of coarse points, around one of the points.
struct Row {
    // Height of the point itself.
    own: i32,
    // Interpolated heights at the middles of four cells, whose columns relative to the own cell are -2, -1, 0 and 1.
    along: vec4<i32>,
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !has_point(id) {
        return;
    }
    let window = id.z;
    // The coarse window begins three coarse points before the coarse point at the fine window's first sample. If no coarse
    // point is at this sample, the last coarse point before the sample takes its place.
    let cell = vec2<i32>(id.xy) + 3;
    let at = 2 * vec2<i32>(id.xy) - (origins[window] & vec2<i32>(1));
    // Coarse rows from three above the own row to three below.
    let a = row_of(window, cell - vec2<i32>(0, 3));
    let b = row_of(window, cell - vec2<i32>(0, 2));
    let c = row_of(window, cell - vec2<i32>(0, 1));
    let d = row_of(window, cell);
    let e = row_of(window, cell + vec2<i32>(0, 1));
    let f = row_of(window, cell + vec2<i32>(0, 2));
    let g = row_of(window, cell + vec2<i32>(0, 3));
    // Centers of four cells in the own cell's column, and in its row. Their positions relative to the own cell: -2, -1, 0, 1.
    let steps = vec4<i32>(-3, -1, 1, 3);
    let column = drawn(window, level.range, vec4<i32>(at.x + 1), at.y + steps, between(
        vec4<i32>(a.along.z, b.along.z, c.along.z, d.along.z), vec4<i32>(e.along.z, f.along.z, g.along.zz)));
    let across = drawn(window, level.range, at.x + steps, vec4<i32>(at.y + 1), four_point(
        c.along, d.along, e.along, f.along));
    // Values interpolated between four points. Lane x: the centers of the column. Lane y: the coarse points of the own column.
    // Other lanes: the centers of the row.
    let middles = four_point(
        vec4<i32>(column.x, c.own, across.xx), vec4<i32>(column.y, d.own, across.yy),
        vec4<i32>(column.z, e.own, across.zz), vec4<i32>(column.w, f.own, across.ww));
    let edges = drawn(window, level.edge_range, at.x + vec4<i32>(1, 0, 0, 0), at.y + vec4<i32>(0, 1, 0, 0), mean_of_two(
        vec4<i32>(d.along.z, middles.yyy), middles.xzzz));
    store_four(window, at, vec4<i32>(d.own, edges.x, edges.y, across.z));
}

// The coarse row around a point, with interpolated heights.
fn row_of(window: u32, cell: vec2<i32>) -> Row {
    let y = vec4<i32>(cell.y);
    let before = coarse_points(window, cell.x + vec4<i32>(-3, -2, -1, 0), y);
    return Row(before.w, between(before, coarse_points(window, cell.x + vec4<i32>(1, 2, 3, 3), y)));
}

// Four interpolated values from seven consecutive values. Each lies between the middle two of four consecutive values. The last
// lane of `after` is unused.
fn between(before: vec4<i32>, after: vec4<i32>) -> vec4<i32> {
    return four_point(
        before, vec4<i32>(before.yzw, after.x), vec4<i32>(before.zw, after.xy), vec4<i32>(before.w, after.xyz));
}

// Adds random offsets to four interpolated heights, and injects features. (x, y) are the positions of the points in the window.
fn drawn(window: u32, range: u32, x: vec4<i32>, y: vec4<i32>, interpolated: vec4<i32>) -> vec4<i32> {
    let origin = origins[window];
    let heights = limited(interpolated) + offsets(range, origin.x + x, origin.y + y);
    return limited(injected_four(window, x + FEATURE_SHIFT, y + FEATURE_SHIFT, heights));
}
