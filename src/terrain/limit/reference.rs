//! The limit of erosion: the CPU reference of `kernels/terrain/limit.wgsl`.

/// Keeps each of `heights` within `most` of its height before erosion, in `origins`. No two heights may be 2^31 or more apart.
pub fn limit(origins: &[i32], heights: &mut [i32], most: i32) {
    for (height, origin) in heights.iter_mut().zip(origins) {
        *height = origin + (*height - origin).clamp(-most, most);
    }
}
