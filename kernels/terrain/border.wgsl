// B's transition area (section 3.3.1): samples within `width` of a border move towards the patch that
// already exists on its other side. Left and right first, then above and below on the result.

// Whether the neighbours lie in `others`, a buffer of patches apart from `heights`.
override OTHERS: bool = false;

struct BorderParams {
    size: u32,
    width: u32,
    points: u32,
    // The first of this dispatch's entries in `order` and `neighbours`.
    start: u32,
}

@group(0) @binding(0) var<uniform> params: BorderParams;
@group(0) @binding(1) var<storage, read_write> heights: array<i32>;
// Left, right, above and below of each entry's patch; 0xffffffff where there is none to move towards.
@group(0) @binding(2) var<storage, read> neighbours: array<vec4<u32>>;
// Patches, dispatch by dispatch: those of one do not depend on each other.
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

// The neighbour's height at distance 0, ours at distance `width`.
fn towards(ours: i32, neighbour: u32, distance: u32, index: u32) -> i32 {
    if neighbour == NONE || distance >= params.width {
        return ours;
    }
    let theirs = sample_of(neighbour * params.points + index);
    let width = i32(params.width);
    let difference = ours - theirs;
    // Division rounds towards zero; the quotient here rounds down.
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
