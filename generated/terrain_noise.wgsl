// relievo terrain/noise: generated from kernels/terrain/noise.wgsl

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

struct Words {
    first: vec4<u32>,
    second: vec4<u32>
}

fn rotate_left(value: vec4<u32>, bits: u32) -> vec4<u32> {
    return (value << vec4<u32>(bits)) | (value >> vec4<u32>(32u - bits));
}

fn mix_round(words: Words, bits: u32) -> Words {
    let first = words.first + words.second;
    return Words(first, rotate_left(words.second, bits) ^ first);
}

fn even_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 13u), 15u), 26u), 6u);
}

fn odd_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 17u), 29u), 16u), 24u);
}

fn inject_key(words: Words, first: u32, second: u32) -> Words {
    return Words(words.first + vec4<u32>(first), words.second + vec4<u32>(second));
}

fn threefry2x32(key: vec2<u32>, x: vec4<u32>, y: vec4<u32>) -> Words {
    let parity = 466688986u ^ key.x ^ key.y;
    var words = inject_key(Words(x, y), key.x, key.y);
    words = inject_key(even_rounds(words), key.y, parity + 1u);
    words = inject_key(odd_rounds(words), parity, key.x + 2u);
    words = inject_key(even_rounds(words), key.x, key.y + 3u);
    words = inject_key(odd_rounds(words), key.y, parity + 4u);
    return inject_key(even_rounds(words), parity, key.x + 5u);
}

override GENERATOR: u32 = NOISE_FBM;

const NOISE_FBM = 0u;

const NOISE_RIDGED = 1u;

const NOISE_SIMPLEX = 2u;

const NOISE_ONE = 134217728;

const GOLDEN = 2654435769u;

const SHIFT_Y = 2246822507u;

fn high_word(a: u32, b: u32) -> u32 {
    let a_low = a & 65535u;
    let a_high = a >> 16u;
    let b_low = b & 65535u;
    let b_high = b >> 16u;
    let middle = a_high * b_low + ((a_low * b_low) >> 16u);
    let carry = a_low * b_high + (middle & 65535u);
    return a_high * b_high + (middle >> 16u) + (carry >> 16u);
}

fn signed_high(a: i32, b: u32) -> i32 {
    return bitcast<i32>(high_word(bitcast<u32>(a), b) - select(0u, b, a < 0));
}

fn noise_times(noise: i32, factor: u32) -> i32 {
    return signed_high(noise << 2u, factor << 3u);
}

fn noise_mix(a: i32, b: i32, fade: u32) -> i32 {
    return a + signed_high((b - a) << 1u, fade);
}

fn noise_fade(fraction: u32) -> u32 {
    let t = fraction << 12u;
    let square = high_word(t, t);
    let factor = 2684354560u - 15u * (t >> 4u) + 6u * (square >> 4u);
    return high_word(high_word(square, t), factor) << 3u;
}

fn noise_sine(turn: vec4<u32>) -> vec4<i32> {
    let half = turn & vec4<u32>(32767u);
    let size = vec4<i32>((((half * (vec4<u32>(32768u) - half)) >> vec4<u32>(8u)) * 85u) >> vec4<u32>(19u));
    return select(-size, size, (turn & vec4<u32>(32768u)) == vec4<u32>(0u));
}

fn noise_ramps(words: Words, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let turn = words.first >> vec4<u32>(16u);
    return noise_sine(turn) * x + noise_sine(turn + vec4<u32>(16384u)) * y;
}

fn octave_key(key: vec2<u32>, octave: u32) -> vec2<u32> {
    return vec2<u32>(key.x, key.y + GOLDEN * (octave + 1u));
}

