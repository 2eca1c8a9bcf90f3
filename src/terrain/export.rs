//! Heights for use by other programs: hashes, and fields without their margins.

use crate::hash;

/// SHA-256 of the little-endian heights, as hexadecimal digits.
pub fn sha256(heights: &[i32]) -> String {
    hash::sha256(&heights.iter().map(|height| height.cast_unsigned()).collect::<Vec<_>>())
}

/// Copies a field with `width` samples per row without its outermost `samples` rings.
pub fn cropped(field: &[i32], width: usize, samples: usize) -> Vec<i32> {
    let inner = width - 2 * samples;
    let rows = field.chunks_exact(width).skip(samples).take(inner);
    rows.flat_map(|row| &row[samples..samples + inner]).copied().collect()
}
