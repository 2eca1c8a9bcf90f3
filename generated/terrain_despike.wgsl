// relievo terrain/despike: generated from kernels/terrain/despike.wgsl

const FEATURES_NONE = 0u;

const FEATURES_KEEP = 1u;

const FEATURES_ADDITIVE = 2u;

override FEATURES: u32 = 0u;

struct FeatureGrid {
    width: u32,
    words_per_row: u32,
    words_per_window: u32,
    start: u32
}

struct FeatureWord {
    mask: u32,
    first_value: u32
}

@group(1) @binding(0)
var<storage, read> feature_words: array<FeatureWord>;

@group(1) @binding(1)
var<storage, read> feature_heights: array<i32>;

fn feature_word(grid: FeatureGrid, window: u32, at: vec2<i32>) -> FeatureWord {
    let place = vec2<u32>(clamp(at + vec2<i32>(1), vec2<i32>(0), vec2<i32>(i32(grid.width) + 1)));
    return feature_words[grid.start + window * grid.words_per_window + place.y * grid.words_per_row + place.x / 32u];
}

fn feature_bit(at: vec2<i32>) -> u32 {
    return 1u << (u32(at.x + 1) % 32u);
}

fn has_feature(grid: FeatureGrid, window: u32, at: vec2<i32>) -> bool {
    return (feature_word(grid, window, at).mask & feature_bit(at)) != 0u;
}

fn injected(grid: FeatureGrid, window: u32, at: vec2<i32>, height: i32) -> i32 {
    let word = feature_word(grid, window, at);
    let bit = feature_bit(at);
    if (word.mask & bit) == 0u {
        return height;
    }
    let feature = feature_heights[word.first_value + countOneBits(word.mask & (bit - 1u))];
    return select(height, 0, FEATURES == FEATURES_KEEP) + feature;
}

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

struct DespikeParams {
    features: FeatureGrid,
    width: u32,
    threshold: i32
}

@group(0) @binding(0)
var<uniform> params: DespikeParams;

@group(0) @binding(2)
var<storage, read_write> outputs: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let at = sample_index(params.width, id);
    let height = windows[at];
    let mean = mean_of_four(vec4<i32>(windows[at - 1u]), vec4<i32>(windows[at + 1u]), vec4<i32>(windows[at - params.width]), vec4<i32>(windows[at + params.width])).x;
    var is_spike = abs(height - mean) > params.threshold;
    if FEATURES != FEATURES_NONE {
        is_spike = is_spike && !has_feature(params.features, id.z, vec2<i32>(id.xy + vec2<u32>(1u)));
    }
    outputs[inner_index(params.width, id)] = select(height, mean, is_spike);
}
