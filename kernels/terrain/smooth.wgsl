// One level of smooth subdivision for a batch of windows onto the plane: four-point interpolation (Dyn, Levin and Gregory 1987)
// in both directions, with random offsets. A thread computes the centers of the cells around its coarse point that the points
// on edges depend on, so that threads need no barrier and a level is one dispatch.
import package::wgsl::terrain::fixed::{four_point, limited, mean_of_two};
import package::wgsl::terrain::level::{coarse_points, injected_four, level, offsets, origins, store_four};
import package::wgsl::terrain::points::{Thread, point_of};

// The features of a level are listed for two points more on every side than those of `terrain/height`: centers up to
// three points outside of a window belong to its edges.
const FEATURE_SHIFT = 2;

@compute @workgroup_size(64)
fn main(thread: Thread) {
    // A window may start anywhere in its first cell.
    let point = point_of(level.fine_width / 2u + 1u, level.count, thread);
    if !point.there {
        return;
    }
    let window = point.field;
    // The coarse window begins three points before the one at its first sample or the one before that.
    let cell = vec2<i32>(point.at) + 3;
    let at = 2 * vec2<i32>(point.at) - (origins[window] & vec2<i32>(1));
    // Of each of seven rows the point in the own column, and the values in the middle of cells, from two before the own one to
    // the next after it.
    var own: array<i32, 7>;
    var along: array<vec4<i32>, 7>;
    for (var row = 0; row < 7; row++) {
        let y = vec4<i32>(cell.y + row - 3);
        let left = coarse_points(window, cell.x + vec4<i32>(-3, -2, -1, 0), y);
        own[row] = left.w;
        along[row] = between(left, coarse_points(window, cell.x + vec4<i32>(1, 2, 3, 3), y));
    }
    // The centers of the cells from two before the own one to the next after it, in its column and in its row.
    let steps = vec4<i32>(-3, -1, 1, 3);
    let column = drawn(window, level.range, vec4<i32>(at.x + 1), at.y + steps, between(
        vec4<i32>(along[0].z, along[1].z, along[2].z, along[3].z), vec4<i32>(along[4].z, along[5].z, along[6].zz)));
    let across = drawn(window, level.range, at.x + steps, vec4<i32>(at.y + 1), four_point(
        along[2], along[3], along[4], along[5]));
    // Between the four centers of the column, the four points of the own column, and the four centers of the row.
    let middles = four_point(
        vec4<i32>(column.x, own[2], across.xx), vec4<i32>(column.y, own[3], across.yy),
        vec4<i32>(column.z, own[4], across.zz), vec4<i32>(column.w, own[5], across.ww));
    let edges = drawn(window, level.edge_range, at.x + vec4<i32>(1, 0, 0, 0), at.y + vec4<i32>(0, 1, 0, 0), mean_of_two(
        vec4<i32>(along[3].z, middles.yyy), middles.xzzz));
    store_four(window, at, vec4<i32>(own[3], edges.x, edges.y, across.z));
}

// The values between every four of seven; the last lane of `after` does not count.
fn between(before: vec4<i32>, after: vec4<i32>) -> vec4<i32> {
    return four_point(
        before, vec4<i32>(before.yzw, after.x), vec4<i32>(before.zw, after.xy), vec4<i32>(before.w, after.xyz));
}

// Adds random offsets to four interpolated heights, and injects features; (x, y) are places in the window.
fn drawn(window: u32, range: u32, x: vec4<i32>, y: vec4<i32>, interpolated: vec4<i32>) -> vec4<i32> {
    let origin = origins[window];
    let heights = limited(interpolated) + offsets(range, origin.x + x, origin.y + y);
    return limited(injected_four(window, x + FEATURE_SHIFT, y + FEATURE_SHIFT, heights));
}
