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

/// Gradient noise, about −1 to 1. `periods` is the number of lattice cells along the tile's edges.
pub fn gradient(key: u32, periods: [u32; 2], [u, v]: [f32; 2]) -> f32 {
    let [(columns, s), (rows, t)] =
        [(u, periods[0]), (v, periods[1])].map(|(at, period)| corners(at, period));
    let corner = |dx: usize, dy: usize| {
        let word = word(key, [columns[dx], rows[dy]]);
        let (s, t) = (s - dx as f32, t - dy as f32);
        // One of eight gradient directions, of about equal length.
        let [long, short] = if word & 4 == 0 { [s, t] } else { [t, s] };
        let signed = |value: f32, bit: u32| if word & bit == 0 { value } else { -value };
        signed(long, 1) * 1.3 + signed(short, 2) * 0.55
    };
    let fade = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (fade_s, fade_t) = (fade(s), fade(t));
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(corner(0, 0), corner(1, 0), fade_s), mix(corner(0, 1), corner(1, 1), fade_s), fade_t)
}

/// Sum of `count` octaves of gradient noise, about −1 to 1. From one octave to the next, the frequency doubles and the weight is
/// multiplied by `gain`.
pub fn octaves(key: u32, periods: [u32; 2], count: u32, gain: f32, at: [f32; 2]) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..count {
        sum += weight * gradient(key + octave, periods.map(|period| period << octave), at);
        total += weight;
        weight *= gain;
    }
    sum / total
}

/// Sum of `count` octaves of noise with sharp ridges, 0 to 1.
pub fn ridges(key: u32, period: u32, count: u32, at: [f32; 2]) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..count {
        let ridge = 1.0 - gradient(key + octave, [period << octave; 2], at).abs().min(1.0);
        sum += weight * ridge * ridge;
        total += weight;
        weight *= 0.55;
    }
    sum / total
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
