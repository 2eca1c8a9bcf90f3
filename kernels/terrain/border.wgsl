// B's transition area (section 3.3.1): samples within `width` of a border move towards the patch that already
// exists on its other side. The left and right borders are handled first, then the upper and lower ones on
// their result.

// Whether the neighbours lie in `others`, a separate buffer of patches, and not in `heights`.
override OTHERS: bool = false;

struct BorderParams {
    size: u32,
    width: u32,
    points: u32,
    // Index of the first entry of this dispatch in `order` and `neighbours`.
    start: u32,
}

@group(0) @binding(0) var<uniform> params: BorderParams;
@group(0) @binding(1) var<storage, read_write> heights: array<i32>;
// The neighbours to the left, to the right, above and below each entry's patch; 0xffffffff where there is none
// to move towards.
@group(0) @binding(2) var<storage, read> neighbours: array<vec4<u32>>;
// Indices of patches, dispatch by dispatch. The patches of one dispatch do not depend on each other.
@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read> others: array<i32>;

const NONE = 0xffffffffu;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.size {
        return;
    }
    let entry = params.start + id.z;
    let patch_index = order[entry];
    let around = neighbours[entry];
    let x = id.x;
    let y = id.y;
    let last = params.size - 1u;
    let index = patch_index * params.points + y * params.size + x;
    var height = heights[index];
    height = towards(height, around.x, x, y * params.size + (last - x));
    height = towards(height, around.y, last - x, y * params.size + (last - x));
    height = towards(height, around.z, y, (last - y) * params.size + x);
    height = towards(height, around.w, last - y, (last - y) * params.size + x);
    heights[index] = height;
}

// Blends linearly from the neighbour's height at distance 0 to the patch's own at distance `width`.
fn towards(ours: i32, neighbour: u32, distance: u32, index: u32) -> i32 {
    if neighbour == NONE || distance >= params.width {
        return ours;
    }
    let theirs = sample_of(neighbour * params.points + index);
    let width = i32(params.width);
    let difference = ours - theirs;
    // Division rounds towards zero; the quotient must round down.
    var quotient = difference / width;
    var remainder = difference - quotient * width;
    if remainder < 0 {
        quotient -= 1;
        remainder += width;
    }
    let d = i32(distance);
    return theirs + quotient * d + (remainder * d + width / 2) / width;
}

fn sample_of(index: u32) -> i32 {
    if OTHERS {
        return others[index];
    }
    return heights[index];
}
