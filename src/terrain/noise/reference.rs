//! Heights of a region from octaves of noise: the CPU reference of `kernels/terrain/noise.wgsl`. It computes one sample after
//! another with 64-bit products, and keeps the lattice points of each octave's last cell.

use super::octave_key;
use crate::hash::{LANES, threefry2x32};
use crate::terrain::config::{HeightGenerator, TerrainConfig};
use crate::terrain::lattice::world;
use crate::terrain::window::Region;

/// 1 in the fixed point of noise values, Q4.27.
const ONE: i32 = 1 << 27;

/// Heights of a region, in rows of `region.width` samples. The region must be valid, and `config.generator` must be a generator
/// of noise.
pub fn noise(config: &TerrainConfig, region: Region) -> Vec<i32> {
    let spacing = config.sample_spacing() << region.coarser;
    let mut octaves: Vec<_> = (0..config.octaves(region.coarser)).map(|at| Octave::new(config, at)).collect();
    let along = |axis: usize| {
        let first = region.first[axis];
        (first..first + i64::from(region.width)).map(move |index| world(index, spacing))
    };
    let mut heights = Vec::with_capacity((region.width as usize).pow(2));
    for y in along(1) {
        heights.extend(along(0).map(|x| match config.generator {
            HeightGenerator::Simplex => simplex(&mut octaves, [x, y]),
            HeightGenerator::Ridged => ridged(&mut octaves, [x, y]),
            _ => fbm(&mut octaves, [x, y]),
        }));
    }
    heights
}

/// Sum of octaves. Octave 0 includes the random heights of the base lattice.
fn fbm(octaves: &mut [Octave], at: [u32; 2]) -> i32 {
    let mut height = 0;
    for (index, octave) in octaves.iter_mut().enumerate() {
        height += octave.on_squares(at, index == 0).times(octave.range);
    }
    height
}

/// Sum of ridges, 1 − |n|. Octave 0 weighs the ridges of the finer octaves: 1 on its crests, towards 0 in its valleys.
fn ridged(octaves: &mut [Octave], at: [u32; 2]) -> i32 {
    let (mut height, mut weight) = (0, ONE);
    for (index, octave) in octaves.iter_mut().enumerate() {
        let size = octave.on_squares(at, true).0.abs();
        height += Noise(Noise(ONE - size).times(weight as u32)).times(octave.range);
        if index == 0 {
            weight = ONE - (size >> 1);
        }
    }
    height
}

/// Sum of octaves of simplex noise.
fn simplex(octaves: &mut [Octave], at: [u32; 2]) -> i32 {
    octaves.iter_mut().map(|octave| octave.on_triangles(at).times(octave.range)).sum()
}

/// A noise value in Q4.27.
#[derive(Clone, Copy)]
struct Noise(i32);

impl Noise {
    /// Product with a whole number or with another value, rounded down.
    fn times(self, factor: u32) -> i32 {
        product(self.0, factor, 27)
    }
}

/// One octave of noise.
struct Octave {
    index: u32,
    /// Binary logarithm of the lattice's spacing in world coordinates.
    log2: u32,
    key: [u32; 2],
    range: u32,
    /// Lattice points of the last sample's cell.
    cell: Cell,
}

/// Four lattice points, and what is random there.
struct Cell {
    x: [u32; 4],
    y: [u32; 4],
    /// Q.7.
    gradients: [[i32; 2]; 4],
    /// Q4.27.
    values: [i32; 4],
}

impl Cell {
    fn new(key: [u32; 2], x: [u32; 4], y: [u32; 4]) -> Self {
        let twice = |four: [u32; 4]| -> [u32; LANES] { std::array::from_fn(|lane| four[lane % 4]) };
        let (turns, values) = threefry2x32(key, twice(x), twice(y));
        let gradient = |index: usize| {
            let turn = turns[index] >> 16;
            [sine(turn), sine(turn + 0x4000)]
        };
        Self {
            x,
            y,
            gradients: std::array::from_fn(gradient),
            values: std::array::from_fn(|index| values[index] as i32 >> 5),
        }
    }
}

impl Octave {
    fn new(config: &TerrainConfig, index: u32) -> Self {
        let key = octave_key(config.key(), index);
        let (log2, range) = (config.base_log2() - index, config.level_range(index));
        Self { index, log2, key, range, cell: Cell::new(key, [0; 4], [0; 4]) }
    }

