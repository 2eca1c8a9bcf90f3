// relievo terrain/node: generated from kernels/terrain/node.wgsl

override STAGE: u32 = 0u;

const INSIDE: u32 = 0u;

const BORDERS: u32 = 1u;

const ROWS: u32 = 8u;

const NODE_MARGIN: u32 = 2u;

const NODE_FACTS: u32 = 5u;

const SIGN: u32 = 2147483648u;

struct NodeParams {
    width: u32,
    count: u32,
    size: u32,
    finer: u32
}

@group(0) @binding(0)
var<uniform> params: NodeParams;

@group(0) @binding(1)
var<storage, read> heights: array<i32>;

@group(0) @binding(2)
var<storage, read> slots: array<u32>;

@group(0) @binding(3)
var<storage, read_write> tiles: array<i32>;

@group(0) @binding(4)
var<storage, read_write> facts: array<atomic<u32>>;

var<workgroup> most: array<atomic<u32>, 5>;

fn height_at(region: u32, x: u32, y: u32) -> i32 {
    return heights[(region * params.width + y) * params.width + x];
}

fn towards(start: i32, end: i32, part: u32, shift: u32) -> i32 {
    let whole = end - start;
    let rest = (whole & i32((1u << shift) - 1u)) * i32(part);
    return (whole >> shift) * i32(part) + (rest >> shift);
}

fn apart(own: i32, surface: i32) -> u32 {
    return u32(max(own, surface)) - u32(min(own, surface)) + 2u;
}

fn deviation(own: i32, corners: vec4<i32>, part: vec2<u32>) -> u32 {
    if part.x == 0u && part.y == 0u {
        return 0u;
    }
    let step = 1u << params.finer;
    let is_north = part.x + part.y <= step;
    let start = select(corners.w, corners.x, is_north);
    let along = select(vec2<u32>(step - part.y, step - part.x), part, is_north);
    return apart(own, start + towards(start, corners.y, along.x, params.finer) + towards(start, corners.z, along.y, params.finer));
}

fn strip_height(region: u32, side: u32, along: u32, depth: u32) -> i32 {
    let last = (params.size - 1u) << params.finer;
    let across = select(depth, last - depth, (side & 1u) != 0u);
    let at = select(vec2<u32>(along, across), vec2<u32>(across, along), side < 2u) + (NODE_MARGIN << params.finer);
    return height_at(region, at.x, at.y);
}

fn across_deviation(region: u32, side: u32, along: u32, depth: u32) -> u32 {
    let step = 1u << params.finer;
    let first = min(along >> (params.finer + 1u), (params.size - 3u) / 2u) * 2u * step;
    let is_back = (side & 1u) != 0u;
    if select(along - first, first + 2u * step - along, is_back) != depth {
        return 0u;
    }
    let start = strip_height(region, side, select(first, first + 2u * step, is_back), 0u);
    let middle = strip_height(region, side, first + step, step);
    let next = select(along + 1u, along - 1u, is_back);
    let inside = strip_height(region, side, along, depth + 1u);
    let beside = strip_height(region, side, next, depth);
    let own = (inside >> 1u) + (beside >> 1u) + (inside & beside & 1);
    return apart(own, start + towards(start, middle, 2u * depth + 1u, params.finer + 1u)) + 1u;
}

fn stitched_deviation(region: u32, side: u32, along: u32, depth: u32) -> u32 {
    let step = 1u << params.finer;
    let first = min(along >> (params.finer + 1u), (params.size - 3u) / 2u) * 2u * step;
    let at = along - first;
    let is_far = at > 2u * step - depth;
    let start = strip_height(region, side, first + select(0u, 2u * step, is_far), 0u);
    let middle = strip_height(region, side, first + step, step);
    let own = strip_height(region, side, along, depth);
    if at >= depth && !is_far {
        let other = strip_height(region, side, first + 2u * step, 0u);
        return max(across_deviation(region, side, along, depth), apart(own, start + towards(start, middle, depth, params.finer) + towards(start, other, at - depth, params.finer + 1u)));
    }
    let near = select(at, 2u * step - at, is_far);
    let inner = strip_height(region, side, first + select(0u, 2u * step, is_far), step);
    return apart(own, start + towards(start, inner, depth - near, params.finer) + towards(start, middle, near, params.finer));
}

