// relievo terrain/hydraulic: generated from kernels/terrain/hydraulic.wgsl

const HEIGHT_ONE: i32 = 65536;

const HEIGHT_LIMIT: i32 = 1073741823;

fn mean_of_four(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    let first = a + b;
    let second = c + d;
    let carry = (first & second & vec4<i32>(1)) + vec4<i32>(1);
    return ((first >> one) + (second >> one) + carry) >> one;
}

fn multiply_high(a: vec4<u32>, b: u32) -> vec4<u32> {
    let low = vec4<u32>(65535u);
    let half = vec4<u32>(16u);
    let a_low = a & low;
    let a_high = a >> half;
    let b_low = b & 65535u;
    let b_high = b >> 16u;
    let middle = a_high * b_low + ((a_low * b_low) >> half);
    let carry = a_low * b_high + (middle & low);
    return a_high * b_high + (middle >> half) + (carry >> half);
}

fn four_point(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let four = vec4<u32>(4u);
    let low = vec4<i32>(15);
    let whole = 9 * ((b >> four) + (c >> four)) - ((a >> four) + (d >> four));
    return whole + ((9 * ((b & low) + (c & low)) - ((a & low) + (d & low)) + 8) >> four);
}

fn mean_of_two(a: vec4<i32>, b: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    return (a >> one) + (b >> one) + (((a & vec4<i32>(1)) + (b & vec4<i32>(1)) + 1) >> one);
}

fn limited(heights: vec4<i32>) -> vec4<i32> {
    return max(min(heights, vec4<i32>(HEIGHT_LIMIT)), vec4<i32>(-HEIGHT_LIMIT));
}

@group(0) @binding(1)
var<storage, read> windows: array<i32>;

fn is_inner(width: u32, id: vec3<u32>) -> bool {
    return all(id.xy < vec2<u32>(width - 2u));
}

fn inner_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * (width - 2u) + id.y) * (width - 2u) + id.x;
}

fn sample_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * width + id.y + 1u) * width + id.x + 1u;
}

fn gradient_at(width: u32, sample: u32) -> vec2<i32> {
    return vec2<i32>(windows[sample + 1u] - windows[sample - 1u], windows[sample + width] - windows[sample - width]);
}

const WATER_LIMIT: i32 = 67108864;

const SEDIMENT_LIMIT: i32 = 67108864;

struct HydraulicParams {
    in_width: u32,
    wet: i32,
    settles: i32,
    rain: i32,
    evaporation: i32,
    erosion: i32,
    deposition: i32,
    capacity: i32,
    threshold: i32,
    steepest: i32,
    slope_shift: u32,
    slope_factor: i32,
    talus: i32,
    creep: i32
}

@group(0) @binding(0)
var<uniform> params: HydraulicParams;

@group(0) @binding(2)
var<storage, read_write> outputs: array<i32>;

@group(0) @binding(3)
var<storage, read> flows: array<vec4<i32>>;

@group(0) @binding(4)
var<storage, read_write> flow_outputs: array<vec4<i32>>;

struct Cell {
    ground: i32,
    water: i32,
    sediment: i32,
    shares: vec4<i32>
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
    flow_outputs[index] = vec4<i32>(made.water, made.sediment, made.shares.x | (made.shares.y << 16u), made.shares.z | (made.shares.w << 16u));
}

fn cell_at(at: u32) -> Cell {
    let flow = select(vec4<i32>(0), flows[at], params.wet != 0);
    let shares = vec4<i32>(flow.z & 65535, flow.z >> 16u, flow.w & 65535, flow.w >> 16u);
    return Cell(windows[at], flow.x, flow.y, shares);
}

fn cycle(own: Cell, west: Cell, east: Cell, north: Cell, south: Cell) -> Cell {
    let ground = vec4<i32>(west.ground, east.ground, north.ground, south.ground);
    let water = vec4<i32>(west.water, east.water, north.water, south.water);
    let sediment = vec4<i32>(west.sediment, east.sediment, north.sediment, south.sediment);
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
    let spread = min(next_water >> 5u, params.threshold);
    let flux = leaving - (leaving >> vec4<u32>(1u)) + (falls >> vec4<u32>(4u)) + spread;
    let bounded = clamp(flux, vec4<i32>(0), vec4<i32>(WATER_LIMIT));
    return Cell(own.ground + sum(slid) - lifted, next_water, suspended + lifted, next_shares(bounded, next_water));
}

fn sum(sides: vec4<i32>) -> i32 {
    return sides.x + sides.y + sides.z + sides.w;
}

fn surface(ground: vec4<i32>, water: vec4<i32>) -> vec4<i32> {
    return min(ground + water, vec4<i32>(HEIGHT_LIMIT));
}

fn water_room(water: vec4<i32>) -> vec4<i32> {
    return (WATER_LIMIT - water) >> vec4<u32>(2u);
}

fn sediment_room(sediment: vec4<i32>) -> vec4<i32> {
    return (SEDIMENT_LIMIT - sediment) >> vec4<u32>(2u);
}

fn ground_room(ground: vec4<i32>, sediment: vec4<i32>) -> vec4<i32> {
    return (HEIGHT_LIMIT - ground - sediment) >> vec4<u32>(3u);
}

fn discharge(own: i32, eighths: i32) -> i32 {
    return (own >> 2u) + eighths + (eighths >> 1u);
}

fn slope(falls: vec4<i32>) -> i32 {
    let steepest = clamp(max(falls.xz, falls.yw), vec2<i32>(0), vec2<i32>(params.steepest));
    let slopes = ((steepest >> vec2<u32>(params.slope_shift)) * params.slope_factor) >> vec2<u32>(15u);
    return max(slopes.x, slopes.y) + ((min(slopes.x, slopes.y) * 3) >> 3u);
}

fn capacity(discharge: i32, slope: i32) -> i32 {
    let rate = min((slope * params.capacity) >> 8u, 262144);
    let driving = clamp(discharge - params.threshold, 0, WATER_LIMIT);
    let high = driving >> 12u;
    let low = ((driving & 4095) * rate) >> 12u;
    let product = u32(high) * u32(min(rate, 262144 - (high >> 14u)));
    return i32(min(product + u32(low), u32(SEDIMENT_LIMIT)));
}

fn lifted(steps: vec4<i32>, water: i32, lacking: i32) -> i32 {
    if lacking > 0 {
        let deepest = max(max(max(steps.x, steps.y), max(steps.z, steps.w)), 0);
        return min(part_of(lacking, params.erosion), deepest >> 3u);
    }
    let highest = max(-min(min(steps.x, steps.y), min(steps.z, steps.w)), 0);
    return -min(part_of(-lacking, params.deposition), max(highest >> 3u, water >> 2u));
}

fn next_shares(flux: vec4<i32>, water: i32) -> vec4<i32> {
    let whole = u32(max(max(sum(flux), water), 1));
    let shift = 16u - min(countLeadingZeros(whole), 16u);
    let inverse = 2147483648u / (whole >> shift);
    let shares = ((vec4<u32>(flux) >> vec4<u32>(shift)) * inverse) >> vec4<u32>(16u);
    return (vec4<i32>(shares) * 3) >> vec4<u32>(2u);
}

fn part(amounts: vec4<i32>, shares: vec4<i32>) -> vec4<i32> {
    let bits = vec4<u32>(15u);
    return (amounts >> bits) * shares + (((amounts & vec4<i32>(32767)) * shares) >> bits);
}

fn part_of(amount: i32, share: i32) -> i32 {
    return (amount >> 15u) * share + (((amount & 32767) * share) >> 15u);
}
