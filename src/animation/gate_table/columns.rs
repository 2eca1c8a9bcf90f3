//! One bone's motion along a clip, as columns of tables have it.

use super::{EVERYTHING, ErrorBudget};
use crate::animation::motion::{BoneMotion, Path};

/// One bone's motion along a clip.
pub(super) struct Column {
    rises: Vec<f64>,
    jumps: Vec<f64>,
    wrap: f64,
    is_boundless: bool,
    /// Of what bones above leave, 0 to 1.
    pub(super) fraction: f64,
}

impl Column {
    fn new(bone: &BoneMotion, levers: &[f64; 3]) -> Self {
        let weighed = |of: &dyn Fn(&Path) -> f64| {
            bone.parts.iter().zip(levers).map(|(part, lever)| lever * of(part)).sum::<f64>()
        };
        let times = bone.parts[0].rises.len();
        Self {
            rises: (0..times).map(|at| weighed(&|path| path.rises[at])).collect(),
            jumps: (0..times).map(|at| weighed(&|path| path.jumps[at])).collect(),
            wrap: weighed(&|path| path.wrap),
            is_boundless: bone.parts.iter().any(|path| path.is_boundless),
            fraction: 0.0,
        }
    }

    pub(super) fn total(&self) -> f64 {
        self.rises.iter().chain(&self.jumps).sum::<f64>() + self.wrap
    }

    /// Writes it down a table.
    ///
    /// Starts are rounded to the nearest unit, rises up, and sums down: what two sums differ by is at most 4 units too
    /// small. Fractions are cut to 16 bits, 2⁻¹⁶ of a stretch, and may be off by rounding of their division: 2⁻¹² of
    /// the steepest stretch is more than either costs for two sums. What rounding may hide so, the quantization slack, is
    /// a power of two.
    pub(super) fn write(&self, table: &mut [[u32; 2]], stride: usize, unit: f64) {
        let mut sum = 0.0;
        let mut steepest = 0.0_f64;
        for (row, (rise, jump)) in self.rises.iter().zip(&self.jumps).enumerate() {
            sum += jump;
            table[row * stride] = [(sum / unit).round() as u32, (rise / unit).ceil() as u32];
            sum += rise;
            steepest = steepest.max(rise / unit);
        }
        let slack = match self.is_boundless {
            true => EVERYTHING,
            false if self.total() > 0.0 => (4 + (steepest / 4096.0).ceil() as u32).next_power_of_two(),
            false => 0,
        };
        let budget = ErrorBudget::new(self.fraction, slack);
        table[self.rises.len() * stride] = [(self.total() / unit).ceil() as u32, budget.0];
    }
}

pub(super) fn columns(motions: &[BoneMotion], levers: &[[f64; 3]]) -> Vec<Column> {
    motions.iter().zip(levers).map(|(bone, levers)| Column::new(bone, levers)).collect()
}
