//! Random numbers, and value noise that repeats after a tile.

use relievo::ops::hash::{LANES, threefry2x32};

/// Two random numbers in 0..1 for a cell. Different keys give independent numbers.
pub fn random(key: u32, cell: [usize; 2]) -> [f64; 2] {
    let [x, y] = cell.map(|index| index as u32);
    let (first, second) = threefry2x32([key, 0x7e1e_f000], [x; LANES], [y; LANES]);
    [first[0], second[0]].map(|word| f64::from(word) / 4_294_967_296.0)
}

/// Cell of a periodic lattice that contains `at`, and the position in that cell, 0 to 1.
pub fn cell(at: f64, period: usize) -> (usize, f64) {
    let floor = at.floor();
    ((floor as i64).rem_euclid(period as i64) as usize, at - floor)
}

/// Value noise of several octaves. Each octave has twice the frequency and half the weight of the previous octave. The period is
/// 1; values are in 0..1, with a mean of about ½.
#[derive(Debug, Clone)]
pub struct Noise {
    octaves: Vec<Lattice>,
}

#[derive(Debug, Clone)]
struct Lattice {
    period: usize,
    values: Vec<f64>,
}

impl Noise {
    /// Creates noise whose first octave has `period` lattice cells per tile.
    pub fn new(key: u32, period: usize, octaves: usize) -> Self {
        let lattice = |octave: usize| {
            let period = period << octave;
            let value = |index| random(key, [index % period, octave * 65_536 + index / period])[0];
            Lattice { period, values: (0..period * period).map(value).collect() }
        };
        Self { octaves: (0..octaves).map(lattice).collect() }
    }

    /// Value of the noise at (u, v), 0 to 1.
    pub fn at(&self, u: f64, v: f64) -> f64 {
        let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
        for lattice in &self.octaves {
            sum += weight * lattice.at(u, v);
            total += weight;
            weight *= 0.5;
        }
        sum / total
    }

    /// Value of the noise at (u, v), rescaled to −1 to 1 around 0.
    pub fn signed(&self, u: f64, v: f64) -> f64 {
        2.0 * self.at(u, v) - 1.0
    }
}

impl Lattice {
    fn at(&self, u: f64, v: f64) -> f64 {
        let period = self.period as f64;
        let ((x, s), (y, t)) = (cell(u * period, self.period), cell(v * period, self.period));
        let value = |x: usize, y: usize| self.values[y % self.period * self.period + x % self.period];
        // Perlin's quintic polynomial leaves no creases between lattice cells.
        let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let (s, t) = (fade(s), fade(t));
        let top = value(x, y) + (value(x + 1, y) - value(x, y)) * s;
        let bottom = value(x, y + 1) + (value(x + 1, y + 1) - value(x, y + 1)) * s;
        top + (bottom - top) * t
    }
}
