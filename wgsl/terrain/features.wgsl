// Injected heights of one window (B section 3.3.1, feature injection): a bit a point, in rows of 32-point
// words that cover one point more than the window on every side, and beside each word the index of its
// first value. A lookup is one load where there is nothing and a population count where there is.

const FEATURES_NONE = 0u;
const FEATURES_KEEP = 1u;
const FEATURES_ADDITIVE = 2u;

override FEATURES: u32 = 0u;

struct FeatureGrid {
    // Points along an edge of the window.
    width: u32,
    words_per_row: u32,
    words_per_window: u32,
    // Where the grid's first window starts.
    start: u32,
}

struct FeatureWord {
    mask: u32,
    first_value: u32,
}

@group(1) @binding(0) var<storage, read> feature_words: array<FeatureWord>;
@group(1) @binding(1) var<storage, read> feature_heights: array<i32>;

// The word that holds the point, and the point's bit in it; no bit for a point that the grid does not cover.
struct FeaturePlace {
    word: FeatureWord,
    bit: u32,
}

fn feature_place(grid: FeatureGrid, window: u32, at: vec2<i32>) -> FeaturePlace {
    let place = vec2<u32>(at + vec2<i32>(1));
    if any(place >= vec2<u32>(grid.width + 2u)) {
        return FeaturePlace(FeatureWord(0u, 0u), 0u);
    }
    let index = grid.start + window * grid.words_per_window + place.y * grid.words_per_row + place.x / 32u;
    return FeaturePlace(feature_words[index], 1u << (place.x % 32u));
}

fn has_feature(grid: FeatureGrid, window: u32, at: vec2<i32>) -> bool {
    let place = feature_place(grid, window, at);
    return (place.word.mask & place.bit) != 0u;
}

// The height of a point after injection, given the computed one.
fn injected(grid: FeatureGrid, window: u32, at: vec2<i32>, height: i32) -> i32 {
    let place = feature_place(grid, window, at);
    if (place.word.mask & place.bit) == 0u {
        return height;
    }
    let rank = countOneBits(place.word.mask & (place.bit - 1u));
    let value = feature_heights[place.word.first_value + rank];
    return select(height + value, value, FEATURES == FEATURES_KEEP);
}
