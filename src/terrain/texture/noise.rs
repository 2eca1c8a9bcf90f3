//! Noise that repeats after one tile: gradient noise (Perlin 2002) and cellular noise (Worley 1996). All arithmetic gives the
//! same results on every machine.

/// Random word for a lattice point. Different keys give independent words.
pub fn word(key: u32, [x, y]: [u32; 2]) -> u32 {
    let mut word = key.wrapping_mul(0xc2b2_ae3d) ^ x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77);
    for shift in [16, 15] {
        word = (word ^ (word >> shift)).wrapping_mul(0x7feb_352d);
    }
    word ^ (word >> 16)
}

/// Random number from 0 to 1 for a lattice point. Different keys give independent numbers.
pub fn random(key: u32, at: [u32; 2]) -> f32 {
    (word(key, at) >> 8) as f32 / 16_777_216.0
}

/// Cubic step: 0 below `low`, 1 above `high`, smooth in between.
pub fn smoothstep(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The two lattice points around a coordinate along one edge of the tile, and the coordinate between them, 0 to 1.
fn corners(at: f32, period: u32) -> ([u32; 2], f32) {
    let scaled = at * period as f32;
    // `f32::floor` is a call on processors without SSE 4.1.
    let towards_zero = scaled as i32;
    let cell = towards_zero - i32::from(scaled < towards_zero as f32);
    let first = wrapped(cell, period);
    ([first, if first + 1 == period { 0 } else { first + 1 }], scaled - cell as f32)
}

/// `cell` modulo `period`, without a division inside the tile.
fn wrapped(cell: i32, period: u32) -> u32 {
    if (0..period as i32).contains(&cell) { cell as u32 } else { cell.rem_euclid(period as i32) as u32 }
}

/// The gradients of gradient noise along u and along v: eight directions, of about equal length.
const ALONG_U: [f32; 8] = [1.3, -1.3, 1.3, -1.3, 0.55, 0.55, -0.55, -0.55];
const ALONG_V: [f32; 8] = [0.55, 0.55, -0.55, -0.55, 1.3, -1.3, 1.3, -1.3];

/// A sum of octaves of gradient noise. From one octave to the next, the frequency doubles and the weight is multiplied by `gain`.
pub struct Noise {
    /// Number of lattice cells of the first octave along the tile's edges.
    periods: [u32; 2],
    gain: f32,
    /// The gradients of each octave at its lattice points, row by row.
    octaves: Vec<Vec<u8>>,
}

impl Noise {
    /// Draws the gradients of `count` octaves. Different keys give independent noise.
    pub fn new(key: u32, periods: [u32; 2], count: u32, gain: f32) -> Self {
        let octave = |octave: u32| {
            let [columns, rows] = periods.map(|period| period << octave);
            let gradient = |at: u32| word(key + octave, [at % columns, at / columns]) as u8 % 8;
            (0..columns * rows).map(gradient).collect()
        };
        Self { periods, gain, octaves: (0..count).map(octave).collect() }
    }

    /// Draws the gradients of one octave.
    pub fn octave(key: u32, periods: [u32; 2]) -> Self {
        Self::new(key, periods, 1, 1.0)
    }

    /// The noise at texture coordinates, about −1 to 1.
    pub fn at(&self, at: [f32; 2]) -> f32 {
        self.mean(at, |weight, noise| weight * noise)
    }

    /// Noise with sharp ridges, 0 to 1.
    pub fn ridges(&self, at: [f32; 2]) -> f32 {
        self.mean(at, |weight, noise| {
            let ridge = 1.0 - noise.abs().min(1.0);
            weight * ridge * ridge
        })
    }

    /// The sum of weighted octaves, divided by the sum of their weights.
    fn mean(&self, at: [f32; 2], weighted: impl Fn(f32, f32) -> f32) -> f32 {
        let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
        for (octave, gradients) in self.octaves.iter().enumerate() {
            sum += weighted(weight, octave_at(gradients, self.periods.map(|period| period << octave), at));
            total += weight;
            weight *= self.gain;
        }
        sum / total
    }
}

/// One octave of gradient noise at texture coordinates, about −1 to 1.
fn octave_at(gradients: &[u8], periods: [u32; 2], [u, v]: [f32; 2]) -> f32 {
    let [(columns, s), (rows, t)] =
        [(u, periods[0]), (v, periods[1])].map(|(at, period)| corners(at, period));
    let corner = |dx: usize, dy: usize| {
        let gradient = usize::from(gradients[(rows[dy] * periods[0] + columns[dx]) as usize]);
        (s - dx as f32) * ALONG_U[gradient] + (t - dy as f32) * ALONG_V[gradient]
    };
    let fade = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (fade_s, fade_t) = (fade(s), fade(t));
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(corner(0, 0), corner(1, 0), fade_s), mix(corner(0, 1), corner(1, 1), fade_s), fade_t)
}

/// The cell of Worley noise that contains a given point. Every lattice square has one random feature point. All points with the
/// same nearest feature point form a cell.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Distances to the nearest and the second nearest feature point, in units of a lattice square's edge.
    pub distances: [f32; 2],
    /// Vector from the nearest feature point to the given point, in units of a lattice square's edge.
    pub offset: [f32; 2],
    /// Random word of the cell, the same for all of its points.
    pub word: u32,
}

/// Finds the cell of Worley noise that contains the texture coordinates (u, v).
pub fn cell(key: u32, periods: [u32; 2], [u, v]: [f32; 2]) -> Cell {
    let (x, y) = (u * periods[0] as f32, v * periods[1] as f32);
    let (cell_x, cell_y) = (x.floor(), y.floor());
    let mut found = Cell { distances: [9.0; 2], offset: [0.0; 2], word: 0 };
    for (dy, dx) in (-1..2).flat_map(|dy| (-1..2).map(move |dx| (dy, dx))) {
        let square = [(cell_x, dx, periods[0]), (cell_y, dy, periods[1])]
            .map(|(cell, step, period)| wrapped(cell as i32 + step, period));
        let word = word(key, square);
        let inside = [word & 0xffff, word >> 16].map(|half| half as f32 / 65_536.0);
        let offset = [x - cell_x - dx as f32 - inside[0], y - cell_y - dy as f32 - inside[1]];
        let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
        if distance < found.distances[0] {
            found = Cell { distances: [distance, found.distances[0]], offset, word };
        } else if distance < found.distances[1] {
            found.distances[1] = distance;
        }
    }
    found
}
