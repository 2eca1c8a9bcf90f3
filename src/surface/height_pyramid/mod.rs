//! Max-mip pyramids of height maps (thesis B, section 2.3.4). A leaf of a pyramid is the height of the highest corner of a
//! bilinear cell. Every other node is the maximum of its four children. The method `quadtree` traverses pyramids, and cone maps
//! are computed from them.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{HeightPyramidPass, Pyramids};

use crate::surface::map::Address;

/// Memory layout of a pyramid's nodes. All levels share one plane of nodes. Its rows are padded so that the plane can be copied
/// to a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PyramidLayout {
    /// Number of texels of the height map along x and y.
    pub size: [u32; 2],
    /// Number of bilinear cells along x and y. With [`Address::Wrap`] it equals the number of texels; with [`Address::Clamp`] it
    /// is one more per axis.
    pub cells: [u32; 2],
    /// Number of nodes per row of the plane, including padding.
    pub pitch: u32,
    /// Number of rows of the plane.
    pub rows: u32,
    /// Number of levels: from level 0 with one node per cell, to the last level with a single node.
    pub levels: u32,
}

impl PyramidLayout {
    /// Computes the layout for a height map of `size` texels.
    pub fn new(size: [u32; 2], address: Address) -> Self {
        let cells = match address {
            Address::Wrap => size,
            Address::Clamp => size.map(|edge| edge + 1),
        };
        let levels = cells[0].max(cells[1]).next_power_of_two().ilog2() + 1;
        // Rows of a texture copy must start at multiples of 256 bytes.
        let width = cells[0].next_multiple_of(4) + cells[0].div_ceil(2);
        let mut layout = Self { size, cells, pitch: width.next_multiple_of(64), rows: cells[1], levels };
        for level in 1..levels {
            layout.rows = layout.rows.max(layout.first(level)[1] + layout.nodes(level)[1]);
        }
        layout
    }

    /// Number of nodes of a level along x and y.
    pub fn nodes(&self, level: u32) -> [u32; 2] {
        self.cells.map(|cells| cells.div_ceil(1 << level))
    }

    /// Number of nodes in the plane, including padding.
    pub fn len(&self) -> usize {
        self.pitch as usize * self.rows as usize
    }

    /// Always false: a pyramid has at least one node.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Index of a node in the plane, from its level and its column and row in that level. Elements of the plane that belong to no
    /// level are padding and may have any value.
    pub fn index(&self, level: u32, node: [u32; 2]) -> usize {
        let first = self.first(level);
        ((first[1] + node[1]) * self.pitch + first[0] + node[0]) as usize
    }

    /// Column and row of a level's first node in the plane.
    fn first(&self, level: u32) -> [u32; 2] {
        match level.checked_sub(1) {
            None => [0, 0],
            Some(before) => {
                [self.cells[0].next_multiple_of(4), self.cells[1] - (self.cells[1] >> before) + before]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_nodes_share_a_place() {
        for size in [[1, 1], [2, 1], [1, 9], [3, 3], [4, 4], [5, 7], [17, 33], [64, 64], [100, 1]] {
            for address in [Address::Wrap, Address::Clamp] {
                let layout = PyramidLayout::new(size, address);
                let mut taken = vec![false; layout.len()];
                for level in 0..layout.levels {
                    let [columns, rows] = layout.nodes(level);
                    for y in 0..rows {
                        for x in 0..columns {
                            let index = layout.index(level, [x, y]);
                            assert!(!std::mem::replace(&mut taken[index], true), "{size:?} {level} {x} {y}");
                        }
                    }
                }
                assert_eq!(layout.nodes(layout.levels - 1), [1, 1]);
            }
        }
    }
}
