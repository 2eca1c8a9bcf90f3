// Random offset of a height (i32, Q15.16), computed from the random words for the height's world coordinates.
import package::wgsl::hash::Words;
import package::wgsl::terrain::fixed::multiply_high;

// Distribution of offsets: uniform in ±range.
const OFFSET_SIGNED = 0u;
// Distribution of offsets: uniform in 0 to range.
const OFFSET_POSITIVE = 1u;
// Distribution of offsets: nearly Gaussian in ±range.
const OFFSET_GAUSSIAN = 2u;

// Four random offsets in 1/65536 units. `distribution` is one of the constants above. `range` has the same units and is at most
// 2^30, so that twice the range fits in 32 bits.
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

// Sum of four 16-bit uniform numbers (nearly Gaussian), scaled to 32 bits and centered on 2^31, per lane.
fn sum_of_halves(words: Words) -> vec4<u32> {
    let low = vec4<u32>(0xffffu);
    let half = vec4<u32>(16u);
    let sum = (words.first & low) + (words.first >> half) + (words.second & low) + (words.second >> half);
    return (sum << vec4<u32>(14u)) + vec4<u32>(0x8000u);
}
