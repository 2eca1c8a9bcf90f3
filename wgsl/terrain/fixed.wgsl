// Exact integer arithmetic of terrain heights (i32, Q15.16). No operation overflows for heights within the bound that the host
// checks, 2^30 - 1. Every device therefore gives the same bits.

// One world unit of height, in 1/65536 units.
const HEIGHT_ONE: i32 = 65536;
// Largest absolute height, in 1/65536 units.
const HEIGHT_LIMIT: i32 = 0x3fffffff;

// Mean of four heights, rounded half up, for four lanes at once. The sum of two heights is 2p + x, and the sum of the other two
// is 2q + y, with x and y in {0, 1}. The mean is then floor((p + q + 1 + (x & y)) / 2). No step overflows for heights of at
// most 2^30 - 1.
fn mean_of_four(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    let first = a + b;
    let second = c + d;
    let carry = (first & second & vec4<i32>(1)) + vec4<i32>(1);
    return ((first >> one) + (second >> one) + carry) >> one;
}

// High 32 bits of the 64-bit product a * b, per lane.
fn multiply_high(a: vec4<u32>, b: u32) -> vec4<u32> {
    let low = vec4<u32>(0xffffu);
    let half = vec4<u32>(16u);
    let a_low = a & low;
    let a_high = a >> half;
    let b_low = b & 0xffffu;
    let b_high = b >> 16u;
    let middle = a_high * b_low + ((a_low * b_low) >> half);
    let carry = a_low * b_high + (middle & low);
    return a_high * b_high + (middle >> half) + (carry >> half);
}

// (9 (b + c) − (a + d)) / 16, rounded half up: the value halfway between b and c on the cubic through four values (Dyn, Levin
// and Gregory 1987). For heights, the result is at most 1.25 · 2^30. No step overflows for values up to this bound, so results
// may be interpolated again.
fn four_point(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let four = vec4<u32>(4u);
    let low = vec4<i32>(15);
    let whole = 9 * ((b >> four) + (c >> four)) - ((a >> four) + (d >> four));
    return whole + ((9 * ((b & low) + (c & low)) - ((a & low) + (d & low)) + 8) >> four);
}

// Mean of two heights, rounded half up, for four lanes at once.
fn mean_of_two(a: vec4<i32>, b: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    return (a >> one) + (b >> one) + (((a & vec4<i32>(1)) + (b & vec4<i32>(1)) + 1) >> one);
}

// Heights clamped to ±`HEIGHT_LIMIT`.
fn limited(heights: vec4<i32>) -> vec4<i32> {
    return max(min(heights, vec4<i32>(HEIGHT_LIMIT)), vec4<i32>(-HEIGHT_LIMIT));
}
