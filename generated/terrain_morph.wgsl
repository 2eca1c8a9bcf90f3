// relievo terrain/morph: generated from kernels/terrain/morph.wgsl

struct MorphParams {
    vectors: u32,
    time: u32
}

@group(0) @binding(0)
var<uniform> params: MorphParams;

@group(0) @binding(1)
var<storage, read> start_heights: array<vec4<i32>>;

@group(0) @binding(2)
var<storage, read> target_heights: array<vec4<i32>>;

@group(0) @binding(3)
var<storage, read_write> heights: array<vec4<i32>>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index >= params.vectors {
        return;
    }
    let start = start_heights[index];
    let difference = target_heights[index] - start;
    let high = (difference >> vec4<u32>(16u)) * i32(params.time);
    let low = (vec4<u32>(difference) & vec4<u32>(65535u)) * params.time;
    heights[index] = start + high + vec4<i32>(low >> vec4<u32>(16u));
}
