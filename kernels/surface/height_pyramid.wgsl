// Max-mip pyramids of a batch of height maps (B section 2.3.4). A leaf is the highest corner of a bilinear
// cell, and a node the highest of its four children. With FROM_HEIGHTS the kernel computes levels 0, 1 and 2;
// without it, levels `level` + 1 and `level` + 2 from `level`. A thread computes one node of the highest of
// these levels, and its descendants.
import package::wgsl::surface::ray::SURFACE_WRAP;
import package::wgsl::surface::atlas::surface_atlas_at;

override FROM_HEIGHTS: bool = true;
// Whether rows of heights start at multiples of four, with wrap addressing, so that whole vectors can be
// loaded.
override IS_ALIGNED: bool = false;

struct PyramidParams {
    // Texels and cells of a map along x and y.
    size: vec2<u32>,
    cells: vec2<u32>,
    // Nodes per row and number of rows of the plane of one map's pyramid.
    pitch: u32,
    rows: u32,
    address: u32,
    // Number of levels of a pyramid, and the level that is read.
    levels: u32,
    level: u32,
}

@group(0) @binding(0) var<uniform> params: PyramidParams;
// Four consecutive heights; they belong to one row where IS_ALIGNED is set.
@group(0) @binding(1) var<storage, read> heights: array<vec4<f32>>;
// Scalars and not vectors, because neighbouring threads store adjacent nodes, and storing one component may
// store the whole vector.
@group(0) @binding(2) var<storage, read_write> pyramids: array<f32>;

// Stands for nodes outside a level; lower than any height.
const NOTHING: f32 = -1.0;

fn nodes(level: u32) -> vec2<u32> {
    return (params.cells + (vec2<u32>(1u) << vec2<u32>(level)) - 1u) >> vec2<u32>(level);
}

fn place(map: u32, level: u32, at: vec2<u32>) -> u32 {
    let texel = vec2<u32>(surface_atlas_at(params.cells, level, vec2<i32>(at)));
    return (map * params.rows + texel.y) * params.pitch + texel.x;
}

// The row or column of texels before a cell, up to four beyond the last. In maps smaller than that, cells that
// do not count read some texel of the map.
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

// A row of texels: those before four cells, and the one after them.
fn texel_row(map: u32, y: u32) -> u32 {
    return (map * params.size.y + texel(y, params.size.y)) * params.size.x;
}

// The maxima of neighbouring texels in a row; `last` is the fifth texel.
fn highest_pairs(row: u32, x: u32, last: f32) -> vec4<f32> {
    var four: vec4<f32>;
    if IS_ALIGNED {
        four = heights[(row + x) >> 2u];
    } else {
        four = vec4<f32>(height(row, x), height(row, x + 1u), height(row, x + 2u), height(row, x + 3u));
    }
    return max(four, vec4<f32>(four.yzw, last));
}

// Four rows of four leaves each.
fn leaves(map: u32, at: vec2<u32>) -> mat4x4<f32> {
    let rows = vec4<u32>(
        texel_row(map, at.y), texel_row(map, at.y + 1u), texel_row(map, at.y + 2u), texel_row(map, at.y + 3u));
    let below = texel_row(map, at.y + 4u);
    // All rows issue their first loads together, so that a processor waits for memory once.
    let x = at.x + 4u;
    let lasts = vec4<f32>(height(rows.x, x), height(rows.y, x), height(rows.z, x), height(rows.w, x));
    let fifth = highest_pairs(below, at.x, height(below, x));
    let first = highest_pairs(rows.x, at.x, lasts.x);
    let second = highest_pairs(rows.y, at.x, lasts.y);
    let third = highest_pairs(rows.z, at.x, lasts.z);
    let fourth = highest_pairs(rows.w, at.x, lasts.w);
    return mat4x4<f32>(max(first, second), max(second, third), max(third, fourth), max(fourth, fifth));
}

// Four nodes, with those outside their level replaced by NOTHING.
fn inside(four: vec4<f32>, at: vec2<u32>, count: vec2<u32>) -> vec4<f32> {
    let columns = vec4<u32>(at.x) + vec4<u32>(0u, 1u, 2u, 3u) < vec4<u32>(count.x);
    return select(vec4<f32>(NOTHING), four, columns & vec4<bool>(at.y < count.y));
}

fn load_row(index: u32) -> vec4<f32> {
    return vec4<f32>(pyramids[index], pyramids[index + 1u], pyramids[index + 2u], pyramids[index + 3u]);
}

// Stores four nodes; rows are padded to a multiple of four.
fn store_row(index: u32, four: vec4<f32>) {
    pyramids[index] = four.x;
    pyramids[index + 1u] = four.y;
    pyramids[index + 2u] = four.z;
    pyramids[index + 3u] = four.w;
}

fn parents(above: vec4<f32>, below: vec4<f32>) -> vec2<f32> {
    let pair = max(above, below);
    return vec2<f32>(max(pair.x, pair.y), max(pair.z, pair.w));
}

// Stores two nodes in a row of a higher level; the index of the first is even.
fn store_pair(map: u32, level: u32, at: vec2<u32>, pair: vec2<f32>) {
    let count = nodes(level);
    if level >= params.levels || at.y >= count.y {
        return;
    }
    let index = place(map, level, at);
    pyramids[index] = pair.x;
    if at.x + 1u < count.x {
        pyramids[index + 1u] = pair.y;
    }
}

// The threads of a map cover its rows one after another, with a power of two of threads per row. Neighbouring
// threads read neighbouring texels, and workgroups run along rows, since processors prefetch what is read in
// order.
@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let level = select(params.level, 0u, FROM_HEIGHTS);
    let highest_count = nodes(level + 2u);
    let row_bits = 32u - countLeadingZeros(highest_count.x - 1u);
    let index = (group.y * groups.x + group.x) * 64u + lane;
    let map = group.z;
    let id = vec2<u32>(index & ((1u << row_bits) - 1u), index >> row_bits);
    if any(id >= highest_count) {
        return;
    }
    let at = 4u * id;
    let count = nodes(level);
    let row = place(map, level, at);
    let pitch = params.pitch;
    var four: mat4x4<f32>;
    if FROM_HEIGHTS {
        four = leaves(map, at);
    } else {
        four = mat4x4<f32>(
            load_row(row), load_row(row + pitch), load_row(row + 2u * pitch), load_row(row + 3u * pitch));
    }
    let first = inside(four[0], at, count);
    let second = inside(four[1], at + vec2<u32>(0u, 1u), count);
    let third = inside(four[2], at + vec2<u32>(0u, 2u), count);
    let fourth = inside(four[3], at + vec2<u32>(0u, 3u), count);
    if FROM_HEIGHTS {
        store_row(row, first);
        if at.y + 1u < count.y {
            store_row(row + pitch, second);
        }
        if at.y + 2u < count.y {
            store_row(row + 2u * pitch, third);
        }
        if at.y + 3u < count.y {
            store_row(row + 3u * pitch, fourth);
        }
    }
    let upper = parents(first, second);
    let lower = parents(third, fourth);
    store_pair(map, level + 1u, 2u * id, upper);
    store_pair(map, level + 1u, 2u * id + vec2<u32>(0u, 1u), lower);
    if level + 2u < params.levels {
        let highest = max(upper, lower);
        let node = place(map, level + 2u, id);
        pyramids[node] = max(highest.x, highest.y);
    }
}
