//! What a reducer leaves of a mesh.

use relievo::ops::mesh::simplify::{Stopped, Surface};

/// A reduced mesh, which has only the vertices that its triangles use.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduced {
    /// Positions of all vertices, in each pose of the input.
    pub poses: Vec<Vec<[f32; 3]>>,
    /// `stride` numbers per vertex, as in the input.
    pub attributes: Vec<f32>,
    /// Numbers per vertex in `attributes`.
    pub stride: usize,
    /// Three indices per triangle.
    pub indices: Vec<u32>,
    /// For each vertex, the vertex of the input from which it comes: what it has besides positions and attributes (joints and
    /// weights, say) is that one's.
    pub vertices: Vec<u32>,
    /// For each triangle, the triangle of the input from which it comes: its material, say, is that one's.
    pub triangles: Vec<u32>,
    /// How far the result is from the input in units of positions, as the reducer estimates it; see [`crate::reduce::Reducer`].
    pub error: f32,
    /// Why the reducer stopped.
    pub stopped: Stopped,
}

impl Reduced {
    /// The SHA-256 of the mesh, in hexadecimal digits: the bits of positions, attributes and the error, and all indices. It is
    /// the same on every machine.
    pub fn hash(&self) -> String {
        let numbers = self.poses.iter().flatten().flatten().chain(&self.attributes).chain([&self.error]);
        let mut words: Vec<u32> = numbers.map(|number| number.to_bits()).collect();
        for part in [&self.indices, &self.vertices, &self.triangles] {
            words.push(part.len() as u32);
            words.extend(part);
        }
        relievo::ops::hash::sha256(&words)
    }

    /// The mesh of triangles whose corners are vertices of the input.
    ///
    /// `corners` has three vertices a triangle, `triangles` the input's triangle of each.
    pub(super) fn of_vertices(
        surface: &Surface<'_>,
        corners: &[u32],
        triangles: Vec<u32>,
        error: f32,
        stopped: Stopped,
    ) -> Self {
        let (vertices, indices) = compacted(corners);
        let poses = surface.poses.iter().map(|pose| vertices.iter().map(|at| pose[*at as usize]).collect());
        let (poses, stride) = (poses.collect(), surface.stride);
        let attributes = attributes_of(surface.attributes, stride, &vertices);
        Self { poses, attributes, stride, indices, vertices, triangles, error, stopped }
    }

    /// The mesh of triangles whose corners are vertices of the input in other places: `corners` has three vertices a
    /// triangle with their positions in the only pose. A vertex has one position, and its own attributes of `stride` numbers.
    pub(super) fn placed(
        corners: &[(u32, [f32; 3])],
        attributes: &[f32],
        stride: usize,
        triangles: Vec<u32>,
        error: f32,
        stopped: Stopped,
    ) -> Self {
        let of: Vec<u32> = corners.iter().map(|(vertex, _)| *vertex).collect();
        let (vertices, indices) = compacted(&of);
        let mut positions = vec![[0.0; 3]; vertices.len()];
        for (index, (_, position)) in indices.iter().zip(corners) {
            positions[*index as usize] = *position;
        }
        let attributes = attributes_of(attributes, stride, &vertices);
        Self { poses: vec![positions], attributes, stride, indices, vertices, triangles, error, stopped }
    }
}

/// The numbers of some vertices.
fn attributes_of(attributes: &[f32], stride: usize, vertices: &[u32]) -> Vec<f32> {
    vertices.iter().flat_map(|at| &attributes[*at as usize * stride..][..stride]).copied().collect()
}

/// The vertices that corners use, in ascending order, and the corners as indices into these.
fn compacted(corners: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let count = corners.iter().max().map_or(0, |last| *last as usize + 1);
    let mut slots = vec![0_u32; count];
    corners.iter().for_each(|vertex| slots[*vertex as usize] = 1);
    let used: Vec<u32> = (0..count as u32).filter(|vertex| slots[*vertex as usize] == 1).collect();
    (0_u32..).zip(&used).for_each(|(slot, vertex)| slots[*vertex as usize] = slot);
    let indices = corners.iter().map(|vertex| slots[*vertex as usize]).collect();
    (used, indices)
}
