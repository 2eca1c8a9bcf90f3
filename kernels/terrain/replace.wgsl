// Replaces heights of regions by given ones. One thread handles one height.

// A height that is not given.
const NOT_GIVEN: i32 = -0x7fffffff;

// Parameters of the kernel `terrain/replace`.
struct ReplaceParams {
    // Number of heights along an edge of a region.
    width: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: ReplaceParams;
// The given heights of all regions, row by row, in 1/65536 world units; `NOT_GIVEN` where none is given.
@group(0) @binding(1) var<storage, read> given: array<i32>;
// Inout: heights of all regions, row by row.
@group(0) @binding(2) var<storage, read_write> heights: array<i32>;

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
