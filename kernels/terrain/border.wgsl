// Thesis B's transition area (section 3.3.1): samples within `width` of a border move towards the existing patch on the other
// side of the border. The left and right borders are handled first, then the upper and lower borders on the result. A thread
// moves a sample. The thread's `id` has the sample's column, its row, and the patch among the patches of the dispatch.

// Whether the neighbours lie in `others`, a separate buffer of patches, instead of `heights`.
override OTHERS: bool = false;

// Parameters of the kernel `terrain/border`.
struct BorderParams {
    // Number of samples along an edge of a patch.
    size: u32,
    // Width of the transition area, in samples.
    width: u32,
    // Index of this dispatch's first entry in `order` and `neighbours`.
    start: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: BorderParams;
// Heights of all patches, row by row, in 1/65536 units.
@group(0) @binding(1) var<storage, read_write> heights: array<i32>;
// Per entry of `order`: the index of the patch to the left (x), to the right (y), above (z) and below (w). With `NONE`, the
// samples at this border do not move.
@group(0) @binding(2) var<storage, read> neighbours: array<vec4<u32>>;
// Indices of patches, dispatch by dispatch. The patches of one dispatch do not depend on each other.
@group(0) @binding(3) var<storage, read> order: array<u32>;
// Heights of the patches in the separate buffer, used with OTHERS.
@group(0) @binding(4) var<storage, read> others: array<i32>;

// Index of a neighbour that does not exist.
const NONE = 0xffffffffu;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    // Distances from the left, right, upper and lower border, in samples.
    let distances = vec4<u32>(id.x, params.size - 1u - id.x, id.y, params.size - 1u - id.y);
    let is_near = distances < vec4<u32>(params.width);
    if any(id.xy >= vec2<u32>(params.size)) || !any(is_near) {
        return;
    }
    let entry = params.start + id.z;
    let around = select(vec4<u32>(NONE), neighbours[entry], is_near);
    let at = sample_index(order[entry], id.x, id.y);
    // The neighbour's sample at the same distance on the other side of the border.
    let across = vec2<u32>(distances.y, id.y);
    let along = vec2<u32>(id.x, distances.w);
    var height = towards(heights[at], around.x, across, distances.x);
    height = towards(height, around.y, across, distances.y);
    height = towards(height, around.z, along, distances.z);
    heights[at] = towards(height, around.w, along, distances.w);
}

// Height blended linearly from the neighbour's height at distance 0 to the patch's own height at distance `width`.
fn towards(ours: i32, neighbour: u32, at: vec2<u32>, distance: u32) -> i32 {
    if neighbour == NONE {
        return ours;
    }
    let theirs = neighbour_height(sample_index(neighbour, at.x, at.y));
    let width = i32(params.width);
    let difference = ours - theirs;
    // The quotient is rounded down, so that the remainder is not negative.
    let truncated = difference / width;
    let quotient = truncated - select(0, 1, difference < truncated * width);
    let rest = difference - quotient * width;
    return theirs + quotient * i32(distance) + (rest * i32(distance) + width / 2) / width;
}

// Height of a sample in the buffer of the neighbours.
fn neighbour_height(index: u32) -> i32 {
    if OTHERS {
        return others[index];
    }
    return heights[index];
}

// Index of a sample of a patch, in column x and row y.
fn sample_index(patch_index: u32, x: u32, y: u32) -> u32 {
    return (patch_index * params.size + y) * params.size + x;
}
