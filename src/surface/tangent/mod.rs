//! Tangent frames at the vertices of arbitrary triangle meshes (B section 4.2): what takes an eye vector into the
//! space that height maps live in.
//!
//! Each triangle's tangent ∂P/∂u is solved from positions and uv, and the unit tangents of the triangles around a
//! vertex are summed; Gram–Schmidt makes the sum orthogonal to the vertex's normal. The bitangent is
//! `w · cross(normal, tangent)` and points along ∂P/∂v, which is down the image where v starts at its top. (glTF's
//! bitangent points up the image: its `w` has the other sign.)
//!
//! **Decided:** B sums the solved tangents as they are, so that the triangle with the least texture decides, a
//! sliver above all. Here each counts by the chord of its angle at the vertex, 2·sin(θ/2): nearly Thürmer and
//! Wüthrich's angle (1998), which does not depend on how a surface is cut into triangles, without an arc cosine.
//!
//! What has no tangent gets a frame nevertheless, never NaN:
//!
//! - A triangle contributes nothing when f32 cannot tell its tangent: its u, v or size is below 2⁻¹⁰⁰, or its
//!   area, its tangent or its area in uv are below [`DEGENERATE`] of what its extents allow.
//! - A vertex without contributions, or whose sum cancels out ([`VANISHING`]) or lies along the normal, gets the
//!   first vector of the basis that Duff et al. (2017) build from the normal alone, and `w` = 1.
//! - A normal that is zero or not finite (largest component outside 2⁻¹⁰⁰ to 2¹⁰⁰) counts as +Z: the tangent is
//!   (1, 0, 0), `w` = 1. Other normals need not have unit length.
//!
//! `w` is −1 where uv are mirrored. A vertex that mirrored and unmirrored triangles share takes the side of the
//! larger weight, +1 if they are equal; where the mirrored halves' tangents are opposite, none is left. So meshes
//! should be split there, which [`split_mirrored`] does.

use crate::InputError;
use crate::asset::mesh::check_triangles;

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{TangentBuffers, TangentPass};

/// The largest size of a coordinate, of positions and uv.
pub const COORDINATE_LIMIT: f32 = 1e18;

/// A triangle whose area, tangent, or area in uv is no more than this contributes nothing. All three are measured
/// after scaling the triangle to a box of edge 1, in uv in each direction by itself. The errors of
/// f32 are at most a sixteenth of it: they turn a tangent of this length by less than four degrees.
pub const DEGENERATE: f32 = 1.0 / 16_384.0;

/// A sum of tangents vanishes when what is orthogonal to the normal is no more than this share of the weights.
/// Handedness is negative when its sum is below minus this share.
pub const VANISHING: f32 = 1.0 / 64.0;

/// How far a component of a tangent may lie from the twin's, on any device, for a vertex of sensitivity 1
/// ([`crate::surface::tangent::reference::Frame`]).
///
/// With ε = 2⁻²³ (`+ − ×` round to either neighbour, division 2.5ε, `inverseSqrt` 2ε, `sqrt` 4.5ε; fusing only
/// helps): scaled edges of positions and uv carry 3.5ε of at most 1; a product 8ε; the tangent and the face
/// normal, differences of two products, 18ε a component and 32ε as a vector, which normalising divides by their
/// length and adds 5ε to. Unit edges carry 8.5ε, their chord c 17ε + 8ε·c. So a contribution carries
/// 17ε + c·(15ε + 32ε / length), one to the handedness 17ε + c·(27ε + 32ε / length): both less than
/// 32ε·(1 + c·(1 + 1 / length)). Adding n of them costs n·ε of the weights, taking off the normal's part (the
/// unit normal carries 8ε) 20ε. Divided by what is left, that is 52ε·sensitivity; normalising and the second
/// Gram–Schmidt step add 20ε: 72ε < 1e-5. Duff's basis from a normal that carries 8ε stays below 40ε.
pub const TANGENT_BOUND: f32 = 1e-5;

