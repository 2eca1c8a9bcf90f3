// One level of diamond-square subdivision for a batch of patches that are generated alone, with neighbours that wrap around
// (thesis B section 3.3.1). A thread recomputes the centers to the left of its coarse point and above it.
import package::wgsl::terrain::fixed::mean_of_four;
import package::wgsl::terrain::level::{coarse_points, has_point, injected_four, level, offsets, origins, store_four};

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !has_point(id) {
        return;
    }
    let patch_index = id.z;
    let at = vec2<i32>(id.xy);
    // The number of cells along an edge is a power of two. The first cell follows the last one.
    let mask = i32(level.coarse_width) - 2;
    let cell = at & vec2<i32>(mask);
    let before = (at + mask) & vec2<i32>(mask);
    // Centers of three cells: the cell whose first corner is the coarse point, the cell to its left, and the cell above.
    let x = vec4<i32>(cell.x, before.x, cell.x, cell.x);
    let y = vec4<i32>(cell.y, cell.y, before.y, cell.y);
    let centers = drawn(patch_index, 2 * x + 1, 2 * y + 1, mean_of_four(
        coarse_points(patch_index, x, y), coarse_points(patch_index, x + 1, y),
        coarse_points(patch_index, x, y + 1), coarse_points(patch_index, x + 1, y + 1)));
    // The coarse point, its right neighbour, and its lower neighbour.
    let corners = coarse_points(patch_index, at.x + vec4<i32>(0, 1, 0, 0), at.y + vec4<i32>(0, 0, 1, 0));
    // The midpoints of the edges to the right and downwards: each is the mean of two coarse points and two centers.
    let edges = drawn(patch_index, 2 * at.x + vec4<i32>(1, 0, 0, 0), 2 * at.y + vec4<i32>(0, 1, 0, 0), mean_of_four(
        vec4<i32>(corners.x), corners.yzzz, centers.zyyy, vec4<i32>(centers.x)));
    store_four(patch_index, 2 * at, vec4<i32>(corners.x, edges.x, edges.y, centers.x));
}

// Adds random offsets to four means, and injects features. (x, y) are the positions of the points in the patch. The patch's
// last row and column have the world coordinates of the first row and column.
fn drawn(patch_index: u32, x: vec4<i32>, y: vec4<i32>, means: vec4<i32>) -> vec4<i32> {
    let origin = origins[patch_index];
    let mask = vec4<i32>(i32(level.fine_width) - 2);
    return injected_four(patch_index, x, y, means + offsets(level.range, origin.x + (x & mask), origin.y + (y & mask)));
}
