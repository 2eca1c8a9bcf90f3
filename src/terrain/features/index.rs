//! Index of features on the device. Every grid of the index has one bit per lattice point. For each 32-bit word of a grid, the
//! index also stores the position of the word's first value (`wgsl/terrain/features.wgsl`).

use crate::gpu::bind::Slice;
use crate::gpu::{Buffer, Gpu, GpuError, Upload};

/// One grid of the feature index: one bit per lattice point of each window.
pub use crate::shared::terrain::features::FeatureGrid;
use crate::shared::terrain::features::FeatureWord;

/// Index of the features of a batch of windows. It consists of grids of different widths and of the injected values.
#[derive(Debug, Clone)]
pub struct FeatureIndex {
    grids: Vec<FeatureGrid>,
    words: Buffer<FeatureWord>,
    heights: Buffer<i32>,
}

impl FeatureIndex {
    /// Allocates grids of the given widths for `windows` windows, and memory for `capacity` values in total. With a capacity of 0
    /// it allocates nothing; use that for kernels compiled without features.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, widths: &[u32], windows: u32, capacity: usize) -> Result<Self, GpuError> {
        if capacity > 0 {
            check_words(widths, windows)?;
        }
        let mut start = 0_u32;
        let grids = (widths.iter())
            .map(|&width| {
                let words_per_row = (width + 2).div_ceil(32);
                let grid = FeatureGrid {
                    width,
                    words_per_row,
                    words_per_window: words_per_row * (width + 2),
                    start,
                };
                // `start` can wrap only if `capacity` is 0. Kernels compiled without features never read these words.
                start = start.wrapping_add(grid.words_per_window.wrapping_mul(windows));
                grid
            })
            .collect();
        let words = if capacity == 0 { 0 } else { start as usize };
        Ok(Self {
            grids,
            words: Buffer::new(gpu, "feature words", words)?,
            heights: Buffer::new(gpu, "feature heights", capacity)?,
        })
    }

    /// Replaces all features. `points(grid, window)` returns (column, row, height), sorted by row and then column. Column 0
    /// and row 0 lie one point before the window's first point.
    ///
    /// # Errors
    /// [`GpuError::Limit`] when there are more features than the capacity.
    pub fn write(
        &self,
        to: &mut impl Upload,
        windows: u32,
        points: impl Fn(usize, u32) -> Vec<(u32, u32, i32)>,
    ) -> Result<(), GpuError> {
        if self.words.is_empty() {
            return Ok(());
        }
        let mut words = vec![FeatureWord { mask: 0, first_value: 0 }; self.words.len()];
        let mut heights = Vec::new();
        for (index, grid) in self.grids.iter().enumerate() {
            for window in 0..windows {
                let start = grid.start + window * grid.words_per_window;
                for (column, row, height) in points(index, window) {
                    let word = &mut words[(start + row * grid.words_per_row + column / 32) as usize];
                    if word.mask == 0 {
                        word.first_value = heights.len() as u32;
                    }
                    word.mask |= 1 << (column % 32);
                    heights.push(height);
                }
            }
        }
        if heights.len() > self.heights.len() {
            return Err(GpuError::Limit {
                pass: "terrain features",
                limit: "the capacity given at set-up",
                needed: heights.len() as u64,
                available: self.heights.len() as u64,
                remedy: "prepare the job with more room for features",
            });
        }
        to.elements(&self.words, 0, &words)?;
        to.elements(&self.heights, 0, &heights)
    }

    /// Grid number `index`, in the order of the widths given to `new`; an empty grid if there is no such grid.
    pub(crate) fn grid(&self, index: usize) -> FeatureGrid {
        let none = FeatureGrid { width: 0, words_per_row: 0, words_per_window: 0, start: 0 };
        self.grids.get(index).copied().unwrap_or(none)
    }

    pub(crate) fn words(&self) -> Slice<'_, FeatureWord> {
        self.words.slice()
    }

    pub(crate) fn heights(&self) -> Slice<'_, i32> {
        self.heights.slice()
    }

    /// Memory of the index on the device, in bytes.
    pub fn bytes(&self) -> u64 {
        self.words.bytes() + self.heights.bytes()
    }
}

/// Checks that the number of words in all grids fits a `u32`.
fn check_words(widths: &[u32], windows: u32) -> Result<(), GpuError> {
    let words = |width: &u32| (u128::from(*width) + 2).div_ceil(32) * (u128::from(*width) + 2);
    let needed = widths.iter().map(words).sum::<u128>() * u128::from(windows);
    if needed <= u128::from(u32::MAX) {
        return Ok(());
    }
    Err(GpuError::Limit {
        pass: "terrain features",
        limit: "feature words",
        needed: needed.min(u128::from(u64::MAX)) as u64,
        available: u32::MAX.into(),
        remedy: "split the batch",
    })
}
