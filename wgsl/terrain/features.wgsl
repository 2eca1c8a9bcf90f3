// Injected heights of a window (B section 3.3.1, feature injection). A grid has one bit per point, in rows of
// 32-bit words that cover one point more than the window on every side, and with each word the index of its
// first value. A lookup takes one load where there is no feature, and a population count where there is one.

const FEATURES_NONE = 0u;
const FEATURES_KEEP = 1u;
const FEATURES_ADDITIVE = 2u;

override FEATURES: u32 = 0u;

struct FeatureGrid {
    // Points along an edge of the window.
    width: u32,
    words_per_row: u32,
    words_per_window: u32,
    // Index of the word at which the grid's first window starts.
    start: u32,
}

struct FeatureWord {
    mask: u32,
    first_value: u32,
}

@group(1) @binding(0) var<storage, read> feature_words: array<FeatureWord>;
@group(1) @binding(1) var<storage, read> feature_heights: array<i32>;

// The word that holds the point. A point beyond the grid gets a word of the grid's rim.
fn feature_word(grid: FeatureGrid, window: u32, at: vec2<i32>) -> FeatureWord {
    let place = vec2<u32>(clamp(at + vec2<i32>(1), vec2<i32>(0), vec2<i32>(i32(grid.width) + 1)));
    return feature_words[
        grid.start + window * grid.words_per_window + place.y * grid.words_per_row + place.x / 32u];
}

// The bit of the point in its word; 0 beyond the grid.
fn feature_bit(grid: FeatureGrid, at: vec2<i32>) -> u32 {
    let place = vec2<u32>(at + vec2<i32>(1));
    return select(0u, 1u << (place.x % 32u), all(place < vec2<u32>(grid.width + 2u)));
}

fn has_feature(grid: FeatureGrid, window: u32, at: vec2<i32>) -> bool {
    return (feature_word(grid, window, at).mask & feature_bit(grid, at)) != 0u;
}

// A bit for each of 32 points of a row, starting at `at`: 0 where there is no feature. Bits of points beyond
// the grid are unspecified.
fn feature_bits(grid: FeatureGrid, window: u32, at: vec2<i32>) -> u32 {
    let first = feature_word(grid, window, at).mask;
    let last = feature_word(grid, window, at + vec2<i32>(31, 0)).mask;
    let shift = u32(at.x + 1) % 32u;
    return (first >> shift) | ((last << 1u) << (31u - shift));
}

// The height to inject at a point, if it has a feature.
struct Feature {
    there: bool,
    height: i32,
}

fn feature_at(grid: FeatureGrid, window: u32, at: vec2<i32>) -> Feature {
    let word = feature_word(grid, window, at);
    let bit = feature_bit(grid, at);
    if (word.mask & bit) == 0u {
        return Feature(false, 0);
    }
    return Feature(true, feature_heights[word.first_value + countOneBits(word.mask & (bit - 1u))]);
}

// The height of a point after injection, given the computed height.
fn injected(grid: FeatureGrid, window: u32, at: vec2<i32>, height: i32) -> i32 {
    return injected_lanes(feature_at(grid, window, at), vec4<bool>(true), vec4<i32>(height)).x;
}

// As `injected`, for the lanes that `lanes` selects.
fn injected_lanes(feature: Feature, lanes: vec4<bool>, heights: vec4<i32>) -> vec4<i32> {
    let value = select(heights, vec4<i32>(0), FEATURES == FEATURES_KEEP) + vec4<i32>(feature.height);
    return select(heights, value, lanes & vec4<bool>(feature.there));
}
