//! Triangle meshes of height fields, for export (thesis B section 4.4). Drawing needs no mesh: relievo draws directly from the
//! heights. [`crate::terrain::ground::Ground`] answers height queries on the CPU.

use std::io::{self, Write};

use crate::asset::obj::{ObjWriter, Object};
use crate::terrain::config::HEIGHT_ONE;

/// Fixed-point value of one cell edge. Positions within a cell are multiples of 2⁻³⁰ of the distance between samples. The product
/// of such a position and any height fits `i64`.
pub(crate) const FRACTION_ONE: i64 = 1 << 30;

/// Height and normal of the drawn ground at one position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPoint {
    /// Height in height units.
    pub height: f64,
    /// Unit normal of the triangle: x east, y up, z south. `y` is above 0.
    pub normal: [f64; 3],
}

/// A square field of heights on the CPU.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    heights: Vec<i32>,
    size: usize,
    /// World units between neighbouring samples.
    spacing: f64,
}

impl HeightField {
    /// Builds a field of `size`² heights in 1/65536 height units, row by row, with samples `terrain_scale` world units apart.
    /// `None` if the number of heights is not `size`², or if `size` is below 2.
    pub fn new(heights: Vec<i32>, size: usize, terrain_scale: f64) -> Option<Self> {
        (size >= 2 && heights.len() == size * size).then_some(Self { heights, size, spacing: terrain_scale })
    }

    /// Height of the sample in column `x` and row `y`, in height units; `None` outside the field.
    pub fn point(&self, x: usize, y: usize) -> Option<f64> {
        (x < self.size && y < self.size).then(|| f64::from(self.heights[y * self.size + x]) / HEIGHT_ONE)
    }

    /// Lowest and highest height, in world units.
    pub fn extremes(&self) -> [f64; 2] {
        let all = || self.heights.iter().copied();
        // A field has at least four heights, so the default is unreachable.
        [all().min(), all().max()].map(|height| f64::from(height.unwrap_or(0)) / HEIGHT_ONE)
    }

    /// Height and normal of the ground at position (u, v) in cell (column, row). u and v are 0 to [`FRACTION_ONE`], east and
    /// south of the cell's first corner.
    ///
    /// The triangles are the same as in the drawing pass and in [`HeightField::write_obj`]. A cell's diagonal runs from its
    /// north-eastern corner (1, 0) to its south-western corner (0, 1). On the diagonal, the north-western triangle answers.
    ///
    /// The height is computed exactly and then rounded to `f64`. The normal is computed in `f64`.
    pub(crate) fn triangle(&self, [column, row]: [usize; 2], [u, v]: [i64; 2]) -> GroundPoint {
        let corner = |dx: usize, dy: usize| i64::from(self.heights[(row + dy) * self.size + column + dx]);
        let (east, south) = (corner(1, 0), corner(0, 1));
        // Barycentric weights are integers with a constant sum. Heights are therefore exact, and adjacent triangles agree on
        // their common edge.
        let beyond = u + v - FRACTION_ONE;
        let (sum, rise) = if beyond <= 0 {
            let first = corner(0, 0);
            (first * -beyond + east * u + south * v, [east - first, south - first])
        } else {
            let last = corner(1, 1);
            let sum = last * beyond + south * (FRACTION_ONE - u) + east * (FRACTION_ONE - v);
            (sum, [last - south, last - east])
        };
        let run = self.spacing * HEIGHT_ONE;
        let [x, z] = rise.map(|rise| -(rise as f64) / run);
        let length = (x * x + 1.0 + z * z).sqrt();
        GroundPoint {
            height: sum as f64 / (FRACTION_ONE as f64 * HEIGHT_ONE),
            normal: [x / length, 1.0 / length, z / length],
        }
    }

