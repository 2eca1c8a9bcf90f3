//! Tangent frames at the vertices of arbitrary triangle meshes (B section 4.2). They transform an eye vector into the space of
//! height maps.
//!
//! The tangent ∂P/∂u of each triangle is solved from positions and uv. The unit tangents of the triangles around a vertex are
//! summed, and Gram–Schmidt makes the sum orthogonal to the vertex's normal. The bitangent is `w · cross(normal, tangent)` and
//! points along ∂P/∂v, which is down the image if v starts at the top. (glTF's bitangent points up the image, so that its `w`
//! has the opposite sign.)
//!
//! **Decided**: B sums the solved tangents as they are, so that the triangle with the smallest extent in the texture dominates,
//! above all a sliver. Here each triangle is weighted by the chord of its angle at the vertex, 2·sin(θ/2). That is close to the
//! angle weight of Thürmer and Wüthrich (1998), which does not depend on the triangulation of a surface, and needs no arc
//! cosine.
//!
//! Vertices without a tangent get a frame too, never NaN:
//!
//! - A triangle contributes nothing when f32 cannot resolve its tangent: its extent in u, v or space is below 2⁻¹⁰⁰, or its
//!   area, its tangent or its area in uv is below [`DEGENERATE`] of what its extents permit.
//! - A vertex without contributions, or whose sum cancels out ([`VANISHING`]) or lies along the normal, gets the first vector
//!   of the basis that Duff et al. (2017) construct from the normal alone, and `w` = 1.
//! - A normal that is zero or not finite (largest component outside 2⁻¹⁰⁰ to 2¹⁰⁰) counts as +Z: the tangent is (1, 0, 0), and
//!   `w` = 1. Other normals need not have unit length.
//!
//! `w` is −1 where uv are mirrored. A vertex that mirrored and unmirrored triangles share takes the sign of the larger weight,
//! or +1 if they are equal. If the tangents of the two halves are opposite, the sum vanishes. Meshes should therefore be split
//! there; [`split_mirrored`] does so.

use crate::InputError;
use crate::asset::indices::check_triangles;
pub use crate::asset::tangents::{
    Adjacency, COORDINATE_LIMIT, DEGENERATE, TANGENT_BOUND, TangentMesh, VANISHING,
};

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{TangentBuffers, TangentPass};

/// The result of [`split_mirrored`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Split {
    /// Indices of the vertices to copy: append the copies to positions, normals, uv and every other attribute.
    pub copies: Vec<u32>,
    /// The triangles in order; mirrored ones refer to the copies.
    pub indices: Vec<u32>,
}

/// Splits vertices that mirrored and unmirrored triangles share: mirrored triangles get copies of the vertices. Triangles
/// without area in uv are left alone.
///
/// # Errors
/// [`InputError`] for indices that are out of bounds, for a number of indices that is not a multiple of 3, and for more than
/// 2³² vertices.
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

    #[test]
    fn mirrored_triangles_get_copies_of_shared_vertices() {
        // Two halves mirrored at the edge from 1 to 2, and a triangle without area.
        let uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        let split = split_mirrored(&uv, &[0, 1, 2, 1, 3, 2, 3, 2, 2]);
        let expected = Split { copies: vec![1, 2], indices: vec![0, 1, 2, 4, 3, 5, 3, 2, 2] };
        assert_eq!(split, Ok(expected));
        let whole = split_mirrored(&uv, &[1, 0, 2]);
        assert_eq!(whole, Ok(Split { copies: vec![], indices: vec![1, 0, 2] }));
        assert_eq!(split_mirrored(&uv, &[0, 1, 4]).expect_err("refused").path, "indices[2]");
    }
}
