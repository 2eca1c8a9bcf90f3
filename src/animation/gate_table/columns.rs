//! Motion of one bone along a clip, as a column of a gate table.

use super::{BoneErrorBudget, EVERYTHING};
use crate::animation::motion::{BoneMotion, Path};

/// Motion of one bone along a clip: a column of a gate table.
pub(super) struct Column {
    /// Path length of the points that follow the bone, in the unit in which the table's motion is measured.
    pub(super) path: Path,
    /// Fraction of the error budget left by the bone's ancestors, 0 to 1.
    pub(super) fraction: f64,
}

impl Column {
    fn new(bone: &BoneMotion, levers: &[f64; 3]) -> Self {
        let weighed = |of: &dyn Fn(&Path) -> f64| {
            bone.parts.iter().zip(levers).map(|(part, lever)| lever * of(part)).sum::<f64>()
        };
        let times = bone.parts[0].rises.len();
        let path = Path {
            rises: (0..times).map(|at| weighed(&|path| path.rises[at])).collect(),
            jumps: (0..times).map(|at| weighed(&|path| path.jumps[at])).collect(),
            wrap: weighed(&|path| path.wrap),
            is_boundless: bone.parts.iter().any(|path| path.is_boundless),
        };
        Self { path, fraction: 0.0 }
    }

    /// Writes the column into a table with `stride` entries per row, in multiples of `unit`.
    ///
    /// Rounding: sums at row starts are rounded to nearest, rises are rounded up, and interpolated sums are rounded down. The
    /// difference of two sums is thus at most 4 units too small. Two more errors come from the fraction of a segment. It is
    /// truncated to 16 bits, which loses up to 2⁻¹⁶ of the segment, and the division that computes it may round. For two sums,
    /// these two errors total less than 2⁻¹² of the steepest segment. The quantization slack is a power of two that covers them
    /// and the 4 units.
    pub(super) fn write(&self, table: &mut [[u32; 2]], stride: usize, unit: f64) {
        let mut sum = 0.0;
        let mut steepest = 0.0_f64;
        for (row, (rise, jump)) in self.path.rises.iter().zip(&self.path.jumps).enumerate() {
            sum += jump;
            table[row * stride] = [(sum / unit).round() as u32, (rise / unit).ceil() as u32];
            sum += rise;
            steepest = steepest.max(rise / unit);
        }
        let slack = match self.path.is_boundless {
            true => EVERYTHING,
            false if self.path.total() > 0.0 => (4 + (steepest / 4096.0).ceil() as u32).next_power_of_two(),
            false => 0,
        };
        let budget = BoneErrorBudget::new(self.fraction, slack);
        table[self.path.rises.len() * stride] = [(self.path.total() / unit).ceil() as u32, budget.0];
    }
}

pub(super) fn columns(motions: &[BoneMotion], levers: &[[f64; 3]]) -> Vec<Column> {
    motions.iter().zip(levers).map(|(bone, levers)| Column::new(bone, levers)).collect()
}
