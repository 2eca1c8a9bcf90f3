// One level of diamond-square subdivision for a batch of windows of the plane (thesis B section 3.3.1). A thread recomputes the
// centers to the left of its coarse point and above it. Threads therefore need no barrier, and a level is one dispatch.
import package::wgsl::terrain::fixed::mean_of_four;
import package::wgsl::terrain::level::{coarse_points, has_point, injected_four, level, offsets, origins, store_four};

@compute @workgroup_size(16, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !has_point(id) {
        return;
    }
    let window = id.z;
    // The coarse window begins one or two fine points before the fine window.
    let shift = 2 - (origins[window] & vec2<i32>(1));
    let cell = vec2<i32>(id.xy) + shift - 1;
    let at = 2 * cell - shift;
    // Centers of three cells: the cell whose first corner is the coarse point, the cell to its left, and the cell above.
    let x = cell.x - vec4<i32>(0, 1, 0, 0);
    let y = cell.y - vec4<i32>(0, 0, 1, 0);
    let centers = drawn(window, 2 * x - shift.x + 1, 2 * y - shift.y + 1, mean_of_four(
        coarse_points(window, x, y), coarse_points(window, x + 1, y),
        coarse_points(window, x, y + 1), coarse_points(window, x + 1, y + 1)));
    // The coarse point, its right neighbour, and its lower neighbour.
    let corners = coarse_points(window, cell.x + vec4<i32>(0, 1, 0, 0), cell.y + vec4<i32>(0, 0, 1, 0));
    // Midpoints of the edges to the right and downwards: each is the mean of two coarse points and two centers.
    let edges = drawn(window, at.x + vec4<i32>(1, 0, 0, 0), at.y + vec4<i32>(0, 1, 0, 0), mean_of_four(
        vec4<i32>(corners.x), corners.yzzz, centers.zyyy, vec4<i32>(centers.x)));
    store_four(window, at, vec4<i32>(corners.x, edges.x, edges.y, centers.x));
}

// Adds random offsets to four means, and injects features. (x, y) are the positions of the points in the window.
fn drawn(window: u32, x: vec4<i32>, y: vec4<i32>, means: vec4<i32>) -> vec4<i32> {
    let origin = origins[window];
    return injected_four(window, x, y, means + offsets(level.range, origin.x + x, origin.y + y));
}
