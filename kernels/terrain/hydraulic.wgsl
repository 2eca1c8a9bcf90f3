// Hydraulic erosion of windows, one cycle of the rule in `wgsl/terrain/pipes.wgsl` after the other. Each cycle takes the outermost
// ring of samples from a window.
//
// A thread makes a column of samples. It streams the rows of the window through registers and, where a dispatch makes two cycles,
// the rows after the first cycle too. What two samples exchange is written down for each of them; compilers compute it once.
import package::wgsl::terrain::blocks::{Block, Blocks, Thread, block_of};
import package::wgsl::terrain::outputs::store_four;
import package::wgsl::terrain::pipes::{Cells, Exchange, cells_of, cycle, downwards, params, row_of};

// The cycles of a dispatch. 1: a column is four samples wide. 2: it is eight samples wide, and loads and stores, which take most
// of the time of software adapters, are nearly half as many.
override CYCLES: u32 = 1u;

@group(0) @binding(1) var<storage, read> windows: array<i32>;
@group(0) @binding(3) var<storage, read> flows: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read_write> flow_outputs: array<vec4<i32>>;
@group(0) @binding(5) var<uniform> blocks: Blocks;

// Eight samples of a row from the first one on; where a column is four wide, the last two have no meaning.
struct Eight {
    a: Cells,
    b: Cells,
}

// Twelve samples of a row from the first one on, or the ten in the middle of twelve, of which `c` has two and two without meaning.
struct Twelve {
    a: Cells,
    b: Cells,
    c: Cells,
}

// What eight samples of a row exchange with those below.
struct EightExchange {
    a: Exchange,
    b: Exchange,
}

// What ten do, of which `c` has two.
struct TenExchange {
    a: Exchange,
    b: Exchange,
    c: Exchange,
}

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let block = block_of(blocks, thread);
    if !block.there {
        return;
    }
    if CYCLES == 1u {
        make_one(block);
    } else {
        make_two(block);
    }
}

// Makes a column of samples, four wide, by one cycle.
fn make_one(block: Block) {
    let width = params.in_width - 2u;
    let column = 4u * block.at.x;
    let first = blocks.rows * block.at.y;
    let last = min(first + blocks.rows, width);
    var source = (block.window * params.in_width + first) * params.in_width + column;
    var row = (block.window * width + first) * width;
    var above = eight_at(source);
    source += params.in_width;
    var here = eight_at(source);
    var north = downwards(row_of(above.a, above.b).own, row_of(here.a, here.b).own);
    for (var y = first; y < last; y++) {
        source += params.in_width;
        let below = eight_at(source);
        let own = row_of(here.a, here.b);
        let under = row_of(below.a, below.b).own;
        let south = downwards(own.own, under);
        store(row, column, width, cycle(own, row_of(above.a, above.b).own, under, north, south, params.rain));
        row += width;
        above = here;
        here = below;
        north = south;
    }
}

// Makes a column of samples, eight wide, by two cycles.
fn make_two(block: Block) {
    let width = params.in_width - 4u;
    let column = 8u * block.at.x;
    let first = blocks.rows * block.at.y;
    let rows = min(blocks.rows, width - first);
    var source = (block.window * params.in_width + first) * params.in_width + column;
    // The first two of the rows after one cycle make no row after two.
    var row = (block.window * width + first) * width - 2u * width;
    var above = twelve_at(source);
    source += params.in_width;
    var here = twelve_at(source);
    var north = ten_downwards(middle(above), middle(here));
    var next_above: Twelve;
    var next_here: Twelve;
    var next_north: EightExchange;
    for (var y = 0u; y < rows + 2u; y++) {
        source += params.in_width;
        let below = twelve_at(source);
        let south = ten_downwards(middle(here), middle(below));
        let next_below = after_first(above, here, below, north, south);
        let next_south = eight_downwards(next_here, next_below);
        let made = after_second(next_above, next_here, next_below, next_north, next_south);
        let stored = select(0u, width, y >= 2u);
        store(row, column, stored, made.a);
        store(row, column + 4u, stored, made.b);
        row += width;
        above = here;
        here = below;
        north = south;
        next_above = next_here;
        next_here = next_below;
        next_north = next_south;
    }
}

