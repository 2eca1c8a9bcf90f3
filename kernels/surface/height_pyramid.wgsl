// Max-mip pyramids of a batch of height maps (B section 2.3.4). A leaf is the highest corner of a bilinear cell, a
// node the highest of its four children. FROM_HEIGHTS makes levels 0, 1 and 2; without it, levels `level` + 1 and
// `level` + 2 are made from `level`. A thread makes one node of the highest of them, and its descendants.
import package::wgsl::surface::ray::SURFACE_WRAP;
import package::wgsl::surface::atlas::surface_atlas_at;

override FROM_HEIGHTS: bool = true;

struct PyramidParams {
    // Texels and cells of a map.
    size: vec2<u32>,
    cells: vec2<u32>,
    // Nodes a row of the plane, and rows, of one map's pyramid.
    pitch: u32,
    rows: u32,
    address: u32,
    // Levels of a pyramid, and the one that is read.
    levels: u32,
    level: u32,
}

@group(0) @binding(0) var<uniform> params: PyramidParams;
@group(0) @binding(1) var<storage, read> heights: array<f32>;
@group(0) @binding(2) var<storage, read_write> pyramids: array<f32>;

// Lower than any height: what lies outside a level.
const NOTHING: f32 = -1.0;

fn nodes(level: u32) -> vec2<u32> {
    return (params.cells + (vec2<u32>(1u) << vec2<u32>(level)) - 1u) >> vec2<u32>(level);
}

fn place(map: u32, level: u32, at: vec2<u32>) -> u32 {
    let texel = vec2<u32>(surface_atlas_at(params.cells, level, vec2<i32>(at)));
    return (map * params.rows + texel.y) * params.pitch + texel.x;
}

fn store(map: u32, level: u32, at: vec2<u32>, highest: f32) {
    if level < params.levels && all(at < nodes(level)) {
        pyramids[place(map, level, at)] = highest;
    }
}

// The row or column of texels before a cell: texel index, from a cell's or the next cell's.
fn texel(cell: u32, size: u32) -> u32 {
    if params.address == SURFACE_WRAP {
        return cell % size;
    }
    return min(max(cell, 1u) - 1u, size - 1u);
}

// The highest corners of four cells in a row share five texels above and five below.
fn texel_row(map: u32, at: vec2<u32>) -> vec4<f32> {
    let row = (map * params.size.y + texel(at.y, params.size.y)) * params.size.x;
    let first = vec4<f32>(
        heights[row + texel(at.x, params.size.x)],
        heights[row + texel(at.x + 1u, params.size.x)],
        heights[row + texel(at.x + 2u, params.size.x)],
        heights[row + texel(at.x + 3u, params.size.x)]);
    let last = heights[row + texel(at.x + 4u, params.size.x)];
    return max(first, vec4<f32>(first.yzw, last));
}

fn child_row(map: u32, at: vec2<u32>) -> vec4<f32> {
    let count = nodes(params.level);
    let row = place(map, params.level, at);
    let inside = vec4<bool>(
        at.x < count.x, at.x + 1u < count.x, at.x + 2u < count.x, at.x + 3u < count.x);
    if at.y >= count.y {
        return vec4<f32>(NOTHING);
    }
    // Reads beyond the level stay inside the buffer, and do not count.
    let read = vec4<f32>(pyramids[row], pyramids[row + 1u], pyramids[row + 2u], pyramids[row + 3u]);
    return select(vec4<f32>(NOTHING), read, inside);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let level = select(params.level, 0u, FROM_HEIGHTS);
    if any(id.xy >= nodes(level + 2u)) {
        return;
    }
    let at = 4u * id.xy;
    var highest = vec2<f32>(NOTHING);
    var above = vec4<f32>(NOTHING);
    if FROM_HEIGHTS {
        above = texel_row(id.z, at);
    }
    for (var half = 0u; half < 2u; half++) {
        var pair = vec4<f32>(NOTHING);
        for (var row = 2u * half; row < 2u * half + 2u; row++) {
            let here = vec2<u32>(at.x, at.y + row);
            var leaves: vec4<f32>;
            if FROM_HEIGHTS {
                let below = texel_row(id.z, here + vec2<u32>(0u, 1u));
                leaves = max(above, below);
                above = below;
                store(id.z, 0u, here, leaves.x);
                store(id.z, 0u, here + vec2<u32>(1u, 0u), leaves.y);
                store(id.z, 0u, here + vec2<u32>(2u, 0u), leaves.z);
                store(id.z, 0u, here + vec2<u32>(3u, 0u), leaves.w);
                let inside = vec4<u32>(here.x) + vec4<u32>(0u, 1u, 2u, 3u) < vec4<u32>(params.cells.x);
                leaves = select(vec4<f32>(NOTHING), leaves, inside & vec4<bool>(here.y < params.cells.y));
            } else {
                leaves = child_row(id.z, here);
            }
            pair = max(pair, leaves);
        }
        let parents = vec2<f32>(max(pair.x, pair.y), max(pair.z, pair.w));
        let parent = vec2<u32>(2u * id.x, 2u * id.y + half);
        store(id.z, level + 1u, parent, parents.x);
        store(id.z, level + 1u, parent + vec2<u32>(1u, 0u), parents.y);
        highest = max(highest, parents);
    }
    store(id.z, level + 2u, id.xy, max(highest.x, highest.y));
}