fn half_of(a: i32, b: i32) -> u32 {
    return u32(abs((a >> 1u) + (b >> 1u))) + 1u;
}

fn inside(region: u32, slot: u32, has_tile: bool, x: u32, first_row: u32) -> vec4<u32> {
    let step = 1u << params.finer;
    let rim = params.width - 1u;
    let first = NODE_MARGIN * step;
    let last = rim - first;
    let east = min(x + 1u, rim);
    let cell_x = min((x - first) >> params.finer, params.size - 2u);
    let corner_x = first + cell_x * step;
    var found = vec4<u32>();
    var corners = vec4<i32>();
    var above = height_at(region, x, first_row - min(first_row, 1u));
    var own = height_at(region, x, first_row);
    var own_east = height_at(region, east, first_row);
    for (var y = first_row; y < min(first_row + ROWS, params.width); y++) {
        let below = height_at(region, x, min(y + 1u, rim));
        let below_east = height_at(region, east, min(y + 1u, rim));
        if ((x | y) & (step - 1u)) == 0u && has_tile {
            let tile_width = params.size + 2u * NODE_MARGIN;
            tiles[(slot * tile_width + (y >> params.finer)) * tile_width + (x >> params.finer)] = own;
        }
        if min(x, y) >= first && max(x, y) <= last {
            let corner_y = first + min((y - first) >> params.finer, params.size - 2u) * step;
            if y == first_row || y == corner_y {
                corners = vec4<i32>(height_at(region, corner_x, corner_y), height_at(region, corner_x + step, corner_y), height_at(region, corner_x, corner_y + step), height_at(region, corner_x + step, corner_y + step));
            }
            let order = u32(own) ^ SIGN;
            let from_surface = deviation(own, corners, vec2<u32>(x - corner_x, y - corner_y));
            found = max(found, vec4<u32>(order, ~order, from_surface, 0u));
        }
        if min(x, y) >= 1u && max(x, y) < rim {
            let along_x = half_of(height_at(region, x - 1u, y) - own, own_east - own);
            let along_y = half_of(above - own, below - own);
            let twist = half_of(own - own_east, below_east - below);
            found.w = max(max(found.w, twist), max(along_x, along_y));
        }
        above = own;
        own = below;
        own_east = below_east;
    }
    return found;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if lane < NODE_FACTS {
        atomicStore(&most[lane], 0u);
    }
    workgroupBarrier();
    let region = min(select(id.z, id.z / 4u, STAGE == BORDERS), params.count - 1u);
    let slot = slots[region];
    let is_there = slot < arrayLength(&facts) / NODE_FACTS;
    if STAGE == BORDERS {
        if id.x <= (params.size - 1u) << params.finer && is_there {
            atomicMax(&most[3], stitched_deviation(region, id.z % 4u, id.x, id.y));
        }
    }
    else if id.x < params.width && is_there {
        let tile_width = params.size + 2u * NODE_MARGIN;
        let has_tile = slot < arrayLength(&tiles) / (tile_width * tile_width);
        let found = inside(region, slot, has_tile, id.x, ROWS * id.y);
        atomicMax(&most[0], found.x);
        atomicMax(&most[1], found.y);
        atomicMax(&most[2], found.z);
        atomicMax(&most[4], found.w);
    }
    workgroupBarrier();
    if lane < NODE_FACTS && is_there {
        atomicMax(&facts[NODE_FACTS * slot + lane], atomicLoad(&most[lane]));
    }
}
