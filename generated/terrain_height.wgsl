// relievo terrain/height: generated from kernels/terrain/height.wgsl

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

override DISTRIBUTION: u32 = 0u;

struct Level {
    key: vec2<u32>,
    fine_width: u32,
    coarse_width: u32,
    spacing: u32,
    range: u32,
    edge_range: u32,
    @align(16)
    features: FeatureGrid
}

@group(0) @binding(0)
var<uniform> level: Level;

@group(0) @binding(1)
var<storage, read> origins: array<vec2<i32>>;

@group(0) @binding(2)
var<storage, read> coarse: array<i32>;

@group(0) @binding(3)
var<storage, read_write> fine: array<i32>;

fn has_point(id: vec3<u32>) -> bool {
    return all(id.xy <= vec2<u32>(level.fine_width / 2u));
}

fn coarse_points(window: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let last = vec4<i32>(i32(level.coarse_width) - 1);
    let rows = window * level.coarse_width + vec4<u32>(clamp(y, vec4<i32>(0), last));
    let at = rows * level.coarse_width + vec4<u32>(clamp(x, vec4<i32>(0), last));
    return vec4<i32>(coarse[at.x], coarse[at.y], coarse[at.z], coarse[at.w]);
}

fn offsets(range: u32, x: vec4<i32>, y: vec4<i32>) -> vec4<i32> {
    let words = threefry2x32(level.key, vec4<u32>(x) * level.spacing, vec4<u32>(y) * level.spacing);
    return height_offset(DISTRIBUTION, range, words);
}

fn injected_four(window: u32, x: vec4<i32>, y: vec4<i32>, heights: vec4<i32>) -> vec4<i32> {
    var result = heights;
    if FEATURES != FEATURES_NONE {
        for (var lane = 0u; lane < 4u; lane++) {
            result[lane] = injected(level.features, window, vec2<i32>(x[lane], y[lane]), heights[lane]);
        }
    }
    return result;
}

fn store_four(window: u32, at: vec2<i32>, heights: vec4<i32>) {
    store(window, at, heights.x);
    store(window, at + vec2<i32>(1, 0), heights.y);
    store(window, at + vec2<i32>(0, 1), heights.z);
    store(window, at + vec2<i32>(1, 1), heights.w);
}

fn store(window: u32, at: vec2<i32>, height: i32) {
    let width = level.fine_width;
    if all(vec2<u32>(at) < vec2<u32>(width)) {
        fine[(window * width + u32(at.y)) * width + u32(at.x)] = height;
    }
}

const OFFSET_SIGNED = 0u;

const OFFSET_POSITIVE = 1u;

const OFFSET_GAUSSIAN = 2u;

fn height_offset(distribution: u32, range: u32, words: Words) -> vec4<i32> {
    if distribution == OFFSET_POSITIVE {
        return vec4<i32>(multiply_high(words.first, range));
    }
    var uniform_word = words.first;
    if distribution == OFFSET_GAUSSIAN {
        uniform_word = sum_of_halves(words);
    }
    return vec4<i32>(multiply_high(uniform_word, 2u * range)) - vec4<i32>(i32(range));
}

fn sum_of_halves(words: Words) -> vec4<u32> {
    let low = vec4<u32>(65535u);
    let half = vec4<u32>(16u);
    let sum = (words.first & low) + (words.first >> half) + (words.second & low) + (words.second >> half);
    return (sum << vec4<u32>(14u)) + vec4<u32>(32768u);
}

@compute @workgroup_size(16, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !has_point(id) {
        return;
    }
    let window = id.z;
    let shift = 2 - (origins[window] & vec2<i32>(1));
    let cell = vec2<i32>(id.xy) + shift - 1;
    let at = 2 * cell - shift;
    let x = cell.x - vec4<i32>(0, 1, 0, 0);
    let y = cell.y - vec4<i32>(0, 0, 1, 0);
    let centers = drawn(window, 2 * x - shift.x + 1, 2 * y - shift.y + 1, mean_of_four(coarse_points(window, x, y), coarse_points(window, x + 1, y), coarse_points(window, x, y + 1), coarse_points(window, x + 1, y + 1)));
    let corners = coarse_points(window, cell.x + vec4<i32>(0, 1, 0, 0), cell.y + vec4<i32>(0, 0, 1, 0));
    let edges = drawn(window, at.x + vec4<i32>(1, 0, 0, 0), at.y + vec4<i32>(0, 1, 0, 0), mean_of_four(vec4<i32>(corners.x), corners.yzzz, centers.zyyy, vec4<i32>(centers.x)));
    store_four(window, at, vec4<i32>(corners.x, edges.x, edges.y, centers.x));
}

fn drawn(window: u32, x: vec4<i32>, y: vec4<i32>, means: vec4<i32>) -> vec4<i32> {
    let origin = origins[window];
    return injected_four(window, x, y, means + offsets(level.range, origin.x + x, origin.y + y));
}
