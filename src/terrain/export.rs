//! Helpers for exporting heights to other programs: hashes, and copies of fields without their margins.

use crate::hash;

/// SHA-256 of the heights as little-endian bytes, in hexadecimal digits.
pub fn sha256(heights: &[i32]) -> String {
    hash::sha256(&heights.iter().map(|height| height.cast_unsigned()).collect::<Vec<_>>())
}

/// Copies a field with `width` samples per row, without the outermost `samples` rings of samples.
pub fn cropped(field: &[i32], width: usize, samples: usize) -> Vec<i32> {
    let inner = width - 2 * samples;
    let rows = field.chunks_exact(width).skip(samples).take(inner);
    rows.flat_map(|row| &row[samples..samples + inner]).copied().collect()
}