fn square_noise(key: vec2<u32>, log2: u32, at: vec2<u32>, has_values: bool) -> i32 {
    let spacing = 1u << log2;
    let cell = at & vec2<u32>(~(spacing - 1u));
    let words = threefry2x32(key, cell.x + vec4<u32>(0u, spacing, 0u, spacing), cell.y + vec4<u32>(0u, 0u, spacing, spacing));
    let fraction = (at & vec2<u32>(spacing - 1u)) << vec2<u32>(20u - log2);
    let x = i32(fraction.x) - vec4<i32>(0, 1048576, 0, 1048576);
    let y = i32(fraction.y) - vec4<i32>(0, 0, 1048576, 1048576);
    var corners = noise_ramps(words, x, y);
    if has_values {
        corners += vec4<i32>(words.second) >> vec4<u32>(5u);
    }
    let fade = noise_fade(fraction.x);
    let above = noise_mix(corners.x, corners.y, fade);
    return noise_mix(above, noise_mix(corners.z, corners.w, fade), noise_fade(fraction.y));
}

fn triangle_noise(key: vec2<u32>, octave: u32, log2: u32, at: vec2<u32>) -> i32 {
    let spacing = 1i << log2;
    let half = spacing / 2;
    let row_height = spacing / 8 * 7;
    let shift = (vec2<u32>(GOLDEN, SHIFT_Y) * (octave + 1u)) >> vec2<u32>(32u - log2);
    let x = at.x + shift.x;
    let y = at.y + 2147483648u + shift.y;
    let row = y / u32(row_height);
    let dy = i32(y - row * u32(row_height));
    var dx = i32((x - row * u32(half)) & u32(spacing - 1));
    var along = 7 * dx - 4 * dy;
    if along < 0 {
        along += 7 * spacing;
        dx += spacing;
    }
    let upper = along + 8 * dy >= 7 * spacing;
    let third = select(vec2<i32>(dx, dy), vec2<i32>(dx - spacing - half, dy - row_height), upper);
    let away_x = vec4<i32>(dx - spacing, dx - half, third.xx);
    let away_y = vec4<i32>(dy, dy - row_height, third.yy);
    let words = threefry2x32(key, x - vec4<u32>(away_x), y - vec4<u32>(away_y));
    let offset_x = away_x << vec4<u32>(20u - log2);
    let offset_y = away_y << vec4<u32>(20u - log2);
    let ramps = noise_ramps(words, offset_x, offset_y);
    let sum = near_part(ramps.x, offset_x.x, offset_y.x) + near_part(ramps.y, offset_x.y, offset_y.y) + near_part(ramps.z, offset_x.z, offset_y.z);
    return (sum * 11) >> 3u;
}

fn near_part(ramp: i32, x: i32, y: i32) -> i32 {
    let size_x = u32(abs(x)) << 11u;
    let size_y = u32(abs(y)) << 11u;
    let near = 805306368 - i32(high_word(size_x, size_x)) - i32(high_word(size_y, size_y));
    let limited = u32(max(near, 0)) << 2u;
    let square = high_word(limited, limited);
    return signed_high(ramp << 3u, high_word(square, square));
}

struct NoiseParams {
    key: vec2<u32>,
    width: u32,
    spacing: u32,
    base_log2: u32,
    octaves: u32,
    @align(16)
    ranges: array<vec4<u32>, 5>
}

@group(0) @binding(0)
var<uniform> params: NoiseParams;

@group(0) @binding(1)
var<storage, read> origins: array<vec2<i32>>;

@group(0) @binding(2)
var<storage, read_write> heights: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2<u32>(params.width)) {
        return;
    }
    let at = (vec2<u32>(origins[id.z]) + id.xy) * params.spacing;
    var height = 0;
    var weight = NOISE_ONE;
    let octaves = nonuniform(params.octaves, id.x);
    for (var octave = 0u; octave < octaves; octave++) {
        let log2 = params.base_log2 - octave;
        let key = octave_key(params.key, octave);
        var noise = 0;
        if GENERATOR == NOISE_SIMPLEX {
            noise = triangle_noise(key, octave, log2, at);
        }
        else {
            noise = square_noise(key, log2, at, GENERATOR == NOISE_RIDGED || octave == 0u);
        }
        if GENERATOR == NOISE_RIDGED {
            let size = abs(noise);
            noise = noise_times(NOISE_ONE - size, u32(weight));
            if octave == 0u {
                weight = NOISE_ONE - (size >> 1u);
            }
        }
        height += noise_times(noise, params.ranges[octave / 4u][octave % 4u]);
    }
    heights[(id.z * params.width + id.y) * params.width + id.x] = height;
}
