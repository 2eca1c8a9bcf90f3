// A level of the max-mip pyramids of a batch of height maps (B section 2.3.4). A leaf is the highest corner of a bilinear cell,
// and a node the highest of its four children. A thread computes a node.
import package::wgsl::surface::atlas::{surface_atlas_at, surface_corner_index};

struct PyramidParams {
    // Texels of a map along x and y.
    size: vec2<u32>,
    // Cells of a map along x and y.
    cells: vec2<u32>,
    // Nodes per row of the plane of one map's pyramid.
    pitch: u32,
    // Rows of the plane of one map's pyramid.
    rows: u32,
    address: u32,
    // The level that is written; 0 has the leaves.
    level: u32,
}

@group(0) @binding(0) var<uniform> params: PyramidParams;
@group(0) @binding(1) var<storage, read> heights: array<f32>;
@group(0) @binding(2) var<storage, read_write> pyramids: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= nodes(params.level)) {
        return;
    }
    let at = vec2<i32>(id.xy);
    var four: vec4<f32>;
    if params.level == 0u {
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

// Nodes of a level along x and y.
fn nodes(level: u32) -> vec2<u32> {
    return (params.cells + (vec2<u32>(1u) << vec2<u32>(level)) - 1u) >> vec2<u32>(level);
}

fn place(map: u32, level: u32, at: vec2<i32>) -> u32 {
    let texel = vec2<u32>(surface_atlas_at(params.cells, level, at));
    return (map * params.rows + texel.y) * params.pitch + texel.x;
}

fn corner(map: u32, at: vec2<i32>) -> f32 {
    return heights[surface_corner_index(params.size, params.address, map, at)];
}

// A node of the next finer level, clamped to the edge, which does not change the maximum.
fn child(map: u32, at: vec2<i32>) -> f32 {
    let level = params.level - 1u;
    return pyramids[place(map, level, min(at, vec2<i32>(nodes(level)) - 1))];
}