// The ten samples in the middle of twelve.
fn middle(row: Twelve) -> Twelve {
    return Twelve(row_of(row.a, row.b).own, row_of(row.b, row.c).own, row_of(row.c, row.c).own);
}

fn ten_downwards(above: Twelve, below: Twelve) -> TenExchange {
    return TenExchange(downwards(above.a, below.a), downwards(above.b, below.b), downwards(above.c, below.c));
}

// What the eight samples in the middle of ten exchange with those below.
fn eight_downwards(above: Twelve, below: Twelve) -> EightExchange {
    return EightExchange(
        downwards(row_of(above.a, above.b).own, row_of(below.a, below.b).own),
        downwards(row_of(above.b, above.c).own, row_of(below.b, below.c).own));
}

// The ten samples in the middle of a row of twelve after the first of two cycles.
fn after_first(above: Twelve, row: Twelve, below: Twelve, north: TenExchange, south: TenExchange) -> Twelve {
    let over = middle(above);
    let under = middle(below);
    return Twelve(
        cycle(row_of(row.a, row.b), over.a, under.a, north.a, south.a, params.rain),
        cycle(row_of(row.b, row.c), over.b, under.b, north.b, south.b, params.rain),
        cycle(row_of(row.c, row.c), over.c, under.c, north.c, south.c, params.rain));
}

// The eight samples in the middle of a row of ten after the second of two cycles.
fn after_second(above: Twelve, row: Twelve, below: Twelve, north: EightExchange, south: EightExchange) -> Eight {
    let over = middle(above);
    let under = middle(below);
    return Eight(
        cycle(row_of(row.a, row.b), over.a, under.a, north.a, south.a, params.second_rain),
        cycle(row_of(row.b, row.c), over.b, under.b, north.b, south.b, params.second_rain));
}

fn eight_at(first: u32) -> Eight {
    return Eight(cells_at(first), cells_at(first + 4u));
}

fn twelve_at(first: u32) -> Twelve {
    return Twelve(cells_at(first), cells_at(first + 4u), cells_at(first + 8u));
}

fn cells_at(first: u32) -> Cells {
    let a = flow_at(first);
    let b = flow_at(first + 1u);
    let c = flow_at(first + 2u);
    let d = flow_at(first + 3u);
    return cells_of(
        vec4<i32>(windows[first], windows[first + 1u], windows[first + 2u], windows[first + 3u]),
        vec4<i32>(a.x, b.x, c.x, d.x), vec4<i32>(a.y, b.y, c.y, d.y), vec4<i32>(a.z, b.z, c.z, d.z),
        vec4<i32>(a.w, b.w, c.w, d.w));
}

fn flow_at(at: u32) -> vec4<i32> {
    // What the buffer held before the first cycle does not count; it may be shorter then.
    return select(vec4<i32>(0), flows[at], vec4<bool>(params.wet != 0));
}

// Stores the samples `column` to `column` + 3 of a row that starts at `row` and has `width` of them.
fn store(row: u32, column: u32, width: u32, made: Cells) {
    store_four(row, column, width, made.ground + made.sediment * params.settles);
    store_flow(row, column, width, vec4<i32>(made.water.x, made.sediment.x, made.across.x, made.along.x));
    store_flow(row, column + 1u, width, vec4<i32>(made.water.y, made.sediment.y, made.across.y, made.along.y));
    store_flow(row, column + 2u, width, vec4<i32>(made.water.z, made.sediment.z, made.across.z, made.along.z));
    store_flow(row, column + 3u, width, vec4<i32>(made.water.w, made.sediment.w, made.across.w, made.along.w));
}

fn store_flow(row: u32, column: u32, width: u32, flow: vec4<i32>) {
    if column < width {
        flow_outputs[row + column] = flow;
    }
}
