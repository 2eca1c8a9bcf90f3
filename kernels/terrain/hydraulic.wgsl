// A cycle of hydraulic erosion of windows (virtual pipes after Mei, Decaudin and Hu 2007, in integers). Each sample has ground,
// water, and suspended sediment. Each sample also has shares: the fractions of water and sediment that leave for its four
// neighbours. A cycle moves these shares, lets ground creep and banks slide, erodes or deposits, evaporates and rains. The next
// shares are computed from the surfaces before the cycle. All transport between two samples is computed from the old state
// alone. Each window loses its outermost ring of samples.
import package::wgsl::terrain::fixed::HEIGHT_LIMIT;
import package::wgsl::terrain::windows::{inner_index, is_inner, sample_index, windows};

// Largest amount of water on a sample, in 1/65536 height units.
const WATER_LIMIT: i32 = 0x4000000;
// Largest amount of sediment in the water of a sample, in 1/65536 height units.
const SEDIMENT_LIMIT: i32 = 0x4000000;

// Parameters of the kernel `terrain/hydraulic`.
struct HydraulicParams {
    // Number of samples along an edge of a window.
    in_width: u32,
    // 0 in the first cycle, which starts without water; else 1.
    wet: i32,
    // 1 in the last cycle, at whose end all sediment settles; else 0.
    settles: i32,
    // Rain: water that falls on each sample in a cycle, in 1/65536 height units.
    rain: i32,
    // Fraction of the water that evaporates in a cycle, in 1/32768.
    evaporation: i32,
    // Erosion rate, in 1/32768 per cycle. While the water carries less sediment than its capacity, this fraction of the
    // difference is taken from the ground.
    erosion: i32,
    // Fraction of the sediment above the water's capacity that is deposited in a cycle, in 1/32768.
    deposition: i32,
    // Sediment capacity per unit of discharge at a slope of 1, in 1/256.
    capacity: i32,
    // Threshold of two effects, in 1/65536 height units. A discharge up to the threshold carries no sediment. The water that
    // spreads to each neighbour is at most the threshold.
    threshold: i32,
    // Height difference to the next sample at a slope of 1, in 1/65536 height units. Larger differences are clamped to this
    // one.
    steepest: i32,
    // Shift in the conversion from a fall (height difference) to a slope. The slope, in 1/4096, is
    // ((fall >> slope_shift) * slope_factor) >> 15.
    slope_shift: u32,
    // Factor in the conversion from a fall to a slope, see `slope_shift`.
    slope_factor: i32,
    // Largest stable height difference between two neighbours, in 1/65536 height units.
    talus: i32,
    // Fraction of each height difference that creeps downhill in a cycle, in 1/32768, at most 1/16.
    creep: i32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: HydraulicParams;
// Out: heights of the ground at the inner samples of all windows, in 1/65536 units.
@group(0) @binding(2) var<storage, read_write> outputs: array<i32>;
// State of each sample: water (x) and sediment (y) in 1/65536 height units, then the shares that leave, in 1/32768. z: to the
// west (low half) and east (high half). w: to the north (low half) and south (high half).
@group(0) @binding(3) var<storage, read> flows: array<vec4<i32>>;
// Out: state of each inner sample, in the layout of `flows`.
@group(0) @binding(4) var<storage, read_write> flow_outputs: array<vec4<i32>>;

// State of a sample. Ground, water and sediment are in 1/65536 height units.
struct Cell {
    // Height of the ground.
    ground: i32,
    // Depth of the water.
    water: i32,
    // Suspended sediment.
    sediment: i32,
    // Shares of water and sediment that leave to the west, east, north and south, in 1/32768.
    shares: vec4<i32>,
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.in_width, id) {
        return;
    }
    let at = sample_index(params.in_width, id);
    let made = cycle(cell_at(at), cell_at(at - 1u), cell_at(at + 1u), cell_at(at - params.in_width), cell_at(at + params.in_width));
    let index = inner_index(params.in_width, id);
    outputs[index] = made.ground + made.sediment * params.settles;
    flow_outputs[index] = vec4<i32>(
        made.water, made.sediment, made.shares.x | (made.shares.y << 16u), made.shares.z | (made.shares.w << 16u));
}

