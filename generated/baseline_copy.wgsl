// relievo baseline/copy: generated from kernels/baseline/copy.wgsl

struct CopyParams {
    vectors: u32
}

@group(0) @binding(0)
var<uniform> params: CopyParams;

@group(0) @binding(1)
var<storage, read> source: array<vec4<u32>>;

@group(0) @binding(2)
var<storage, read_write> destination: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index < params.vectors {
        destination[index] = source[index];
    }
}