    /// Writes the mesh as Wavefront OBJ in world space. `first` is the index of the field's first sample in the world: patch
    /// coordinates times (patchSize − 1). Positions are decimals with full `f64` precision, so that adjacent patches write the
    /// same text for their shared edge.
    ///
    /// # Errors
    /// Any error of writing to `out`.
    pub fn write_obj(&self, out: &mut impl Write, first: [i64; 2]) -> io::Result<()> {
        let at = |index: usize, axis: usize| (first[axis] + index as i64) as f64 * self.spacing;
        let positions = self.heights.iter().enumerate().map(|(index, height)| {
            let (x, y) = (index % self.size, index / self.size);
            [at(x, 0), f64::from(*height) / HEIGHT_ONE, at(y, 1)]
        });
        let last = (self.size - 1) as f32;
        let uv = |index: usize| [(index % self.size) as f32 / last, (index / self.size) as f32 / last];
        let uv: Vec<_> = (0..self.heights.len()).map(uv).collect();
        let mut writer = ObjWriter::new(out);
        writer.comment(format_args!("relievo terrain: {} points", uv.len()))?;
        let triangles = triangles(self.size);
        writer.object(Object { name: None, material: None, positions, uv: &uv, normals: &[], triangles })
    }
}

/// Splits a position, in samples, into an integer sample and a fraction below [`FRACTION_ONE`]. `None` if the position is not
/// finite or is too large for `f64` to have fractions.
pub(crate) fn sample_and_fraction(position: f64) -> Option<(i64, i64)> {
    let whole = position.floor();
    let has_fractions = whole.abs() < (1_i64 << f64::MANTISSA_DIGITS) as f64;
    has_fractions.then(|| {
        let fraction = ((position - whole) * FRACTION_ONE as f64).round() as i64;
        (whole as i64 + fraction / FRACTION_ONE, fraction % FRACTION_ONE)
    })
}

/// Triangles of a grid of `size`² points, as three point indices each, counter-clockwise when seen from above.
fn triangles(size: usize) -> Vec<[u32; 3]> {
    let cells = (0..size - 1).flat_map(|row| (0..size - 1).map(move |column| (row * size + column) as u32));
    let south = size as u32;
    cells.flat_map(|at| [[at, at + south, at + 1], [at + 1, at + south, at + south + 1]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> HeightField {
        // The height at a sample is 2·column + row, in height units.
        let heights = (0..9).map(|i| (2 * (i % 3) + i / 3) * 65_536).collect();
        HeightField::new(heights, 3, 0.5).expect("nine heights")
    }

    #[test]
    fn triangles_cover_every_cell_once_and_face_up() {
        for size in [2, 3, 5, 17] {
            let place = |index: u32| {
                glam::Vec3::new((index as usize % size) as f32, 0.0, (index as usize / size) as f32)
            };
            let triangles = triangles(size);
            assert_eq!(triangles.len(), 2 * (size - 1) * (size - 1));
            let mut cells = std::collections::HashMap::new();
            for triangle in triangles {
                let [a, b, c] = triangle.map(place);
                assert!((b - a).cross(c - a).y > 0.0, "size {size}: {triangle:?} faces down");
                let center = (a + b + c) / 3.0;
                *cells.entry((center.x as usize, center.z as usize)).or_insert(0) += 1;
            }
            assert_eq!(cells.len(), (size - 1) * (size - 1));
            assert!(cells.values().all(|count| *count == 2));
        }
    }

    #[test]
    fn obj_has_every_point_and_face() {
        let mut text = Vec::new();
        ramp().write_obj(&mut text, [0, 0]).expect("a vector takes everything");
        let text = String::from_utf8(text).expect("ASCII");
        let count = |prefix: &str| text.lines().filter(|line| line.starts_with(prefix)).count();
        assert_eq!((count("v "), count("vt "), count("f ")), (9, 9, 8));
        assert!(text.contains("v 0.5 3 0.5"));
    }

    #[test]
    fn obj_in_world_space_is_exact_wherever_it_lies() {
        let text = |first| {
            let mut text = Vec::new();
            ramp().write_obj(&mut text, first).expect("a vector takes everything");
            String::from_utf8(text).expect("ASCII")
        };
        // An f32 could not represent this x position.
        assert!(text([1 << 30, -3]).contains("\nv 536870912.5 3 -1\n"));
    }
}
