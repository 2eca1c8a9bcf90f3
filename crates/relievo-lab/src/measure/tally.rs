//! A histogram of many values, for their root mean square, a percentile and the largest value; and the median and lower quartile
//! of few.

/// Number of low bits of an `f32` that do not count for its bin: there are 64 bins per octave.
const BIN_SHIFT: u32 = 17;

/// Values counted by size. Percentiles are too large by 1/64 of their value at most.
#[derive(Clone)]
pub(crate) struct Tally {
    pub(crate) count: u64,
    squares: f64,
    pub(crate) max: f64,
    /// The number of values in each bin, zeros excepted.
    bins: Vec<u64>,
}

impl Tally {
    pub(crate) fn new() -> Self {
        Self { count: 0, squares: 0.0, max: 0.0, bins: vec![0; 1 << (31 - BIN_SHIFT)] }
    }

    pub(crate) fn add(&mut self, value: f64) {
        self.count += 1;
        self.squares += value * value;
        self.max = self.max.max(value);
        if value > 0.0 {
            self.bins[((value as f32).to_bits() >> BIN_SHIFT) as usize] += 1;
        }
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.squares += other.squares;
        self.max = self.max.max(other.max);
        self.bins.iter_mut().zip(&other.bins).for_each(|(bin, more)| *bin += more);
    }

    pub(crate) fn rms(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }

    /// The value that a share `fraction` of all values does not exceed.
    pub(crate) fn percentile(&self, fraction: f64) -> f64 {
        let mut above = (self.count as f64 * (1.0 - fraction)) as u64;
        for (bin, count) in self.bins.iter().enumerate().rev() {
            if *count > above {
                return f64::from(f32::from_bits((bin as u32 + 1) << BIN_SHIFT)).min(self.max);
            }
            above -= count;
        }
        0.0
    }
}

/// The median of values; `None` without values.
pub(crate) fn middle(values: Vec<f64>) -> Option<f64> {
    let half = values.len() / 2;
    ranked(values, half)
}

/// The lower quartile of values; `None` without values.
pub(crate) fn lower_quartile(values: Vec<f64>) -> Option<f64> {
    let quarter = values.len() / 4;
    ranked(values, quarter)
}

/// The value that so many others do not exceed.
fn ranked(mut values: Vec<f64>, rank: usize) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(rank).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tallies_know_mean_percentile_and_largest() {
        let mut tally = Tally::new();
        (0..1000).for_each(|value| tally.add(f64::from(value) / 100.0));
        let p99 = tally.percentile(0.99);
        assert!((9.89..=9.9 * 65.0 / 64.0).contains(&p99), "{p99}");
        assert!((tally.rms() - 5.7692).abs() < 1e-3 && tally.max == 9.99, "{}", tally.rms());
        let mut zeros = Tally::new();
        (0..1000).for_each(|_| zeros.add(0.0));
        assert_eq!(zeros.percentile(0.99), 0.0);
        assert_eq!((middle(vec![3.0, 1.0, 2.0]), middle(Vec::new())), (Some(2.0), None));
        assert_eq!(
            (lower_quartile(vec![3.0, 1.0, 2.0, 4.0]), lower_quartile(vec![7.0])),
            (Some(2.0), Some(7.0))
        );
        zeros.merge(&tally);
        assert_eq!((zeros.count, zeros.max), (2000, 9.99));
        assert!((zeros.percentile(0.5) - 0.0).abs() < 0.02 && zeros.percentile(0.75) > 4.9);
    }
}
