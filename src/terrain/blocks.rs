//! The host's side of `wgsl/terrain/blocks.wgsl`: how a batch of windows is cut into the blocks that threads make.

use crate::gpu::{Gpu, Kernel, Tuning};
pub(crate) use crate::shared::terrain::blocks::Blocks;
use crate::terrain::fields::Fields;

/// Rows of a block. Software adapters run few long threads best, hardware many short ones.
const ROWS_SOFTWARE: u32 = 43;
const ROWS_HARDWARE: u32 = 4;
/// The same where neighbouring threads make the blocks of a column.
const ROWS_DOWNWARDS: u32 = 16;

/// The rows of a block that suit a device.
pub(crate) fn rows(tuning: Tuning) -> u32 {
    if tuning.wants_long_threads() { ROWS_SOFTWARE } else { ROWS_HARDWARE }
}

/// The rows of blocks, and which of them neighbouring threads make (`wgsl/terrain/order.wgsl`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// Rows of a block, at least 1.
    pub rows: u32,
    /// Whether neighbouring threads make the blocks of a column, not of a row.
    pub downwards: bool,
}

impl Order {
    /// For software adapters.
    pub const SOFTWARE: Self = Self { rows: ROWS_DOWNWARDS, downwards: true };
    /// For hardware.
    pub const HARDWARE: Self = Self { rows: ROWS_HARDWARE, downwards: false };

    /// What suits a device.
    pub fn of(tuning: Tuning) -> Self {
        if tuning.wants_long_threads() { Self::SOFTWARE } else { Self::HARDWARE }
    }
}

/// What a thread makes of windows (`wgsl/terrain/columns.wgsl`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    /// Vectors of four samples along a row: 1 or 4.
    pub quads: u32,
    /// Its rows, and the order of threads.
    pub order: Order,
}

impl Columns {
    const SOFTWARE: Self = Self { quads: 4, order: Order::SOFTWARE };
    const HARDWARE: Self = Self { quads: 1, order: Order::HARDWARE };

    /// What suits a device.
    pub(crate) fn of(tuning: Tuning) -> Self {
        if tuning.wants_long_threads() { Self::SOFTWARE } else { Self::HARDWARE }
    }

    /// What suits software adapters, and hardware.
    pub const ALL: [Self; 2] = [Self::SOFTWARE, Self::HARDWARE];

    /// The blocks of windows that lose their outermost ring.
    pub fn blocks(self, windows: &Fields) -> Blocks {
        Blocks::of_squares(windows.cropped(1).width, 4 * self.quads, self.order.rows, windows.count)
    }

    /// As [`Columns::blocks`], where outputs at the end of a row that make no whole vector belong to the last column.
    pub(crate) fn blocks_of_whole_vectors(self, windows: &Fields) -> Blocks {
        let width = windows.cropped(1).width;
        let columns = (width / 4).max(1).div_ceil(self.quads);
        Blocks::new([columns, width.div_ceil(self.order.rows)], self.order.rows, windows.count)
    }
}

impl Blocks {
    /// Blocks of `rows` rows, of which `columns` lie beside each other and `below` below each other in each window.
    pub(crate) fn new([columns, below]: [u32; 2], rows: u32, windows: u32) -> Self {
        let per_window = columns * below;
        Self { per_row: columns, per_window, count: per_window * windows, rows }
    }

    /// Blocks that cut squares of `edge` samples into columns of `width`.
    pub(crate) fn of_squares(edge: u32, width: u32, rows: u32, windows: u32) -> Self {
        Self::new([edge.div_ceil(width), edge.div_ceil(rows)], rows, windows)
    }

    /// Blocks of `width` columns that do not cross from a rim of `rim` samples into the `inside` samples of an edge.
    pub(crate) fn with_rim([rim, inside]: [u32; 2], width: u32, rows: u32, windows: u32) -> Self {
        let along = |length: u32| 2 * rim.div_ceil(length) + inside.div_ceil(length);
        Self::new([along(width), along(rows)], rows, windows)
    }

    /// The workgroups that give each block a thread.
    pub fn workgroups(&self, gpu: &Gpu, kernel: &Kernel) -> [u32; 3] {
        kernel.spread(gpu, self.count)
    }
}