    /// Gradient noise on the square lattice; with `values`, plus interpolated random values of the lattice points.
    fn on_squares(&mut self, at: [u32; 2], values: bool) -> Noise {
        let spacing = 1 << self.log2;
        let [x, y] = at.map(|world| world & !(spacing - 1));
        let [right, below] = [x, y].map(|world| world.wrapping_add(spacing));
        self.draw([x, right, x, right], [y, y, below, below]);
        // Fractions of the cell, Q.20.
        let [u, v] = at.map(|world| ((world & (spacing - 1)) << (20 - self.log2)) as i32);
        let corner = |index: usize| {
            let one = 1 << 20;
            let offset = [u - (index as i32 & 1) * one, v - (index as i32 >> 1) * one];
            self.ramp(index, offset) + if values { self.cell.values[index] } else { 0 }
        };
        let [u, v] = [u, v].map(|fraction| fade(fraction as u32));
        Noise(mix(mix(corner(0), corner(1), u), mix(corner(2), corner(3), u), v))
    }

    /// Simplex noise: the contributions of the three lattice points around a sample.
    ///
    /// The lattice has the basis (8, 0), (4, 7) in units of an eighth of the spacing. Its triangles have edges of 1, 1.0078 and
    /// 1.0078 spacings, and coordinates of lattice points are whole.
    fn on_triangles(&mut self, at: [u32; 2]) -> Noise {
        let spacing = 1_i32 << self.log2;
        let (half, row_height) = (spacing / 2, spacing / 8 * 7);
        // Each octave's lattice lies elsewhere: on a common point, all octaves would be 0.
        let [shift_x, shift_y] = super::shift(self.index, self.log2);
        let x = at[0].wrapping_add(shift_x);
        let y = at[1].wrapping_add(0x8000_0000).wrapping_add(shift_y);
        let row = y / row_height as u32;
        let dy = (y % row_height as u32) as i32;
        let mut dx = (x.wrapping_sub(row.wrapping_mul(half as u32)) & (spacing as u32 - 1)) as i32;
        // 7 times the distance along the row from the last edge that leads to the next row.
        let mut along = 7 * dx - 4 * dy;
        if along < 0 {
            along += 7 * spacing;
            dx += spacing;
        }
        let upper = along + 8 * dy >= 7 * spacing;
        let third = if upper { [dx - spacing - half, dy - row_height] } else { [dx, dy] };
        let offsets = [[dx - spacing, dy], [dx - half, dy - row_height], third];
        let of = |axis: usize| {
            let point = |index: usize| [x, y][axis].wrapping_sub(offsets[index.min(2)][axis] as u32);
            std::array::from_fn(point)
        };
        self.draw(of(0), of(1));
        let contribution = |(index, offset): (usize, [i32; 2])| {
            let offset = offset.map(|world| world << (20 - self.log2));
            // Squares in Q.30, of magnitudes in Q.31.
            let [square_x, square_y] = offset.map(|d| ((i64::from(d) * i64::from(d)) >> 10) as i32);
            let near = (3 << 28) - square_x - square_y;
            let near = (near.max(0) as u32) << 2;
            let near = high(near, near);
            product(self.ramp(index, offset) << 3, high(near, near), 32)
        };
        let sum: i32 = offsets.into_iter().enumerate().map(contribution).sum();
        Noise((sum * 11) >> 3)
    }

    /// Goes on to the cell with these lattice points.
    fn draw(&mut self, x: [u32; 4], y: [u32; 4]) {
        if (self.cell.x, self.cell.y) != (x, y) {
            self.cell = Cell::new(self.key, x, y);
        }
    }

    /// Product of a lattice point's gradient and an offset (Q.20) from the point.
    fn ramp(&self, index: usize, [x, y]: [i32; 2]) -> i32 {
        let [along_x, along_y] = self.cell.gradients[index];
        along_x * x + along_y * y
    }
}

/// A parabola in place of a sine, with the largest value 170/128 (Q.7). `turn` is the angle: 65536 is a whole turn.
fn sine(turn: u32) -> i32 {
    let half = turn & 0x7fff;
    let size = ((((half * (0x8000 - half)) >> 8) * 85) >> 19) as i32;
    if turn & 0x8000 == 0 { size } else { -size }
}

/// Fade 6t⁵ − 15t⁴ + 10t³ (Perlin 2002) of a fraction in Q.20, in Q.31. Its first and second derivatives are 0 at both ends.
fn fade(fraction: u32) -> u32 {
    let t = fraction << 12;
    let square = high(t, t);
    let factor = (10_u32 << 28).wrapping_sub(15 * (t >> 4)).wrapping_add(6 * (square >> 4));
    high(high(square, t), factor) << 3
}

/// Interpolates between two values; `fade` is in Q.31.
fn mix(a: i32, b: i32, fade: u32) -> i32 {
    a + product(b - a, fade, 31)
}

/// Product of a signed and an unsigned number, divided by 2^`bits` and rounded down.
fn product(a: i32, b: u32, bits: u32) -> i32 {
    ((i64::from(a) * i64::from(b)) >> bits) as i32
}

fn high(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}
