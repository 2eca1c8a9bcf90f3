//! Tangent frames at the vertices of triangle meshes (thesis B, section 4.2). A tangent frame transforms a view vector into the
//! space of height maps.
//!
//! The tangent ∂P/∂u of each triangle is solved from positions and uv. The unit tangents of the triangles around a vertex are
//! summed. Gram–Schmidt makes the sum orthogonal to the vertex's normal. The bitangent is `w · cross(normal, tangent)`. It points
//! along ∂P/∂v, which is down the image if v starts at the top. (In glTF, the bitangent points up the image, so glTF's `w` has
//! the opposite sign.)
//!
//! **Decided**: thesis B sums the solved tangents without normalizing them. Without normalization, the triangle with the smallest
//! extent in the texture dominates, especially if it is a sliver. Here each triangle is weighted by the chord of its angle at the
//! vertex, 2·sin(θ/2). This weight is close to the angle weight of Thürmer and Wüthrich (1998), which does not depend on how a
//! surface is triangulated. The chord needs no arc cosine.
//!
//! Vertices without a defined tangent also get a frame, never NaN:
//!
//! - A triangle contributes nothing if f32 cannot resolve its tangent. This is the case if its extent in u, v or space is below
//!   2⁻¹⁰⁰. It is also the case if its area, tangent or uv area is below the fraction [`DEGENERATE`] of the largest value that
//!   its extents allow.
//! - In three cases, the tangent comes from the normal alone: no triangle contributes, the sum cancels out ([`VANISHING`]), or
//!   the sum lies along the normal. The tangent is then the first vector of the basis of Duff et al. (2017), and `w` is 1.
//! - A normal that is zero or not finite (largest component outside 2⁻¹⁰⁰ to 2¹⁰⁰) counts as +Z. The tangent is then (1, 0, 0),
//!   and `w` is 1. Other normals need not have unit length.
//!
//! `w` is −1 where uv are mirrored. If mirrored and unmirrored triangles share a vertex, the group with the larger total weight
//! decides `w`. If the weights are equal, `w` is +1. If the tangents of both groups are opposite, their sum vanishes. Meshes
//! should therefore be split at such vertices, for example by [`split_mirrored`].

use crate::InputError;
use crate::asset::indices::check_triangles;
#[doc(inline)]
pub use crate::asset::tangents::{
    Adjacency, COORDINATE_LIMIT, DEGENERATE, TANGENT_BOUND, TangentMesh, VANISHING,
};
use crate::asset::tangents::{LARGEST_BITS, LEAST_BITS};
use crate::shared::surface::tangent as shared;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{TangentBuffers, TangentPass};

// `relievo-asset` repeats the constants of the kernel.
const _: () = assert!(DEGENERATE.to_bits() == shared::DEGENERATE.to_bits());
const _: () = assert!(VANISHING.to_bits() == shared::VANISHING.to_bits());
const _: () = assert!(LEAST_BITS == shared::LEAST_BITS && LEAST_BITS == shared::LEAST.to_bits());
const _: () = assert!(LARGEST_BITS == shared::LARGEST_BITS);

/// Result of [`split_mirrored`]: the vertices to copy and the changed triangles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Split {
    /// Indices of the vertices to copy. Append the copies to positions, normals, uv and every other vertex attribute.
    pub copies: Vec<u32>,
    /// Vertex indices of all triangles, in their original order. Mirrored triangles refer to the copies.
    pub indices: Vec<u32>,
}

/// Splits the vertices that mirrored and unmirrored triangles share: mirrored triangles get copies of the vertices. Triangles
/// without area in uv do not change.
///
/// # Errors
/// [`InputError`] if an index is out of bounds, if the number of indices is not a multiple of 3, and if there would be more than
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
        // Two triangles mirrored at the edge from 1 to 2, and a triangle without area.
        let uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        let split = split_mirrored(&uv, &[0, 1, 2, 1, 3, 2, 3, 2, 2]);
        let expected = Split { copies: vec![1, 2], indices: vec![0, 1, 2, 4, 3, 5, 3, 2, 2] };
        assert_eq!(split, Ok(expected));
        let whole = split_mirrored(&uv, &[1, 0, 2]);
        assert_eq!(whole, Ok(Split { copies: vec![], indices: vec![1, 0, 2] }));
        assert_eq!(split_mirrored(&uv, &[0, 1, 4]).expect_err("refused").path, "indices[2]");
    }
}
