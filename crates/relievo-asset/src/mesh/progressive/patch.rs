//! Difference between the triangles of a level and the triangles of the next coarser level.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::InputError;

/// The changes that turn the next coarser level into a level. They add vertices and triangles, and replace the partner
/// of a vertex by the vertex itself at some corners.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IndexPatch {
    first: u32,
    end: u32,
    added: Vec<[u32; 4]>,
    corners: Vec<[u32; 2]>,
}

impl IndexPatch {
    /// Range of vertices that the level has in addition to the coarser level.
    pub fn vertices(&self) -> Range<u32> {
        self.first..self.end
    }

    /// Triangles that the level adds, ascending. Each entry has the triangle's index in the level's list, and its three
    /// corners.
    pub fn added(&self) -> &[[u32; 4]] {
        &self.added
    }

    /// Changed corners of the other triangles, ascending. Each entry has a position in the level's index list, and the
    /// vertex there. In the coarser level, this corner is the vertex's partner.
    pub fn corners(&self) -> &[[u32; 2]] {
        &self.corners
    }

    /// Makes the patch from the triangles of a level (`fine`) and the triangles of the next coarser level (`coarse`).
    /// The coarser level lacks the vertices of `run`. Returns `None` unless replacing corners by partners and dropping
    /// triangles turns `fine` into `coarse`.
    pub(super) fn between([fine, coarse]: [&[u32]; 2], run: Range<u32>, partners: &[u32]) -> Option<Self> {
        let mut patch = Self { first: run.start, end: run.end, added: Vec::new(), corners: Vec::new() };
        let mut left = coarse.as_chunks::<3>().0.iter().peekable();
        for (at, triangle) in (0..).zip(fine.as_chunks::<3>().0) {
            let moved =
                triangle.map(|vertex| if run.contains(&vertex) { partners[vertex as usize] } else { vertex });
            if left.next_if(|next| **next == moved).is_none() {
                let [a, b, c] = *triangle;
                patch.added.push([at, a, b, c]);
                continue;
            }
            let corners = (3 * at..).zip(triangle).filter(|(_, vertex)| run.contains(vertex));
            patch.corners.extend(corners.map(|(place, vertex)| [place, *vertex]));
        }
        left.next().is_none().then_some(patch)
    }

    /// The triangles of the level, computed from the triangles of the coarser level.
    pub(super) fn applied(&self, coarse: &[u32], partners: &[u32]) -> Result<Vec<u32>, InputError> {
        if !coarse.len().is_multiple_of(3) {
            return Err(InputError::new("triangles.len", coarse.len(), "must be a multiple of 3"));
        }
        let mut fine: Vec<u32> = Vec::with_capacity(coarse.len() + 3 * self.added.len());
        let mut others = coarse;
        for (at, [number, a, b, c]) in self.added.iter().enumerate() {
            let until = (3 * *number as usize).checked_sub(fine.len());
            let Some((before, after)) = until.and_then(|until| others.split_at_checked(until)) else {
                let bound = "must ascend, and be at most the number of triangles before it";
                return Err(InputError::new(format!("added[{at}]"), number, bound));
            };
            fine.extend(before);
            fine.extend([a, b, c]);
            others = after;
        }
        fine.extend(others);
        for (at, [place, vertex]) in self.corners.iter().enumerate() {
            let partner = partners.get(*vertex as usize);
            match fine.get_mut(*place as usize) {
                Some(corner) if Some(&*corner) == partner => *corner = *vertex,
                _ => {
                    let bound = "must be a corner that has the vertex's partner";
                    return Err(InputError::new(format!("corners[{at}]"), place, bound));
                }
            }
        }
        Ok(fine)
    }

    /// The triangles of the coarser level, computed from the triangles of the level.
    pub(super) fn undone(&self, fine: &[u32], partners: &[u32]) -> Result<Vec<u32>, InputError> {
        let mut moved = fine.to_vec();
        for (at, [place, vertex]) in self.corners.iter().enumerate() {
            match (moved.get_mut(*place as usize), partners.get(*vertex as usize)) {
                (Some(corner), Some(partner)) if corner == vertex => *corner = *partner,
                _ => {
                    let bound = format!("must have the vertex {vertex}, as the level has");
                    return Err(InputError::new(format!("triangles[{place}] (corners[{at}])"), place, bound));
                }
            }
        }
        let mut added = self.added.iter().peekable();
        let mut coarse = Vec::with_capacity(fine.len().saturating_sub(3 * self.added.len()));
        for (number, [a, b, c]) in (0..).zip(moved.as_chunks::<3>().0) {
            if added.next_if(|triangle| **triangle == [number, *a, *b, *c]).is_none() {
                coarse.extend([a, b, c]);
            }
        }
        match added.next() {
            None => Ok(coarse),
            Some([number, ..]) => {
                Err(InputError::new("triangles", *number, "must have the triangle that the level adds there"))
            }
        }
    }
}
