// Features: heights that are injected into a window (thesis B section 3.3.1, feature injection). A feature grid has one bit per
// point, in rows of 32-bit words. The grid covers one point more than the window on every side. Each word comes with the index of
// its first feature's height. Without a feature, a lookup takes one load. With a feature, it also takes a population count and
// the load of the height.

// Feature mode: no features.
const FEATURES_NONE = 0u;
// Feature mode: a feature's height replaces the computed height.
const FEATURES_KEEP = 1u;
// Feature mode: a feature's height is added to the computed height.
const FEATURES_ADDITIVE = 2u;

// Feature mode: one of the constants above.
override FEATURES: u32 = 0u;

// Size and location of the feature grids of a batch of windows.
struct FeatureGrid {
    // Number of points along an edge of the window.
    width: u32,
    // Number of 32-bit words per row of a grid.
    words_per_row: u32,
    // Number of words in the grid of one window.
    words_per_window: u32,
    // Index of the word at which the grid of the first window starts.
    start: u32,
}

// 32 points of a feature grid.
struct FeatureWord {
    // One bit per point: 1 if the point has a feature.
    mask: u32,
    // Index in `feature_heights` of the height of the word's first feature.
    first_value: u32,
}

// Words of all feature grids.
@group(1) @binding(0) var<storage, read> feature_words: array<FeatureWord>;
// Heights of the features, in 1/65536 world units.
@group(1) @binding(1) var<storage, read> feature_heights: array<i32>;

// Word of the grid that contains a point. A point beyond the grid gets a word of the grid's rim; nothing that is stored depends on
// such a point.
fn feature_word(grid: FeatureGrid, window: u32, at: vec2<i32>) -> FeatureWord {
    let place = vec2<u32>(clamp(at + vec2<i32>(1), vec2<i32>(0), vec2<i32>(i32(grid.width) + 1)));
    return feature_words[
        grid.start + window * grid.words_per_window + place.y * grid.words_per_row + place.x / 32u];
}

// Bit of a point in its word, as a mask.
fn feature_bit(at: vec2<i32>) -> u32 {
    return 1u << (u32(at.x + 1) % 32u);
}

// Whether a point of a window has a feature.
fn has_feature(grid: FeatureGrid, window: u32, at: vec2<i32>) -> bool {
    return (feature_word(grid, window, at).mask & feature_bit(at)) != 0u;
}

// Height of a point after injection. `height` is the computed height.
fn injected(grid: FeatureGrid, window: u32, at: vec2<i32>, height: i32) -> i32 {
    let word = feature_word(grid, window, at);
    let bit = feature_bit(at);
    if (word.mask & bit) == 0u {
        return height;
    }
    let feature = feature_heights[word.first_value + countOneBits(word.mask & (bit - 1u))];
    return select(height, 0, FEATURES == FEATURES_KEEP) + feature;
}
