// Injected heights of a window (B section 3.3.1, feature injection). A grid has one bit per point, in rows of
// 32-bit words. It covers one point more than the window on every side. Each word comes with the index of its first
// value. A lookup takes one load where there is no feature, and a population count where there is one.

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

// The height of a point after injection, given the computed height.
fn injected(grid: FeatureGrid, window: u32, at: vec2<i32>, height: i32) -> i32 {
    let word = feature_word(grid, window, at);
    let bit = feature_bit(grid, at);
    if (word.mask & bit) == 0u {
        return height;
    }
    let feature = feature_heights[word.first_value + countOneBits(word.mask & (bit - 1u))];
    return select(height, 0, FEATURES == FEATURES_KEEP) + feature;
}
