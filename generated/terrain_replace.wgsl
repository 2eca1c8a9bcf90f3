// relievo terrain/replace: generated from kernels/terrain/replace.wgsl

const NOT_GIVEN: i32 = -2147483647;

struct ReplaceParams {
    width: u32
}

@group(0) @binding(0)
var<uniform> params: ReplaceParams;

@group(0) @binding(1)
var<storage, read> given: array<i32>;

@group(0) @binding(2)
var<storage, read_write> heights: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2<u32>(params.width)) {
        return;
    }
    let at = (id.z * params.width + id.y) * params.width + id.x;
    let height = given[at];
    if height != NOT_GIVEN {
        heights[at] = height;
    }
}