/// A triangle mesh with normals and texture coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Mesh<'a> {
    /// In any unit, finite, no component larger than [`COORDINATE_LIMIT`].
    pub positions: &'a [[f32; 3]],
    /// One a vertex, of any length.
    pub normals: &'a [[f32; 3]],
    /// One a vertex, finite, no component larger than [`COORDINATE_LIMIT`].
    pub uv: &'a [[f32; 2]],
    /// Three a triangle, counter-clockwise seen from where normals point.
    pub indices: &'a [u32],
}

impl Mesh<'_> {
    /// Checks lengths, indices and coordinates.
    ///
    /// # Errors
    /// [`InputError`] that names the field, with its index.
    pub fn validate(&self) -> Result<(), InputError> {
        let vertices = self.positions.len();
        for (field, len) in [("normals.len", self.normals.len()), ("uv.len", self.uv.len())] {
            if len != vertices {
                return Err(InputError::new(field, len, format!("must be {vertices}, one a position")));
            }
        }
        for (field, len) in [("positions.len", vertices), ("indices.len", self.indices.len())] {
            // The adjacency's last offset counts all.
            if u32::try_from(len).is_err() {
                return Err(InputError::new(field, len, format!("must be at most {}", u32::MAX)));
            }
        }
        coordinates("positions", self.positions)?;
        coordinates("uv", self.uv)?;
        check_triangles("indices", self.indices, vertices)
    }
}

fn coordinates<const N: usize>(field: &str, vectors: &[[f32; N]]) -> Result<(), InputError> {
    let good = |coordinate: &f32| coordinate.abs() <= COORDINATE_LIMIT;
    match vectors.iter().flatten().position(|coordinate| !good(coordinate)) {
        None => Ok(()),
        Some(at) => {
            let (vertex, axis) = (at / N, at % N);
            let bound = format!("must be finite and within ±{COORDINATE_LIMIT:e}");
            Err(InputError::new(format!("{field}[{vertex}][{axis}]"), vectors[vertex][axis], bound))
        }
    }
}

/// Which corners of triangles meet at each vertex. The twin and the kernel sum in its order, so that no two runs
/// differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adjacency {
    /// Where each vertex's corners begin; one more than there are vertices.
    pub offsets: Vec<u32>,
    /// Positions in the indices, ascending at each vertex.
    pub corners: Vec<u32>,
}

impl Adjacency {
    /// Of valid `indices` to `vertices` vertices.
    pub(crate) fn new(vertices: usize, indices: &[u32]) -> Self {
        let mut offsets = vec![0; vertices + 1];
        for index in indices {
            offsets[*index as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut next = offsets.clone();
        let mut corners = vec![0; indices.len()];
        for (index, corner) in indices.iter().zip(0..) {
            let place = &mut next[*index as usize];
            corners[*place as usize] = corner;
            *place += 1;
        }
        Self { offsets, corners }
    }

    /// The corners at a vertex.
    pub fn at(&self, vertex: usize) -> &[u32] {
        &self.corners[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }
}

/// What [`split_mirrored`] makes of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Split {
    /// Vertices to append to positions, normals, uv and whatever else there is: copies of these.
    pub copies: Vec<u32>,
    /// The triangles, in order, with mirrored ones at the copies.
    pub indices: Vec<u32>,
}

/// Gives vertices that mirrored and unmirrored triangles share a copy for the mirrored ones. Triangles without
/// area in uv stay where they are.
///
/// # Errors
/// [`InputError`] for indices out of bounds or not a multiple of 3 of them, and for more than 2³² vertices.
pub fn split_mirrored(uv: &[[f32; 2]], indices: &[u32]) -> Result<Split, InputError> {
    check_triangles("indices", indices, uv.len())?;
    let area = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|corner| uv[triangle[corner] as usize].map(f64::from));
        (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
    };
    let mut unmirrored_too = vec![false; uv.len()];
    for triangle in indices.chunks_exact(3).filter(|triangle| area(triangle) > 0.0) {
        triangle.iter().for_each(|index| unmirrored_too[*index as usize] = true);
    }
    let mut copy_of = vec![None; uv.len()];
    let mut split = Split { copies: Vec::new(), indices: indices.to_vec() };
    for triangle in split.indices.chunks_exact_mut(3).filter(|triangle| area(triangle) < 0.0) {
        for index in triangle {
            let vertex = *index as usize;
            if !unmirrored_too[vertex] {
                continue;
            }
            let next = uv.len() + split.copies.len();
            let next = u32::try_from(next)
                .map_err(|_| InputError::new("uv.len", uv.len(), "leaves no index for a copy"))?;
            let copy = *copy_of[vertex].get_or_insert(next);
            if copy == next {
                split.copies.push(*index);
            }
            *index = copy;
        }
    }
    Ok(split)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MESH: Mesh<'static> = Mesh {
        positions: &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        normals: &[[0.0, 0.0, 1.0]; 3],
        uv: &[[0.0; 2], [1.0, 0.0], [0.0, 1.0]],
        indices: &[0, 1, 2],
    };