// State of the sample at an index, before the cycle.
fn cell_at(at: u32) -> Cell {
    // In the first cycle, the buffer of flows has no valid content and may be shorter.
    let flow = select(vec4<i32>(0), flows[at], params.wet != 0);
    let shares = vec4<i32>(flow.z & 0xffff, flow.z >> 16u, flow.w & 0xffff, flow.w >> 16u);
    return Cell(windows[at], flow.x, flow.y, shares);
}

// State of a sample after a cycle, given its neighbours. Components of vectors are west, east, north and south.
fn cycle(own: Cell, west: Cell, east: Cell, north: Cell, south: Cell) -> Cell {
    let ground = vec4<i32>(west.ground, east.ground, north.ground, south.ground);
    let water = vec4<i32>(west.water, east.water, north.water, south.water);
    let sediment = vec4<i32>(west.sediment, east.sediment, north.sediment, south.sediment);
    // The neighbours' shares that go to this sample, and the sum of each neighbour's shares.
    let shares = vec4<i32>(west.shares.y, east.shares.x, north.shares.w, south.shares.z);
    let all_shares = vec4<i32>(sum(west.shares), sum(east.shares), sum(north.shares), sum(south.shares));

    let leaving = part(vec4<i32>(own.water), own.shares);
    let water_gone = min(leaving, water_room(water));
    let water_come = min(part(water, shares), water_room(vec4<i32>(own.water)));
    let room = ground_room(ground, sediment);
    let own_room = ground_room(vec4<i32>(own.ground), vec4<i32>(own.sediment));
    let silt_gone = min(part(vec4<i32>(own.sediment), own.shares), min(sediment_room(sediment), room));
    let silt_come = min(part(sediment, shares), min(sediment_room(vec4<i32>(own.sediment)), own_room));
    let steps = own.ground - ground;
    let excess = max(abs(steps) - params.talus, vec4<i32>(0)) >> vec4<u32>(3u);
    let sliding = excess + part(abs(steps), vec4<i32>(params.creep));
    let slid = select(min(sliding, own_room), -min(sliding, room), steps > vec4<i32>(0));

    let moved = own.water + sum(water_come - water_gone);
    let suspended = own.sediment + sum(silt_come - silt_gone);
    let falls = surface(vec4<i32>(own.ground), vec4<i32>(own.water)) - surface(ground, water);
    let eighths = sum(part(water, all_shares) >> vec4<u32>(3u));
    let carried = capacity(discharge(sum(water_gone + water_come) >> 1u, eighths), slope(falls));
    let lifted = lifted(steps, moved, carried - suspended);
    let next_water = min(moved - part_of(moved, params.evaporation) + params.rain, WATER_LIMIT);
    // A pipe keeps half of its flux and adds a sixteenth of the fall. In addition, a thirty-second of the water, at most the
    // threshold, spreads through each pipe. This keeps streams from running along rows and columns.
    let spread = min(next_water >> 5u, params.threshold);
    let flux = leaving - (leaving >> vec4<u32>(1u)) + (falls >> vec4<u32>(4u)) + spread;
    let bounded = clamp(flux, vec4<i32>(0), vec4<i32>(WATER_LIMIT));
    return Cell(own.ground + sum(slid) - lifted, next_water, suspended + lifted, next_shares(bounded, next_water));
}

// Sum over the four sides.
fn sum(sides: vec4<i32>) -> i32 {
    return sides.x + sides.y + sides.z + sides.w;
}

// Height of the water's surface, in 1/65536 units.
fn surface(ground: vec4<i32>, water: vec4<i32>) -> vec4<i32> {
    return min(ground + water, vec4<i32>(HEIGHT_LIMIT));
}

// Largest amount of water that one neighbour may add to a sample with the given water.
fn water_room(water: vec4<i32>) -> vec4<i32> {
    return (WATER_LIMIT - water) >> vec4<u32>(2u);
}

