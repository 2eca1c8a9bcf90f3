// A blend of two height fields (B section 4.4, targetHeight): from + floor((to - from) * time), in integers.

struct MorphParams {
    points: u32,
    // The time, 0 to 65536.
    time: u32,
}

@group(0) @binding(0) var<uniform> params: MorphParams;
@group(0) @binding(1) var<storage, read> start_heights: array<i32>;
@group(0) @binding(2) var<storage, read> target_heights: array<i32>;
@group(0) @binding(3) var<storage, read_write> heights: array<i32>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index >= params.points {
        return;
    }
    let difference = target_heights[index] - start_heights[index];
    // The 48-bit product, computed from the two halves of the difference.
    let high = (difference >> 16u) * i32(params.time);
    let low = (u32(difference) & 0xffffu) * params.time;
    heights[index] = start_heights[index] + high + i32(low >> 16u);
}
