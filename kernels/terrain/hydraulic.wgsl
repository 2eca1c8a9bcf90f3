// One cycle of hydraulic erosion (virtual pipes after Mei, Decaudin and Hu 2007, in integers). Each sample has ground, water,
// suspended sediment, and the shares of both that leave for its four neighbours. A cycle moves these shares, lets ground creep and banks slide,
// erodes or deposits, evaporates, rains, and computes the next shares from the surfaces before the cycle, so that it reads one
// sample around. Whatever moves between two samples is computed alike by both, from the old state alone. Each window loses its
// outermost ring of samples.
import package::wgsl::terrain::fixed::HEIGHT_LIMIT;

// The most water on a sample, in 1/65536 height units.
const WATER_LIMIT: i32 = 0x4000000;
// The most sediment in the water of a sample, in 1/65536 height units.
const SEDIMENT_LIMIT: i32 = 0x4000000;

// The rows of a thread, which goes down a column of samples.
override ROWS: u32 = 8u;

struct HydraulicParams {
    in_width: u32,
    // 0 in the first cycle, before which there is no water; else 1.
    wet: i32,
    // 1 in the last cycle, after which all sediment settles; else 0.
    settles: i32,
    // Water that falls on each sample, in 1/65536 height units.
    rain: i32,
    // Fractions in 1/32768.
    evaporation: i32,
    erosion: i32,
    deposition: i32,
    // Sediment for each unit of discharge at a slope of 1, in 1/256.
    capacity: i32,
    // The discharge up to which nothing is carried, in 1/65536 height units.
    threshold: i32,
    // The fall to the next sample at a slope of 1; steeper ones count as this.
    steepest: i32,
    // With factor and shift, a fall is a slope in 1/4096: ((fall >> shift) * factor) >> 15.
    slope_shift: u32,
    slope_factor: i32,
    // The largest stable difference between two neighbours.
    talus: i32,
    // The fraction of each difference that creeps down, in 1/32768, at most 1/16.
    creep: i32,
}

struct Cell {
    ground: i32,
    water: i32,
    sediment: i32,
    // The shares that leave to the west, east, north and south, in 1/32768.
    shares: vec4<i32>,
}

@group(0) @binding(0) var<uniform> params: HydraulicParams;
@group(0) @binding(1) var<storage, read> windows: array<i32>;
@group(0) @binding(2) var<storage, read> flows: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read_write> cropped: array<i32>;
@group(0) @binding(4) var<storage, read_write> cropped_flows: array<vec4<i32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.in_width - 2u;
    let first = id.y * ROWS;
    if id.x >= width || first >= width {
        return;
    }
    let last = min(first + ROWS, width);
    var at = (id.z * params.in_width + first) * params.in_width + id.x + 1u;
    var to = (id.z * width + first) * width + id.x;
    var north = cell_at(at);
    at += params.in_width;
    var here = cell_at(at);
    for (var y = first; y < last; y++) {
        let south = cell_at(at + params.in_width);
        let state = cycle(here, cell_at(at - 1u), cell_at(at + 1u), north, south);
        cropped[to] = state.ground + state.sediment * params.settles;
        cropped_flows[to] = vec4<i32>(
            state.water, state.sediment, state.shares.x | (state.shares.y << 16u), state.shares.z | (state.shares.w << 16u));
        north = here;
        here = south;
        at += params.in_width;
        to += width;
    }
}

fn cell_at(at: u32) -> Cell {
    // What the buffer held before the first cycle does not count; it may be shorter then.
    let flow = select(vec4<i32>(0), flows[at * u32(params.wet)], vec4<bool>(params.wet != 0));
    let shares = vec4<i32>(flow.z & 0xffff, flow.z >> 16u, flow.w & 0xffff, flow.w >> 16u);
    return Cell(windows[at], flow.x, flow.y, shares);
}

