// B's transition area (section 3.3.1): samples within `width` of a border move towards the patch that already
// exists on its other side. The left and right borders are handled first, then the upper and lower ones on
// their result. A thread makes a block of samples; blocks in the middle of a patch, which no neighbour reaches, have none.
import package::wgsl::terrain::blocks::{Blocks, Thread, block_of, span_of};

// Whether the neighbours lie in `others`, a separate buffer of patches, and not in `heights`.
override OTHERS: bool = false;

struct BorderParams {
    blocks: Blocks,
    size: u32,
    width: u32,
    points: u32,
    // Index of the first entry of this dispatch in `order` and `neighbours`.
    start: u32,
    // Samples of the strip along each border that is cut into blocks of its own; 0 where the strips would overlap.
    rim: u32,
}

@group(0) @binding(0) var<uniform> params: BorderParams;
@group(0) @binding(1) var<storage, read_write> heights: array<i32>;
// The neighbours to the left, to the right, above and below each entry's patch; 0xffffffff where there is none
// to move towards.
@group(0) @binding(2) var<storage, read> neighbours: array<vec4<u32>>;
// Indices of patches, dispatch by dispatch. The patches of one dispatch do not depend on each other.
@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read> others: array<i32>;

const NONE = 0xffffffffu;

// Columns of a block.
const BLOCK_WIDTH: u32 = 4u;
const LANES = vec4<u32>(0u, 1u, 2u, 3u);

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let block = block_of(params.blocks, thread);
    let inside = params.size - 2u * params.rim;
    let columns = span_of(block.at.x, BLOCK_WIDTH, params.rim, inside);
    let rows = span_of(block.at.y, params.blocks.rows, params.rim, inside);
    if !block.there || (params.rim > 0u && columns.tile == 1u && rows.tile == 1u) {
        return;
    }
    let entry = params.start + block.window;
    let around = neighbours[entry];
    let last = params.size - 1u;
    let x = columns.start + LANES;
    let there = x < vec4<u32>(columns.end);
    let opposite = vec4<u32>(last) - x;
    let beside = sides_of(columns.tile);
    let beyond = sides_of(rows.tile);
    let is_reached = are_there(beside, around.xy) || are_there(beyond, around.zw);
    let end = select(rows.start, rows.end, is_reached);
    for (var y = rows.start; y < end; y++) {
        let first = order[entry] * params.points + y * params.size + columns.start;
        let row = y * params.size;
        let across = (last - y) * params.size + x;
        var ours = vec4<i32>(heights[first], heights[first + 1u], heights[first + 2u], heights[first + 3u]);
        for (var side = beside.x; side < beside.y; side++) {
            let distance = select(x, opposite, side == 1u);
            ours = towards(ours, select(around.x, around.y, side == 1u), distance, row + opposite, there);
        }
        for (var side = beyond.x; side < beyond.y; side++) {
            let distance = select(y, last - y, side == 1u);
            ours = towards(ours, select(around.z, around.w, side == 1u), vec4<u32>(distance), across, there);
        }
        store(first, there.x, ours.x);
        store(first + 1u, there.y, ours.y);
        store(first + 2u, there.z, ours.z);
        store(first + 3u, there.w, ours.w);
    }
}

// The sides, 0 and 1, whose neighbours may reach a block along an axis: the first, and the one behind the last. Blocks in the
// middle have none, unless there are no strips.
fn sides_of(tile: u32) -> vec2<u32> {
    if params.rim == 0u {
        return vec2<u32>(0u, 2u);
    }
    return vec2<u32>(min(tile, 1u), select(1u, 2u, tile == 2u));
}

// Whether one of these sides has a neighbour.
fn are_there(sides: vec2<u32>, around: vec2<u32>) -> bool {
    let first = sides.x == 0u && sides.y > 0u && around.x != NONE;
    return first || (sides.x < sides.y && sides.y == 2u && around.y != NONE);
}

fn store(index: u32, there: bool, height: i32) {
    if there {
        heights[index] = height;
    }
}

// Blends linearly from the neighbour's heights at distance 0 to the patch's own at distance `width`.
fn towards(ours: vec4<i32>, neighbour: u32, distance: vec4<u32>, index: vec4<u32>, there: vec4<bool>) -> vec4<i32> {
    let near = there & (distance < vec4<u32>(params.width));
    if neighbour == NONE || !any(near) {
        return ours;
    }
    let first = index + neighbour * params.points;
    let theirs = vec4<i32>(sample_of(first.x), sample_of(first.y), sample_of(first.z), sample_of(first.w));
    let width = i32(params.width);
    // The quotient is rounded down.
    let whole = divided(ours - theirs, width);
    let d = vec4<i32>(distance);
    let part = divided(whole.remainder * d + vec4<i32>(width / 2), width);
    return select(ours, theirs + whole.quotient * d + part.quotient, near);
}

struct Division {
    quotient: vec4<i32>,
    remainder: vec4<i32>,
}

// Division rounded down, for divisors from 1 to 4096, which is exact whatever a device's floats do: integer division is slow
// where eight lanes share a processor's divider. A float quotient, wrong by 2^-20 of itself and by 1 at most, leaves a rest
// below 2^12 + 2 · 4096, whose own quotient is wrong by 1 at most.
fn divided(dividend: vec4<i32>, divisor: i32) -> Division {
    let reciprocal = 1.0 / f32(divisor);
    let first = vec4<i32>(vec4<f32>(dividend) * reciprocal);
    let rest = dividend - first * divisor;
    let second = vec4<i32>(floor(vec4<f32>(rest) * reciprocal));
    let last = rest - second * divisor;
    let over = select(vec4<i32>(0), vec4<i32>(1), last >= vec4<i32>(divisor))
        - select(vec4<i32>(0), vec4<i32>(1), last < vec4<i32>(0));
    return Division(first + second + over, last - over * divisor);
}

fn sample_of(index: u32) -> i32 {
    if OTHERS {
        return others[index];
    }
    return heights[index];
}
