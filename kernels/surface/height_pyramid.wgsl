// One level of the max-mip pyramids of a batch of height maps (thesis B section 2.3.4). A leaf has the height of the highest
// corner of a bilinear cell. Any other node has the largest height of its four children. A thread computes a node.
import package::wgsl::dispatch::nonuniform;
import package::wgsl::surface::atlas::{surface_atlas_at, surface_corner_index};

// Parameters of the kernel `surface/height_pyramid`.
struct PyramidParams {
    // Number of texels of a map along x and y.
    size: vec2<u32>,
    // Number of cells of a map along x and y.
    cells: vec2<u32>,
    // Number of nodes per row of one map's pyramid.
    pitch: u32,
    // Number of rows of one map's pyramid.
    rows: u32,
    // Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    address: u32,
    // Level that is written; level 0 has the leaves.
    level: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: PyramidParams;
// Heights of all maps, row by row, 0 to 1.
@group(0) @binding(1) var<storage, read> heights: array<f32>;
// Max-mip pyramids of all maps.
@group(0) @binding(2) var<storage, read_write> pyramids: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= nodes(params.level)) {
        return;
    }
    let at = vec2<i32>(id.xy);
    var four: vec4<f32>;
    if nonuniform(params.level, id.x) == 0u {
        four = vec4<f32>(
            corner(id.z, at), corner(id.z, at + vec2<i32>(1, 0)),
            corner(id.z, at + vec2<i32>(0, 1)), corner(id.z, at + vec2<i32>(1, 1)));
    } else {
        four = vec4<f32>(
            child(id.z, 2 * at), child(id.z, 2 * at + vec2<i32>(1, 0)),
            child(id.z, 2 * at + vec2<i32>(0, 1)), child(id.z, 2 * at + vec2<i32>(1, 1)));
    }
    pyramids[place(id.z, params.level, at)] = max(max(four.x, four.y), max(four.z, four.w));
}

// Number of nodes of a level along x and y.
fn nodes(level: u32) -> vec2<u32> {
    return (params.cells + (vec2<u32>(1u) << vec2<u32>(level)) - 1u) >> vec2<u32>(level);
}

// Index in `pyramids` of a node of a map.
fn place(map: u32, level: u32, at: vec2<i32>) -> u32 {
    let texel = vec2<u32>(surface_atlas_at(params.cells, level, at));
    return (map * params.rows + texel.y) * params.pitch + texel.x;
}

// Height at the first corner of a cell.
fn corner(map: u32, at: vec2<i32>) -> f32 {
    return heights[surface_corner_index(params.size, params.address, map, at)];
}

// Height of a node of the next finer level. The index is clamped to the edge, which does not change the maximum.
fn child(map: u32, at: vec2<i32>) -> f32 {
    let level = params.level - 1u;
    return pyramids[place(map, level, min(at, vec2<i32>(nodes(level)) - 1))];
}
