// A cycle of hydraulic erosion (virtual pipes after Mei, Decaudin and Hu 2007, in integers). Each sample has ground, water,
// suspended sediment, and the shares of both that leave for its four neighbours. A cycle moves these shares, lets ground creep and
// banks slide, erodes or deposits, evaporates, rains, and computes the next shares from the surfaces before the cycle, so that it
// reads one sample around. Whatever moves between two samples is computed from the old state alone.
import package::wgsl::terrain::fixed::HEIGHT_LIMIT;

// The most water on a sample, in 1/65536 height units.
const WATER_LIMIT: i32 = 0x4000000;
// The most sediment in the water of a sample, in 1/65536 height units.
const SEDIMENT_LIMIT: i32 = 0x4000000;

struct HydraulicParams {
    in_width: u32,
    // 0 in the first cycle, before which there is no water; else 1.
    wet: i32,
    // 1 in the last cycle, after which all sediment settles; else 0.
    settles: i32,
    // Water that falls on each sample, in 1/65536 height units.
    rain: i32,
    // As `rain`, in the second of two cycles of a dispatch. The reference, which makes one, does not read it.
    second_rain: i32,
    // Fractions in 1/32768.
    evaporation: i32,
    erosion: i32,
    deposition: i32,
    // Sediment for each unit of discharge at a slope of 1, in 1/256.
    capacity: i32,
    // The discharge up to which nothing is carried, and the most that spreads to each neighbour, in 1/65536 height units.
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

@group(0) @binding(0) var<uniform> params: HydraulicParams;

// Four samples.
struct Cells {
    ground: vec4<i32>,
    water: vec4<i32>,
    sediment: vec4<i32>,
    // The shares, in 1/32768, that leave to the west, in the low half, and to the east; to the north, and to the south.
    across: vec4<i32>,
    along: vec4<i32>,
    // The height of the water's surface.
    surface: vec4<i32>,
    // An eighth of the water that leaves, whether there is room for it or not.
    leaving: vec4<i32>,
}

// Four samples, of words as they lie in buffers.
fn cells_of(ground: vec4<i32>, water: vec4<i32>, sediment: vec4<i32>, across: vec4<i32>, along: vec4<i32>) -> Cells {
    let surface = min(ground + water, vec4<i32>(HEIGHT_LIMIT));
    let shares = low(across) + high(across) + low(along) + high(along);
    return Cells(ground, water, sediment, across, along, surface, part(water, shares) >> vec4<u32>(3u));
}

// Four samples beside each other, and their neighbours to the west and east.
struct Row {
    west: Cells,
    own: Cells,
    east: Cells,
}

// The row of samples one to the east of `a`, given the four behind these.
fn row_of(a: Cells, b: Cells) -> Row {
    let own = Cells(
        vec4<i32>(a.ground.yzw, b.ground.x), vec4<i32>(a.water.yzw, b.water.x), vec4<i32>(a.sediment.yzw, b.sediment.x),
        vec4<i32>(a.across.yzw, b.across.x), vec4<i32>(a.along.yzw, b.along.x), vec4<i32>(a.surface.yzw, b.surface.x),
        vec4<i32>(a.leaving.yzw, b.leaving.x));
    let east = Cells(
        vec4<i32>(a.ground.zw, b.ground.xy), vec4<i32>(a.water.zw, b.water.xy), vec4<i32>(a.sediment.zw, b.sediment.xy),
        vec4<i32>(a.across.zw, b.across.xy), vec4<i32>(a.along.zw, b.along.xy), vec4<i32>(a.surface.zw, b.surface.xy),
        vec4<i32>(a.leaving.zw, b.leaving.xy));
    return Row(a, own, east);
}

// What four pairs of neighbours exchange.
struct Exchange {
    // From the first to the second, less what returns.
    water: vec4<i32>,
    sediment: vec4<i32>,
    ground: vec4<i32>,
    // Water that moves either way.
    discharge: vec4<i32>,
    // The water in the share of the first, and of the second, whether there is room for it or not.
    leaving: vec4<i32>,
    returning: vec4<i32>,
}

fn low(words: vec4<i32>) -> vec4<i32> {
    return words & vec4<i32>(0xffff);
}

fn high(words: vec4<i32>) -> vec4<i32> {
    return words >> vec4<u32>(16u);
}

// What samples `a` exchange with samples `b`, given their shares towards each other.
fn exchange(a: Cells, a_shares: vec4<i32>, b: Cells, b_shares: vec4<i32>) -> Exchange {
    let leaving = part(a.water, a_shares);
    let returning = part(b.water, b_shares);
    let gone = min(leaving, (vec4<i32>(WATER_LIMIT) - b.water) >> vec4<u32>(2u));
    let back = min(returning, (vec4<i32>(WATER_LIMIT) - a.water) >> vec4<u32>(2u));
    let a_room = (vec4<i32>(HEIGHT_LIMIT) - a.ground - a.sediment) >> vec4<u32>(3u);
    let b_room = (vec4<i32>(HEIGHT_LIMIT) - b.ground - b.sediment) >> vec4<u32>(3u);
    let silt_gone = min(part(a.sediment, a_shares), min((vec4<i32>(SEDIMENT_LIMIT) - b.sediment) >> vec4<u32>(2u), b_room));
    let silt_back = min(part(b.sediment, b_shares), min((vec4<i32>(SEDIMENT_LIMIT) - a.sediment) >> vec4<u32>(2u), a_room));
    let step = a.ground - b.ground;
    let excess = max(abs(step) - vec4<i32>(params.talus), vec4<i32>(0)) >> vec4<u32>(3u);
    let sliding = excess + part(abs(step), vec4<i32>(params.creep));
    let slid = select(-min(sliding, a_room), min(sliding, b_room), step > vec4<i32>(0));
    return Exchange(gone - back, silt_gone - silt_back, slid, gone + back, leaving, returning);
}

// What samples exchange with their neighbours to the east.
fn eastwards(west: Cells, east: Cells) -> Exchange {
    return exchange(west, high(west.across), east, low(east.across));
}

// What samples exchange with those below.
fn downwards(above: Cells, below: Cells) -> Exchange {
    return exchange(above, high(above.along), below, low(below.along));
}

// What four samples exchange with their neighbours: those to the west and north are the first of their pairs, those to the east
// and south the second.
struct Exchanges {
    west: Exchange,
    east: Exchange,
    north: Exchange,
    south: Exchange,
}

// A cycle of the samples of a row, given those above and below them, what they exchange with them, and the rain.
fn cycle(row: Row, above: Cells, below: Cells, north: Exchange, south: Exchange, rain: i32) -> Cells {
    let sides = Exchanges(eastwards(row.west, row.own), eastwards(row.own, row.east), north, south);
    let own = row.own;
    let water = gained(own.water, sides.west.water, sides.east.water, sides.north.water, sides.south.water);
    let sediment = gained(own.sediment, sides.west.sediment, sides.east.sediment, sides.north.sediment, sides.south.sediment);
    let slid = gained(own.ground, sides.west.ground, sides.east.ground, sides.north.ground, sides.south.ground);
    let left = water - part(water, vec4<i32>(params.evaporation)) + vec4<i32>(rain);
    let next_water = min(left, vec4<i32>(WATER_LIMIT));

    let west_fall = own.surface - row.west.surface;
    let east_fall = own.surface - row.east.surface;
    let north_fall = own.surface - above.surface;
    let south_fall = own.surface - below.surface;
    let exchanged = sides.west.discharge + sides.east.discharge + sides.north.discharge + sides.south.discharge;
    let eighths = row.west.leaving + row.east.leaving + above.leaving + below.leaving;
    let slope = slope(max(west_fall, east_fall), max(north_fall, south_fall));
    let carried = capacity(discharge(exchanged >> vec4<u32>(1u), eighths), slope);
    let deepest = own.ground - min(min(row.west.ground, row.east.ground), min(above.ground, below.ground));
    let highest = max(max(row.west.ground, row.east.ground), max(above.ground, below.ground)) - own.ground;
    let lifted = lifted(deepest, highest, water, carried - sediment);

    let spread = min(next_water >> vec4<u32>(5u), vec4<i32>(params.threshold));
    let shares = next_shares(
        flux(sides.west.returning, west_fall, spread), flux(sides.east.leaving, east_fall, spread),
        flux(sides.north.returning, north_fall, spread), flux(sides.south.leaving, south_fall, spread), next_water);
    return cells_of(slid - lifted, next_water, sediment + lifted, shares.across, shares.along);
}

// An amount after it has been exchanged with all neighbours.
fn gained(own: vec4<i32>, west: vec4<i32>, east: vec4<i32>, north: vec4<i32>, south: vec4<i32>) -> vec4<i32> {
    return own + west - east + north - south;
}

// A quarter of the discharge of a sample, and three quarters of the mean of what leaves its neighbours, given in eighths, so that
// streams are wider than a sample and run in any direction alike.
fn discharge(own: vec4<i32>, eighths: vec4<i32>) -> vec4<i32> {
    return (own >> vec4<u32>(2u)) + eighths + (eighths >> vec4<u32>(1u));
}

// The slope, in 1/4096, of a surface that falls so far to the lower neighbours across and along. It has the length of these two
// components, by the larger one and three eighths of the smaller one.
fn slope(across: vec4<i32>, along: vec4<i32>) -> vec4<i32> {
    let a = slope_of(across);
    let b = slope_of(along);
    return max(a, b) + ((min(a, b) * 3) >> vec4<u32>(3u));
}

fn slope_of(fall: vec4<i32>) -> vec4<i32> {
    let steps = clamp(fall, vec4<i32>(0), vec4<i32>(params.steepest)) >> vec4<u32>(params.slope_shift);
    return (steps * params.slope_factor) >> vec4<u32>(15u);
}

// The sediment that a discharge carries down a slope.
fn capacity(discharge: vec4<i32>, slope: vec4<i32>) -> vec4<i32> {
    let rate = min((slope * params.capacity) >> vec4<u32>(8u), vec4<i32>(0x40000));
    let driving = clamp(discharge - vec4<i32>(params.threshold), vec4<i32>(0), vec4<i32>(WATER_LIMIT));
    let high = driving >> vec4<u32>(12u);
    let low = ((driving & vec4<i32>(4095)) * rate) >> vec4<u32>(12u);
    // Without the one that is subtracted, the largest product would be 2^32.
    let product = vec4<u32>(high) * vec4<u32>(min(rate, vec4<i32>(0x40000) - (high >> vec4<u32>(14u))));
    return vec4<i32>(min(product + vec4<u32>(low), vec4<u32>(u32(SEDIMENT_LIMIT))));
}

// The ground that goes into suspension, or, below 0, the sediment that settles. Ground sinks no deeper than its lowest neighbour,
// and rises no higher than its highest or the water.
fn lifted(deepest: vec4<i32>, highest: vec4<i32>, water: vec4<i32>, lacking: vec4<i32>) -> vec4<i32> {
    let erodes = lacking > vec4<i32>(0);
    let moving = part(abs(lacking), select(vec4<i32>(params.deposition), vec4<i32>(params.erosion), erodes));
    let sunk = max(deepest, vec4<i32>(0)) >> vec4<u32>(3u);
    let risen = max(max(highest, vec4<i32>(0)) >> vec4<u32>(3u), water >> vec4<u32>(2u));
    return select(-min(moving, risen), min(moving, sunk), erodes);
}

// The flux of a pipe: it keeps half of what its share was, and takes a sixteenth of the fall. A thirty-second of the water, below
// the threshold, spreads through each, so that streams do not run along rows and columns.
fn flux(old: vec4<i32>, fall: vec4<i32>, spread: vec4<i32>) -> vec4<i32> {
    let pushed = old - (old >> vec4<u32>(1u)) + (fall >> vec4<u32>(4u)) + spread;
    return clamp(pushed, vec4<i32>(0), vec4<i32>(WATER_LIMIT));
}

struct Shares {
    across: vec4<i32>,
    along: vec4<i32>,
}

// The shares that leave next: all together give three quarters of the water at most, so that neighbouring samples do not
// exchange all of it from cycle to cycle.
fn next_shares(west: vec4<i32>, east: vec4<i32>, north: vec4<i32>, south: vec4<i32>, water: vec4<i32>) -> Shares {
    let whole = max(max(west + east + north + south, water), vec4<i32>(1));
    let shift = bits_beyond_16(whole);
    let inverse = inverse_of(whole >> shift);
    let bits = vec4<u32>(16u);
    return Shares(
        share(west, shift, inverse) | (share(east, shift, inverse) << bits),
        share(north, shift, inverse) | (share(south, shift, inverse) << bits));
}

// How many bits more than 16 numbers of 1 to 2^29 - 1 have. The exponent of a float tells it: without its last five bits a number is
// a float to the bit.
fn bits_beyond_16(numbers: vec4<i32>) -> vec4<u32> {
    let exponents = bitcast<vec4<i32>>(vec4<f32>(numbers >> vec4<u32>(5u))) >> vec4<u32>(23u);
    return vec4<u32>(max(exponents - vec4<i32>(137), vec4<i32>(0)));
}

fn share(flux: vec4<i32>, shift: vec4<u32>, inverse: vec4<u32>) -> vec4<i32> {
    return (vec4<i32>(((vec4<u32>(flux) >> shift) * inverse) >> vec4<u32>(16u)) * 3) >> vec4<u32>(2u);
}

// floor(2^31 / divisor) for divisors of 1 to 65535, exact whatever a device's floats do: integer division is slow where eight
// lanes share a processor's divider. The first quotient is wrong by 2^-20 of itself and by 2, at most, which leaves a rest below
// 2^11 + 2 * 65536 in size, whose own quotient is wrong by 1 at most.
fn inverse_of(divisor: vec4<i32>) -> vec4<u32> {
    let reciprocal = vec4<f32>(1.0) / vec4<f32>(divisor);
    let first = vec4<i32>(1073741824.0 * reciprocal) << vec4<u32>(1u);
    let rest = vec4<i32>(0x80000000u - vec4<u32>(first * divisor));
    let second = vec4<i32>(floor(vec4<f32>(rest) * reciprocal));
    let last = rest - second * divisor;
    let over = select(vec4<i32>(0), vec4<i32>(1), last >= divisor) - select(vec4<i32>(0), vec4<i32>(1), last < vec4<i32>(0));
    return vec4<u32>(first + second + over);
}

// floor(amount * share / 32768) for amounts of 0 to 2^30 and shares of 0 to 32768, or any amount and shares of at most 2048.
fn part(amounts: vec4<i32>, shares: vec4<i32>) -> vec4<i32> {
    let bits = vec4<u32>(15u);
    return (amounts >> bits) * shares + (((amounts & vec4<i32>(32767)) * shares) >> bits);
}
