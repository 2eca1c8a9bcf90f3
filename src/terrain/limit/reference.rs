//! The limit of erosion: the CPU reference of `kernels/terrain/limit.wgsl`.

/// A region within eroded heights.
#[derive(Debug, Clone, Copy)]
pub struct ErodedAt<'a> {
    /// The eroded heights, row by row.
    pub heights: &'a [i32],
    /// Number of heights in a row.
    pub width: usize,
    /// Index of the region's first height.
    pub corner: usize,
}

/// Heights of a square region: the eroded ones, each at most `most` from its height before erosion, in `origins`. No two heights may be
/// 2^31 or more apart.
pub fn limit(origins: &[i32], eroded: ErodedAt<'_>, most: i32) -> Vec<i32> {
    let width = origins.len().isqrt();
    let rows = (eroded.corner..).step_by(eroded.width);
    let cut = rows.take(width).flat_map(|first| &eroded.heights[first..first + width]);
    origins.iter().zip(cut).map(|(origin, height)| origin + (height - origin).clamp(-most, most)).collect()
}
