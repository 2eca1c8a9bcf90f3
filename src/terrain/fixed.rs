//! Exact integer arithmetic on heights: the CPU reference of `wgsl/terrain/fixed.wgsl` and `wgsl/terrain/offset.wgsl`.

use crate::hash::{LANES, threefry2x32};
#[cfg(feature = "gpu")]
use crate::shared::terrain::features;
use crate::terrain::config::{Offset, TerrainConfig};

/// Mean of four heights, rounded half up.
#[inline(always)]
pub fn mean_of_four(a: i32, b: i32, c: i32, d: i32) -> i32 {
    (a >> 2) + (b >> 2) + (c >> 2) + (d >> 2) + (((a & 3) + (b & 3) + (c & 3) + (d & 3) + 2) >> 2)
}

/// Four-point interpolation: (9 (b + c) − (a + d)) / 16, rounded half up. Inputs must not exceed 1.25 · 2^30 in size.
#[inline(always)]
pub fn four_point(a: i32, b: i32, c: i32, d: i32) -> i32 {
    let whole = 9 * ((b >> 4) + (c >> 4)) - ((a >> 4) + (d >> 4));
    whole + ((9 * ((b & 15) + (c & 15)) - ((a & 15) + (d & 15)) + 8) >> 4)
}

/// Mean of two heights, rounded half up.
#[inline(always)]
pub fn mean_of_two(a: i32, b: i32) -> i32 {
    (a >> 1) + (b >> 1) + (((a & 1) + (b & 1) + 1) >> 1)
}

/// Upper 32 bits of the 64-bit product of two words.
#[inline(always)]
pub fn multiply_high(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}

/// Generator of random height offsets, for one seed and one distribution.
#[derive(Debug, Clone, Copy)]
pub struct Draw {
    key: [u32; 2],
    offset: Offset,
}

impl Draw {
    /// Creates the generator with the seed and the distribution of a configuration.
    pub fn new(config: &TerrainConfig) -> Self {
        Self { key: config.key(), offset: config.offset }
    }

    /// Adds a random offset to each height. `heights[i]` belongs to the point (x + i·step, y) in world coordinates. `range` is
    /// the offsets' range in 1/65536 height units.
    pub(crate) fn add_row(&self, heights: &mut [i32], range: u32, x: u32, step: u32, y: u32) {
        for (chunk, row) in heights.chunks_mut(LANES).enumerate() {
            let start = x.wrapping_add(step.wrapping_mul((chunk * LANES) as u32));
            let columns = std::array::from_fn(|lane| start.wrapping_add(step.wrapping_mul(lane as u32)));
            let (first, second) = threefry2x32(self.key, columns, [y; LANES]);
            let offsets: [i32; LANES] =
                std::array::from_fn(|lane| self.offset_of(range, first[lane], second[lane]));
            for (height, offset) in row.iter_mut().zip(offsets) {
                *height += offset;
            }
        }
    }

    /// Random height offset of a point, computed from the point's two random words. The constants are deliberately not shared
    /// with the shader. Tests compare both copies with heights from independent programs.
    #[inline(always)]
    fn offset_of(&self, range: u32, first: u32, second: u32) -> i32 {
        let uniform = match self.offset {
            Offset::Positive => return multiply_high(first, range) as i32,
            Offset::Signed => first,
            Offset::Gaussian => {
                let sum = (first & 0xffff) + (first >> 16) + (second & 0xffff) + (second >> 16);
                (sum << 14) + 0x8000
            }
        };
        multiply_high(uniform, 2 * range) as i32 - range as i32
    }
}

/// How an injected height (feature) changes the computed height of its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FeatureMode {
    /// The feature's height replaces the computed height.
    #[default]
    Keep,
    /// The feature's height is added to the computed height.
    Additive,
}

impl FeatureMode {
    /// Value of the shaders' constant `FEATURES` for a mode; `None`: without features.
    #[cfg(feature = "gpu")]
    pub(crate) fn code_of(mode: Option<Self>) -> u32 {
        match mode {
            None => 0,
            Some(Self::Keep) => features::FEATURES_KEEP,
            Some(Self::Additive) => features::FEATURES_ADDITIVE,
        }
    }
}

/// Height of a point after a feature's height has been injected.
pub(crate) fn inject(mode: FeatureMode, computed: i32, feature: i32) -> i32 {
    match mode {
        FeatureMode::Keep => feature,
        FeatureMode::Additive => computed + feature,
    }
}
