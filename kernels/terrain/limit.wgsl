// Keeps eroded heights within a distance of the heights before erosion. One thread handles one height.

// Parameters of the kernel `terrain/limit`.
struct LimitParams {
    // Number of heights.
    points: u32,
    // Largest distance, in 1/65536 units.
    most: i32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: LimitParams;
// Heights before erosion, in 1/65536 units.
@group(0) @binding(1) var<storage, read> origins: array<i32>;
// Inout: eroded heights.
@group(0) @binding(2) var<storage, read_write> heights: array<i32>;

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
    let origin = origins[index];
    heights[index] = origin + clamp(heights[index] - origin, -params.most, params.most);
}