// A cycle of one sample, from its neighbours, which lanes hold in the order of the shares. After the last cycle the sediment
// counts as settled.
fn cycle(cell: Cell, west: Cell, east: Cell, north: Cell, south: Cell) -> Cell {
    let ground = vec4<i32>(west.ground, east.ground, north.ground, south.ground);
    let water = vec4<i32>(west.water, east.water, north.water, south.water);
    let sediment = vec4<i32>(west.sediment, east.sediment, north.sediment, south.sediment);
    let entering = vec4<i32>(west.shares.y, east.shares.x, north.shares.w, south.shares.z);
    let room = (HEIGHT_LIMIT - cell.ground - cell.sediment) >> 3u;
    let rooms = (vec4<i32>(HEIGHT_LIMIT) - ground - sediment) >> vec4<u32>(3u);

    let water_lost = min(part(vec4<i32>(cell.water), cell.shares), (vec4<i32>(WATER_LIMIT) - water) >> vec4<u32>(2u));
    let water_gained = min(part(water, entering), vec4<i32>((WATER_LIMIT - cell.water) >> 2u));
    let sediment_lost = min(part(vec4<i32>(cell.sediment), cell.shares),
        min((vec4<i32>(SEDIMENT_LIMIT) - sediment) >> vec4<u32>(2u), rooms));
    let sediment_gained = min(part(sediment, entering), vec4<i32>(min((SEDIMENT_LIMIT - cell.sediment) >> 2u, room)));
    let moved = cell.water - total(water_lost) + total(water_gained);
    let suspended = cell.sediment - total(sediment_lost) + total(sediment_gained);

    let steps = vec4<i32>(cell.ground) - ground;
    let excess = max(abs(steps) - vec4<i32>(params.talus), vec4<i32>(0)) >> vec4<u32>(3u);
    let sliding = excess + part(abs(steps), vec4<i32>(params.creep));
    let slid = min(select(vec4<i32>(0), sliding, steps < vec4<i32>(0)), vec4<i32>(room))
        - min(select(vec4<i32>(0), sliding, steps > vec4<i32>(0)), rooms);

    let surface = min(cell.ground + cell.water, HEIGHT_LIMIT);
    let falls = vec4<i32>(surface) - min(ground + water, vec4<i32>(HEIGHT_LIMIT));
    let carried = capacity((total(water_lost) + total(water_gained)) >> 1u, max(largest(falls), 0));
    let lifted = lifted(steps, moved, carried - suspended);
    let left = min(moved - part_of(moved, params.evaporation) + params.rain, WATER_LIMIT);
    return Cell(cell.ground - lifted + total(slid), left, suspended + lifted, next_shares(cell, falls, left));
}

// The sediment that a discharge carries down a surface that falls so far to the next sample.
fn capacity(discharge: i32, fall: i32) -> i32 {
    let slope = ((min(fall, params.steepest) >> params.slope_shift) * params.slope_factor) >> 15u;
    let rate = min((slope * params.capacity) >> 8u, 0x40000);
    let driving = clamp(discharge - params.threshold, 0, WATER_LIMIT);
    let high = driving >> 12u;
    // A rate beyond this carries more than the limit, and its product might overflow.
    let safe = min(rate, 1i << (countLeadingZeros(u32(max(high, 1))) - 2u));
    return min(high * safe + (((driving & 4095) * rate) >> 12u), SEDIMENT_LIMIT);
}

// The ground that goes into suspension, or, below 0, the sediment that settles. Ground sinks no deeper than its lowest neighbour,
// and rises no higher than its highest or the water.
fn lifted(steps: vec4<i32>, water: i32, lacking: i32) -> i32 {
    let eroded = min(part_of(max(lacking, 0), params.erosion), max(largest(steps), 0) >> 3u);
    let risen = max(max(largest(-steps), 0) >> 3u, water >> 2u);
    let deposited = min(part_of(max(-lacking, 0), params.deposition), risen);
    return eroded - deposited;
}

// The shares that leave next: each pipe keeps half of its flux and takes a sixteenth of the fall; all together give three
// quarters of the water at most, so that neighbouring samples do not exchange all of it from cycle to cycle.
fn next_shares(cell: Cell, falls: vec4<i32>, water: i32) -> vec4<i32> {
    let old = part(vec4<i32>(cell.water), cell.shares);
    let flux = clamp(old - (old >> vec4<u32>(1u)) + (falls >> vec4<u32>(4u)), vec4<i32>(0), vec4<i32>(WATER_LIMIT));
    let whole = u32(max(max(total(flux), water), 1));
    let shift = 16u - min(countLeadingZeros(whole), 16u);
    let inverse = 0x80000000u / (whole >> shift);
    let shares = vec4<i32>(((vec4<u32>(flux) >> vec4<u32>(shift)) * inverse) >> vec4<u32>(16u));
    return (shares * 3) >> vec4<u32>(2u);
}

// floor(amount * share / 32768) for amounts of 0 to 2^30 and shares of 0 to 32768, or any amount and shares of at most 2048.
fn part(amounts: vec4<i32>, shares: vec4<i32>) -> vec4<i32> {
    let bits = vec4<u32>(15u);
    return (amounts >> bits) * shares + (((amounts & vec4<i32>(32767)) * shares) >> bits);
}

fn part_of(amount: i32, share: i32) -> i32 {
    return (amount >> 15u) * share + (((amount & 32767) * share) >> 15u);
}

fn total(values: vec4<i32>) -> i32 {
    return values.x + values.y + values.z + values.w;
}

fn largest(values: vec4<i32>) -> i32 {
    return max(max(values.x, values.y), max(values.z, values.w));
}
