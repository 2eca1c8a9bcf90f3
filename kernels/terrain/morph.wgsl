// Blend of two height fields (thesis B section 4.4, targetHeight): from + floor((to - from) * time), in integers. A thread
// computes four samples.

// Parameters of the kernel `terrain/morph`.
struct MorphParams {
    // Number of vectors of four heights.
    vectors: u32,
    // Time of the blend: 0 (start heights) to 65536 (target heights).
    time: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: MorphParams;
// Heights at time 0, in 1/65536 units.
@group(0) @binding(1) var<storage, read> start_heights: array<vec4<i32>>;
// Heights at time 65536, in 1/65536 units.
@group(0) @binding(2) var<storage, read> target_heights: array<vec4<i32>>;
// Out: blended heights. The last vector may extend past the last height, into the padding of the buffers.
@group(0) @binding(3) var<storage, read_write> heights: array<vec4<i32>>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index >= params.vectors {
        return;
    }
    let start = start_heights[index];
    let difference = target_heights[index] - start;
    // The 48-bit product, computed from the two halves of the difference.
    let high = (difference >> vec4<u32>(16u)) * i32(params.time);
    let low = (vec4<u32>(difference) & vec4<u32>(0xffffu)) * params.time;
    heights[index] = start + high + vec4<i32>(low >> vec4<u32>(16u));
}
