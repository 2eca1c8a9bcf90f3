// Octaves of noise in integers (src/terrain/noise/mod.rs derives the bounds). Noise values are in Q4.27. The four lanes of a
// vector are the lattice points around a sample.
import package::wgsl::hash::{Words, threefry2x32};

// Generator of the pipeline: one of the constants NOISE_*.
override GENERATOR: u32 = NOISE_FBM;

// Generator: fractional Brownian motion over gradient noise.
const NOISE_FBM = 0u;
// Generator: ridged multifractal over gradient noise with random values.
const NOISE_RIDGED = 1u;
// Generator: fractional Brownian motion over simplex noise.
const NOISE_SIMPLEX = 2u;
// 1 as a noise value.
const NOISE_ONE = 0x8000000;
// 2^32 divided by the golden ratio.
const GOLDEN = 0x9e3779b9u;
// Multiplier of the vertical positions of triangular lattices.
const SHIFT_Y = 0x85ebca6bu;

// High 32 bits of the 64-bit product of two words.
fn high_word(a: u32, b: u32) -> u32 {
    let a_low = a & 0xffffu;
    let a_high = a >> 16u;
    let b_low = b & 0xffffu;
    let b_high = b >> 16u;
    let middle = a_high * b_low + ((a_low * b_low) >> 16u);
    let carry = a_low * b_high + (middle & 0xffffu);
    return a_high * b_high + (middle >> 16u) + (carry >> 16u);
}

// a * b / 2^32 for a signed and an unsigned number, rounded down.
fn signed_high(a: i32, b: u32) -> i32 {
    return bitcast<i32>(high_word(bitcast<u32>(a), b) - select(0u, b, a < 0));
}

// noise * factor / 2^27 for a noise value below 4 in size and a factor below 2^29, rounded down.
fn noise_times(noise: i32, factor: u32) -> i32 {
    return signed_high(noise << 2u, factor << 3u);
}

// A value between a and b; `fade` is in Q.31.
fn noise_mix(a: i32, b: i32, fade: u32) -> i32 {
    return a + signed_high((b - a) << 1u, fade);
}

// The fade 6t^5 - 15t^4 + 10t^3 (Perlin 2002) of a fraction in Q.20, in Q.31.
fn noise_fade(fraction: u32) -> u32 {
    let t = fraction << 12u;
    let square = high_word(t, t);
    let factor = 0xa0000000u - 15u * (t >> 4u) + 6u * (square >> 4u);
    return high_word(high_word(square, t), factor) << 3u;
}

// A parabola in place of a sine, with the largest value 170 / 128 (Q.7). 65536 is a whole turn.
fn noise_sine(turn: vec4<u32>) -> vec4<i32> {
    let half = turn & vec4<u32>(0x7fffu);
    let size = vec4<i32>((((half * (vec4<u32>(0x8000u) - half)) >> vec4<u32>(8u)) * 85u) >> vec4<u32>(19u));
    return select(-size, size, (turn & vec4<u32>(0x8000u)) == vec4<u32>(0u));
}

// Products of the lattice points' gradients and the offsets from these points (Q.20).
fn noise_ramps(words: Words, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let turn = words.first >> vec4<u32>(16u);
    return noise_sine(turn) * x + noise_sine(turn + vec4<u32>(0x4000u)) * y;
}

// Key of an octave's random words.
fn octave_key(key: vec2<u32>, octave: u32) -> vec2<u32> {
    return vec2<u32>(key.x, key.y + GOLDEN * (octave + 1u));
}

// Gradient noise at a world position, on the square lattice of spacing 2^`log2`; with `has_values`, plus interpolated random
// values of the lattice points, within 1/2.
fn square_noise(key: vec2<u32>, log2: u32, at: vec2<u32>, has_values: bool) -> i32 {
    let spacing = 1u << log2;
    let cell = at & vec2<u32>(~(spacing - 1u));
    let words = threefry2x32(
        key, cell.x + vec4<u32>(0u, spacing, 0u, spacing), cell.y + vec4<u32>(0u, 0u, spacing, spacing));
    let fraction = (at & vec2<u32>(spacing - 1u)) << vec2<u32>(20u - log2);
    let x = i32(fraction.x) - vec4<i32>(0, 0x100000, 0, 0x100000);
    let y = i32(fraction.y) - vec4<i32>(0, 0, 0x100000, 0x100000);
    var corners = noise_ramps(words, x, y);
    if has_values {
        corners += vec4<i32>(words.second) >> vec4<u32>(5u);
    }
    let fade = noise_fade(fraction.x);
    let above = noise_mix(corners.x, corners.y, fade);
    return noise_mix(above, noise_mix(corners.z, corners.w, fade), noise_fade(fraction.y));
}

// Simplex noise at a world position. The lattice has the basis (8, 0), (4, 7) in units of an eighth of 2^`log2`, which is at
// least 8.
fn triangle_noise(key: vec2<u32>, octave: u32, log2: u32, at: vec2<u32>) -> i32 {
    let spacing = 1i << log2;
    let half = spacing / 2;
    let row_height = spacing / 8 * 7;
    let shift = (vec2<u32>(GOLDEN, SHIFT_Y) * (octave + 1u)) >> vec2<u32>(32u - log2);
    let x = at.x + shift.x;
    let y = at.y + 0x80000000u + shift.y;
    let row = y / u32(row_height);
    let dy = i32(y - row * u32(row_height));
    var dx = i32((x - row * u32(half)) & u32(spacing - 1));
    // 7 times the distance along the row from the last edge that leads to the next row.
    var along = 7 * dx - 4 * dy;
    if along < 0 {
        along += 7 * spacing;
        dx += spacing;
    }
    // The first two points belong to both triangles of a cell. The fourth lane is unused.
    let upper = along + 8 * dy >= 7 * spacing;
    let third = select(vec2<i32>(dx, dy), vec2<i32>(dx - spacing - half, dy - row_height), upper);
    let away_x = vec4<i32>(dx - spacing, dx - half, third.xx);
    let away_y = vec4<i32>(dy, dy - row_height, third.yy);
    let words = threefry2x32(key, x - vec4<u32>(away_x), y - vec4<u32>(away_y));
    let offset_x = away_x << vec4<u32>(20u - log2);
    let offset_y = away_y << vec4<u32>(20u - log2);
    let ramps = noise_ramps(words, offset_x, offset_y);
    let sum = near_part(ramps.x, offset_x.x, offset_y.x) + near_part(ramps.y, offset_x.y, offset_y.y)
        + near_part(ramps.z, offset_x.z, offset_y.z);
    return (sum * 11) >> 3u;
}

// Contribution of a lattice point at an offset (x, y) (Q.20) to simplex noise: its ramp times (3/4 - x^2 - y^2)^4, in Q1.30.
fn near_part(ramp: i32, x: i32, y: i32) -> i32 {
    let size_x = u32(abs(x)) << 11u;
    let size_y = u32(abs(y)) << 11u;
    let near = 0x30000000 - i32(high_word(size_x, size_x)) - i32(high_word(size_y, size_y));
    let limited = u32(max(near, 0)) << 2u;
    let square = high_word(limited, limited);
    return signed_high(ramp << 3u, high_word(square, square));
}
