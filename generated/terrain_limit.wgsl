// relievo terrain/limit: generated from kernels/terrain/limit.wgsl

struct LimitParams {
    width: u32,
    eroded_width: u32,
    most: i32
}

@group(0) @binding(0)
var<uniform> params: LimitParams;

@group(0) @binding(1)
var<storage, read> origins: array<i32>;

@group(0) @binding(2)
var<storage, read> eroded: array<i32>;

@group(0) @binding(3)
var<storage, read> corners: array<u32>;

@group(0) @binding(4)
var<storage, read_write> heights: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2<u32>(params.width)) {
        return;
    }
    let index = (id.z * params.width + id.y) * params.width + id.x;
    let origin = origins[index];
    let moved = eroded[corners[id.z] + id.y * params.eroded_width + id.x] - origin;
    heights[index] = origin + clamp(moved, -params.most, params.most);
}
