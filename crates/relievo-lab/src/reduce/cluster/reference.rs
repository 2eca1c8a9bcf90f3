//! Clustering in a uniform grid.

use std::collections::HashMap;

use relievo::InputError;

use crate::reduce::cluster::{Grid, MAX_VERTICES, Quantized, Representative, power_of_two, quantum};

/// A clustered mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clustered {
    /// The representatives of all cells that have vertices, in the order of the cells' first vertices.
    pub representatives: Vec<Representative>,
    /// Three representatives for each triangle that stays.
    pub indices: Vec<u32>,
    /// The representative of each vertex.
    pub remap: Vec<u32>,
    /// For each triangle that stays its index in the mesh, ascending.
    pub triangles: Vec<u32>,
}

/// Clusters a mesh of three indices per triangle.
///
/// # Errors
/// [`InputError`] as [`Grid::validate`], for indices that are out of range or not three per triangle, and for more vertices
/// than [`MAX_VERTICES`].
pub fn cluster(positions: &[[f32; 3]], indices: &[u32], grid: &Grid) -> Result<Clustered, InputError> {
    grid.validate()?;
    if positions.len() > MAX_VERTICES {
        let bound = format!("must be at most {MAX_VERTICES}");
        return Err(InputError::new("positions.len", positions.len(), bound));
    }
    relievo::asset::indices::check_triangles("indices", indices, positions.len())?;
    let grid = grid.quantized();
    let offsets: Vec<[u32; 3]> = positions.iter().map(|position| offset(&grid, position)).collect();
    let (remap, sums) = sums(&grid, &offsets);
    let means: Vec<[u32; 3]> = sums.iter().map(|sum| sum.mean(grid.size)).collect();
    let sources = sources(&offsets, &remap, &means);
    let representatives = means.iter().zip(sources).map(|(mean, source)| {
        let position = [0, 1, 2].map(|axis| grid.coordinate(axis, mean[axis]));
        Representative { position, source }
    });
    let mut clustered = Clustered { representatives: representatives.collect(), ..Clustered::default() };
    for (triangle, corners) in (0_u32..).zip(indices.chunks_exact(3)) {
        let [a, b, c] = [0, 1, 2].map(|at| remap[corners[at] as usize]);
        if a != b && b != c && c != a {
            clustered.indices.extend([a, b, c]);
            clustered.triangles.push(triangle);
        }
    }
    Ok(Clustered { remap, ..clustered })
}

impl Quantized {
    /// The float that is nearest to a coordinate.
    fn coordinate(&self, axis: usize, offset: u32) -> f32 {
        let quanta = i64::from(self.origin[axis]) + i64::from(offset);
        // Of 0 there is the positive one alone, and 31 bits are exact in f64.
        let x = (quanta as f64 * power_of_two(-self.exponent)) as f32;
        if x == 0.0 { 0.0 } else { x }
    }
}

/// A vertex's offset from the lowest corner of the grid in quanta, cut off at the grid's sides.
fn offset(grid: &Quantized, position: &[f32; 3]) -> [u32; 3] {
    [0, 1, 2].map(|axis| {
        let place = quantum(position[axis], grid.exponent).max(grid.origin[axis]);
        place.abs_diff(grid.origin[axis]).min(grid.extent[axis])
    })
}

/// The vertices of a cell.
struct Sum {
    cell: [u32; 3],
    /// Of offsets from the cell's lowest corner.
    inside: [u64; 3],
    count: u64,
}

impl Sum {
    /// The mean of the offsets from the grid's lowest corner, halves upwards.
    fn mean(&self, size: u32) -> [u32; 3] {
        [0, 1, 2]
            .map(|axis| self.cell[axis] * size + ((self.inside[axis] + self.count / 2) / self.count) as u32)
    }
}

/// For each vertex the index of its cell, in the order of first vertices, and the sum of each cell.
fn sums(grid: &Quantized, offsets: &[[u32; 3]]) -> (Vec<u32>, Vec<Sum>) {
    let mut known: HashMap<[u32; 3], u32> = HashMap::with_capacity(offsets.len());
    let mut sums: Vec<Sum> = Vec::new();
    let mut remap = Vec::with_capacity(offsets.len());
    for offset in offsets {
        let cell = offset.map(|x| x / grid.size);
        let at = *known.entry(cell).or_insert(sums.len() as u32);
        if at as usize == sums.len() {
            sums.push(Sum { cell, inside: [0; 3], count: 0 });
        }
        let sum = &mut sums[at as usize];
        for axis in 0..3 {
            sum.inside[axis] += u64::from(offset[axis] - cell[axis] * grid.size);
        }
        sum.count += 1;
        remap.push(at);
    }
    (remap, sums)
}

/// For each cell the vertex that is nearest to its mean.
fn sources(offsets: &[[u32; 3]], remap: &[u32], means: &[[u32; 3]]) -> Vec<u32> {
    let mut nearest = vec![(u32::MAX, u32::MAX); means.len()];
    for (vertex, (offset, cell)) in (0_u32..).zip(offsets.iter().zip(remap)) {
        let mean = means[*cell as usize];
        let apart = [0, 1, 2].map(|axis| offset[axis].abs_diff(mean[axis]));
        let distance = apart[0].max(apart[1]).max(apart[2]);
        let known = &mut nearest[*cell as usize];
        *known = (*known).min((distance, vertex));
    }
    nearest.into_iter().map(|(_, vertex)| vertex).collect()
}