    fn refused(mesh: &Mesh<'_>, field: &str, value: &str) {
        let error = mesh.validate().expect_err("refused");
        assert_eq!((error.field.as_str(), error.value.as_str()), (field, value));
    }

    #[test]
    fn meshes_are_checked_field_by_field() {
        assert_eq!(MESH.validate(), Ok(()));
        assert_eq!(Mesh { positions: &[], normals: &[], uv: &[], indices: &[] }.validate(), Ok(()));
        refused(&Mesh { normals: &MESH.normals[1..], ..MESH }, "normals.len", "2");
        refused(&Mesh { uv: &MESH.uv[..1], ..MESH }, "uv.len", "1");
        refused(&Mesh { indices: &[0, 1, 2, 0], ..MESH }, "indices.len", "4");
        refused(&Mesh { indices: &[0, 1, 3], ..MESH }, "indices[2]", "3");
        for (wrong, value) in [(f32::NAN, "NaN"), (f32::NEG_INFINITY, "-inf"), (2e18, "2000000000000000000")]
        {
            let mut positions = MESH.positions.to_vec();
            positions[1][2] = wrong;
            refused(&Mesh { positions: &positions, ..MESH }, "positions[1][2]", value);
            let mut uv = MESH.uv.to_vec();
            uv[2][0] = wrong;
            refused(&Mesh { uv: &uv, ..MESH }, "uv[2][0]", value);
        }
        let limits = [[COORDINATE_LIMIT, -COORDINATE_LIMIT, 0.0]; 3];
        let normals = [[f32::NAN, f32::INFINITY, 0.0]; 3];
        assert_eq!(Mesh { positions: &limits, normals: &normals, ..MESH }.validate(), Ok(()));
    }

    #[test]
    fn corners_ascend_at_each_vertex() {
        let adjacency = Adjacency::new(5, &[3, 0, 1, 1, 0, 4, 0, 0, 3]);
        assert_eq!(adjacency.offsets, [0, 4, 6, 6, 8, 9]);
        let corners: Vec<_> = (0..5).map(|vertex| adjacency.at(vertex).to_vec()).collect();
        assert_eq!(corners, [vec![1, 4, 6, 7], vec![2, 3], vec![], vec![0, 8], vec![5]]);
    }

    #[test]
    fn mirrored_triangles_get_copies_of_shared_vertices() {
        // Two halves mirrored at the edge from 1 to 2, and a triangle without area.
        let uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        let split = split_mirrored(&uv, &[0, 1, 2, 1, 3, 2, 3, 2, 2]);
        let expected = Split { copies: vec![1, 2], indices: vec![0, 1, 2, 4, 3, 5, 3, 2, 2] };
        assert_eq!(split, Ok(expected));
        let whole = split_mirrored(&uv, &[1, 0, 2]);
        assert_eq!(whole, Ok(Split { copies: vec![], indices: vec![1, 0, 2] }));
        assert_eq!(split_mirrored(&uv, &[0, 1, 4]).expect_err("refused").field, "indices[2]");
    }
}
