// relievo terrain/border: generated from kernels/terrain/border.wgsl

override OTHERS: bool = false;

struct BorderParams {
    size: u32,
    width: u32,
    start: u32
}

@group(0) @binding(0)
var<uniform> params: BorderParams;

@group(0) @binding(1)
var<storage, read_write> heights: array<i32>;

@group(0) @binding(2)
var<storage, read> neighbours: array<vec4<u32>>;

@group(0) @binding(3)
var<storage, read> order: array<u32>;

@group(0) @binding(4)
var<storage, read> others: array<i32>;

const NONE = 4294967295u;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let distances = vec4<u32>(id.x, params.size - 1u - id.x, id.y, params.size - 1u - id.y);
    let is_near = distances < vec4<u32>(params.width);
    if any(id.xy >= vec2<u32>(params.size)) || !any(is_near) {
        return;
    }
    let entry = params.start + id.z;
    let around = select(vec4<u32>(NONE), neighbours[entry], is_near);
    let at = sample_index(order[entry], id.x, id.y);
    let across = vec2<u32>(distances.y, id.y);
    let along = vec2<u32>(id.x, distances.w);
    var height = towards(heights[at], around.x, across, distances.x);
    height = towards(height, around.y, across, distances.y);
    height = towards(height, around.z, along, distances.z);
    heights[at] = towards(height, around.w, along, distances.w);
}

fn towards(ours: i32, neighbour: u32, at: vec2<u32>, distance: u32) -> i32 {
    if neighbour == NONE {
        return ours;
    }
    let theirs = neighbour_height(sample_index(neighbour, at.x, at.y));
    let width = i32(params.width);
    let difference = ours - theirs;
    let truncated = difference / width;
    let quotient = truncated - select(0, 1, difference < truncated * width);
    let rest = difference - quotient * width;
    return theirs + quotient * i32(distance) + (rest * i32(distance) + width / 2) / width;
}

fn neighbour_height(index: u32) -> i32 {
    if OTHERS {
        return others[index];
    }
    return heights[index];
}

fn sample_index(patch_index: u32, x: u32, y: u32) -> u32 {
    return (patch_index * params.size + y) * params.size + x;
}
