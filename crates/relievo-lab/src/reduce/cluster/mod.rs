//! Clustering of a mesh's vertices in the cells of a uniform grid (Rossignac and Borrel, "Multi-resolution 3D Approximations
//! for Rendering Complex Scenes", 1993).
//!
//! Each cell has one *representative*: the mean of its vertices. Triangles whose corners lie in three different cells stay, in
//! the mesh's order; all others are dropped. The representative's attributes are those of its *source*, the vertex of the
//! cell that is nearest to the mean.
//!
//! # What is promised
//!
//! - Every device gives the same mesh to the bit. Positions are rounded to whole numbers of a quantum, a power of two between
//!   2⁻³⁰ and 2⁻²⁹ of the grid's largest coordinate; a mean is that of integers, and becomes the nearest float.
//! - No vertex inside of the grid moves farther than the diagonal of a cell, and a quantum.
//! - A closed mesh stays closed in this sense: each edge of the result has as many triangles on one side as on the other.
//!   Dropping a triangle with two corners in one cell takes away both directions of one edge.
//!
//! Not promised: separate sheets that pass through one cell become one, so that the topology may change, more than two
//! triangles may meet at an edge, two triangles may have the same corners, and triangles may turn around. Seams of
//! attributes inside a cell are lost.

use relievo::InputError;

pub mod reference;

/// The largest number of cells along an edge of a grid.
pub const MAX_CELLS: u32 = 1024;

/// The largest number of vertices of a mesh: a record of 32 bytes for each of them fits into a binding of 128 MiB.
pub const MAX_VERTICES: usize = 1 << 22;

/// A grid of cubes. Vertices outside of its box count as lying on the nearest side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// The corner of the box with the lowest coordinates, in the units of positions, finite.
    pub low: [f32; 3],
    /// The opposite corner, at least `low`, finite.
    pub high: [f32; 3],
    /// Number of cells along the box's longest edge, from 1 to [`MAX_CELLS`]. Along the other edges there are as many as are
    /// needed.
    pub cells: u32,
}

impl Grid {
    /// The grid in the bounding box of some positions, which are finite; the origin if there is none.
    pub fn around(positions: &[[f32; 3]], cells: u32) -> Self {
        let Some(first) = positions.first() else { return Self { low: [0.0; 3], high: [0.0; 3], cells } };
        let [mut low, mut high] = [*first; 2];
        for position in positions {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis]);
                high[axis] = high[axis].max(position[axis]);
            }
        }
        Self { low, high, cells }
    }

    /// # Errors
    /// [`InputError`] for corners that are not finite or in the wrong order, and for a number of cells outside of its bounds.
    pub fn validate(&self) -> Result<(), InputError> {
        for axis in 0..3 {
            for (name, value) in [("low", self.low[axis]), ("high", self.high[axis])] {
                if !value.is_finite() {
                    return Err(InputError::new(format!("grid.{name}[{axis}]"), value, "must be finite"));
                }
            }
            if self.high[axis] < self.low[axis] {
                let bound = format!("must be at least {}, as low", self.low[axis]);
                return Err(InputError::new(format!("grid.high[{axis}]"), self.high[axis], bound));
            }
        }
        if !(1..=MAX_CELLS).contains(&self.cells) {
            return Err(InputError::new("grid.cells", self.cells, format!("must be 1 to {MAX_CELLS}")));
        }
        Ok(())
    }

    /// The grid in quanta.
    pub(crate) fn quantized(&self) -> Quantized {
        let largest = self.low.iter().chain(&self.high).fold(0.0, |largest: f32, x| largest.max(x.abs()));
        // The largest coordinate has 30 bits: its mantissa of 24 is shifted by 6.
        let exponent = 156 - ((largest.to_bits() >> 23).max(1) as i32);
        let origin = self.low.map(|x| quantum(x, exponent));
        let high = self.high.map(|x| quantum(x, exponent));
        let extent = [0, 1, 2].map(|axis| high[axis].abs_diff(origin[axis]));
        let longest = extent.into_iter().max().unwrap_or(0);
        Quantized { exponent, origin, extent, size: longest / self.cells + 1 }
    }
}

/// A grid in quanta.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Quantized {
    /// A quantum is 2 to the power of minus this number.
    pub(crate) exponent: i32,
    /// The lowest corner.
    pub(crate) origin: [i32; 3],
    /// From the lowest corner to the highest.
    pub(crate) extent: [u32; 3],
    /// The edge of a cell.
    pub(crate) size: u32,
}

/// The largest magnitude of a position in quanta.
const FARTHEST: f64 = (1 << 30) as f64;

/// A coordinate as a whole number of quanta, halves away from zero, cut off at [`FARTHEST`]; what is no number too.
pub(crate) fn quantum(x: f32, exponent: i32) -> i32 {
    // The product is exact: 24 bits, and an exponent that f64 has.
    let scaled = f64::from(x.abs()) * power_of_two(exponent);
    let magnitude = if scaled < FARTHEST { scaled.round() } else { FARTHEST } as i32;
    if x.is_sign_negative() { -magnitude } else { magnitude }
}

/// 2 to the power of a number from −1022 to 1023.
pub(crate) fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The vertex that stands for all vertices of a cell.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Representative {
    /// The mean of the cell's vertices.
    pub position: [f32; 3],
    /// The vertex of the cell that is nearest to the mean, by the largest difference of a coordinate; of several the lowest.
    pub source: u32,
}
