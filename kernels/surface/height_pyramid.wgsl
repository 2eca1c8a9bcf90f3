// Max-mip pyramids of a batch of height maps (B section 2.3.4). A leaf is the highest corner of a bilinear cell, a
// node the highest of its four children. FROM_HEIGHTS makes levels 0, 1 and 2; without it, levels `level` + 1 and
// `level` + 2 are made from `level`. A thread makes one node of the highest of them, and its descendants.
import package::wgsl::surface::ray::SURFACE_WRAP;
import package::wgsl::surface::atlas::surface_atlas_at;

override FROM_HEIGHTS: bool = true;
// Rows of heights that start at multiples of four, with wrap addressing: whole vectors are loaded.
override IS_ALIGNED: bool = false;

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
// Four heights of a row where IS_ALIGNED; else just four in a row.
@group(0) @binding(1) var<storage, read> heights: array<vec4<f32>>;
// Four nodes of a row: rows of the plane, and level 1, start at multiples of four.
@group(0) @binding(2) var<storage, read_write> pyramids: array<vec4<f32>>;

// Lower than any height: what lies outside a level.
const NOTHING: f32 = -1.0;

fn nodes(level: u32) -> vec2<u32> {
    return (params.cells + (vec2<u32>(1u) << vec2<u32>(level)) - 1u) >> vec2<u32>(level);
}

fn place(map: u32, level: u32, at: vec2<u32>) -> u32 {
    let texel = vec2<u32>(surface_atlas_at(params.cells, level, vec2<i32>(at)));
    return (map * params.rows + texel.y) * params.pitch + texel.x;
}

// The row or column of texels before a cell, up to four beyond the last. Maps smaller than that read a texel of
// their own for cells that do not count.
fn texel(cell: u32, size: u32) -> u32 {
    if params.address == SURFACE_WRAP {
        let wrapped = select(cell, cell - size, cell >= size);
        return select(wrapped, 0u, wrapped >= size);
    }
    return min(max(cell, 1u) - 1u, size - 1u);
}

fn height(row: u32, cell: u32) -> f32 {
    let index = row + texel(cell, params.size.x);
    return heights[index >> 2u][index & 3u];
}

// The highest corners of four cells in a row share five texels above and five below.
fn texel_row(map: u32, at: vec2<u32>) -> vec4<f32> {
    let row = (map * params.size.y + texel(at.y, params.size.y)) * params.size.x;
    let last = height(row, at.x + 4u);
    if IS_ALIGNED {
        let four = heights[(row + at.x) >> 2u];
        return max(four, vec4<f32>(four.yzw, last));
    }
    let four = vec4<f32>(
        height(row, at.x), height(row, at.x + 1u), height(row, at.x + 2u), height(row, at.x + 3u));
    return max(four, vec4<f32>(four.yzw, last));
}

// Four nodes as they count: those outside their level do not.
fn inside(four: vec4<f32>, at: vec2<u32>, count: vec2<u32>) -> vec4<f32> {
    let columns = vec4<u32>(at.x) + vec4<u32>(0u, 1u, 2u, 3u) < vec4<u32>(count.x);
    return select(vec4<f32>(NOTHING), four, columns & vec4<bool>(at.y < count.y));
}

// Two nodes of a row of a higher level, the first of even index.
fn store_pair(map: u32, level: u32, at: vec2<u32>, pair: vec2<f32>) {
    let count = nodes(level);
    if level >= params.levels || at.y >= count.y {
        return;
    }
    let index = place(map, level, at);
    pyramids[index >> 2u][index & 3u] = pair.x;
    if at.x + 1u < count.x {
        pyramids[index >> 2u][(index & 3u) + 1u] = pair.y;
    }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let level = select(params.level, 0u, FROM_HEIGHTS);
    if any(id.xy >= nodes(level + 2u)) {
        return;
    }
    let at = 4u * id.xy;
    let count = nodes(level);
    var row = place(id.z, level, at) >> 2u;
    var above = vec4<f32>(NOTHING);
    if FROM_HEIGHTS {
        above = texel_row(id.z, at);
    }
    var highest = vec2<f32>(NOTHING);
    for (var half = 0u; half < 2u; half++) {
        var pair = vec4<f32>(NOTHING);
        for (var y = at.y + 2u * half; y < at.y + 2u * half + 2u; y++) {
            var four: vec4<f32>;
            if FROM_HEIGHTS {
                let below = texel_row(id.z, vec2<u32>(at.x, y + 1u));
                four = inside(max(above, below), vec2<u32>(at.x, y), count);
                above = below;
                if y < count.y {
                    pyramids[row] = four;
                }
            } else {
                four = inside(pyramids[row], vec2<u32>(at.x, y), count);
            }
            row += params.pitch >> 2u;
            pair = max(pair, four);
        }
        let parents = vec2<f32>(max(pair.x, pair.y), max(pair.z, pair.w));
        store_pair(id.z, level + 1u, vec2<u32>(2u * id.x, 2u * id.y + half), parents);
        highest = max(highest, parents);
    }
    if level + 2u < params.levels {
        let index = place(id.z, level + 2u, id.xy);
        pyramids[index >> 2u][index & 3u] = max(highest.x, highest.y);
    }
}
