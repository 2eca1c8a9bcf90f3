// Heights of regions that are cut from eroded ones and kept within a distance of the heights before erosion. One thread handles
// one height.

// Parameters of the kernel `terrain/limit`.
struct LimitParams {
    // Number of heights along an edge of a region.
    width: u32,
    // Number of heights in a row of the eroded ones.
    eroded_width: u32,
    // Largest distance, in 1/65536 units.
    most: i32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: LimitParams;
// Heights of all regions before erosion, row by row, in 1/65536 units.
@group(0) @binding(1) var<storage, read> origins: array<i32>;
// Eroded heights.
@group(0) @binding(2) var<storage, read> eroded: array<i32>;
// For each region, the index of its first height among the eroded ones.
@group(0) @binding(3) var<storage, read> corners: array<u32>;
// Out: heights of all regions, row by row.
@group(0) @binding(4) var<storage, read_write> heights: array<i32>;

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
