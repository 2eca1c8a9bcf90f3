// Copies 16 bytes per thread. The kernel's time is the cost of moving bytes alone. Other kernels are compared with it.

// Parameters of the kernel `baseline/copy`.
struct CopyParams {
    // Number of 16-byte vectors.
    vectors: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: CopyParams;
// Vectors to copy.
@group(0) @binding(1) var<storage, read> source: array<vec4<u32>>;
// Out: the copied vectors.
@group(0) @binding(2) var<storage, read_write> destination: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index < params.vectors {
        destination[index] = source[index];
    }
}