// Largest amount of sediment that one neighbour may add to a sample with the given sediment.
fn sediment_room(sediment: vec4<i32>) -> vec4<i32> {
    return (SEDIMENT_LIMIT - sediment) >> vec4<u32>(2u);
}

// Largest amount of ground that one neighbour may add to a sample with the given ground and sediment.
fn ground_room(ground: vec4<i32>, sediment: vec4<i32>) -> vec4<i32> {
    return (HEIGHT_LIMIT - ground - sediment) >> vec4<u32>(3u);
}

// Discharge around a sample: a quarter of `own`, the sample's discharge, plus three quarters of the mean outflow of its four
// neighbours. `eighths` is the sum of an eighth of each outflow. Streams are therefore wider than a sample, and do not favour a
// direction.
fn discharge(own: i32, eighths: i32) -> i32 {
    return (own >> 2u) + eighths + (eighths >> 1u);
}

// Slope of the water's surface, in 1/4096, from the falls to the four neighbours. The length of the gradient is approximated:
// its larger component plus three eighths of its smaller component.
fn slope(falls: vec4<i32>) -> i32 {
    let steepest = clamp(max(falls.xz, falls.yw), vec2<i32>(0), vec2<i32>(params.steepest));
    let slopes = ((steepest >> vec2<u32>(params.slope_shift)) * params.slope_factor) >> vec2<u32>(15u);
    return max(slopes.x, slopes.y) + ((min(slopes.x, slopes.y) * 3) >> 3u);
}

// Amount of sediment that a discharge carries down a slope.
fn capacity(discharge: i32, slope: i32) -> i32 {
    let rate = min((slope * params.capacity) >> 8u, 0x40000);
    let driving = clamp(discharge - params.threshold, 0, WATER_LIMIT);
    let high = driving >> 12u;
    let low = ((driving & 4095) * rate) >> 12u;
    // `high >> 14` is 1 at the largest discharge. Without this term, the largest product would be 2^32, which overflows.
    let product = u32(high) * u32(min(rate, 0x40000 - (high >> 14u)));
    return i32(min(product + u32(low), u32(SEDIMENT_LIMIT)));
}

// Amount of ground that goes into suspension; if negative, the sediment that settles. `steps` has the height differences to the
// neighbours, positive for lower neighbours. `lacking` is the sediment capacity minus the suspended sediment. Ground sinks no
// deeper than its lowest neighbour, and rises no higher than its highest neighbour or the water.
fn lifted(steps: vec4<i32>, water: i32, lacking: i32) -> i32 {
    if lacking > 0 {
        let deepest = max(max(max(steps.x, steps.y), max(steps.z, steps.w)), 0);
        return min(part_of(lacking, params.erosion), deepest >> 3u);
    }
    let highest = max(-min(min(steps.x, steps.y), min(steps.z, steps.w)), 0);
    return -min(part_of(-lacking, params.deposition), max(highest >> 3u, water >> 2u));
}

// Shares of the water that leave in the next cycle, in 1/32768. Together they are at most three quarters, so that neighbouring
// samples do not exchange all of their water from cycle to cycle.
fn next_shares(flux: vec4<i32>, water: i32) -> vec4<i32> {
    let whole = u32(max(max(sum(flux), water), 1));
    let shift = 16u - min(countLeadingZeros(whole), 16u);
    let inverse = 0x80000000u / (whole >> shift);
    let shares = ((vec4<u32>(flux) >> vec4<u32>(shift)) * inverse) >> vec4<u32>(16u);
    return (vec4<i32>(shares) * 3) >> vec4<u32>(2u);
}

// floor(amount * share / 32768), per lane. For amounts of 0 to 2^30, shares may be 0 to 32768. For all other amounts, shares
// may be at most 2048.
fn part(amounts: vec4<i32>, shares: vec4<i32>) -> vec4<i32> {
    let bits = vec4<u32>(15u);
    return (amounts >> bits) * shares + (((amounts & vec4<i32>(32767)) * shares) >> bits);
}

// floor(amount * share / 32768) for one amount, with the bounds of `part`.
fn part_of(amount: i32, share: i32) -> i32 {
    return (amount >> 15u) * share + (((amount & 32767) * share) >> 15u);
}
