//! Nodes of an endless terrain: their samples, extremes, and deviation from finer heights.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::terrain::node::{NODE_FACTS, NODE_MARGIN};
#[cfg(feature = "gpu")]
pub use pass::{NodeBuffers, NodePass};

/// The size of nodes, and how much finer the heights are from which they are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeShape {
    /// Number of samples along an edge of a node, 2^n + 1.
    pub size: u32,
    /// Number of levels by which the finer heights are finer, 0 to 4.
    pub finer: u32,
}

impl NodeShape {
    /// Number of samples along an edge of a node's tile, which has a margin of [`NODE_MARGIN`] samples on every side.
    pub fn tile_width(self) -> u32 {
        self.size + 2 * NODE_MARGIN
    }

    /// Number of normals along an edge of a node: twice the resolution of its samples.
    pub fn normals_width(self) -> u32 {
        2 * self.size - 1
    }

    /// Number of samples along an edge of the region of finer heights.
    pub fn region_width(self) -> u32 {
        ((self.tile_width() - 1) << self.finer) + 1
    }
}

/// Facts about a node, in 1/65536 height units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeFacts {
    /// The lowest height, of the node and of the finer heights.
    pub lowest: i32,
    /// The highest height.
    pub highest: i32,
    /// The largest deviation of a finer height from the node's triangles, rounded up.
    pub deviation: u32,
    /// The same from the triangles of stitched borders: the odd vertices of a border lie in even ones, as beside a coarser neighbour.
    pub stitched: u32,
    /// Half the largest second difference of neighbouring finer heights, in the node and in its margin: along a row, along a column,
    /// and the twist of a cell. Rounded up.
    pub second_difference: u32,
}

impl NodeFacts {
    /// The facts from the kernel's words; `None` for a node that the kernel has not made.
    pub fn from_words(words: [u32; NODE_FACTS as usize]) -> Option<Self> {
        let [highest, lowest, deviation, stitched, second_difference] = words;
        let height = |word: u32| (word ^ 0x8000_0000) as i32;
        let [highest, lowest] = [height(highest), height(!lowest)];
        (words != [0; NODE_FACTS as usize]).then_some(Self {
            lowest,
            highest,
            deviation,
            stitched,
            second_difference,
        })
    }

    /// The facts in the kernel's words.
    pub fn words(&self) -> [u32; NODE_FACTS as usize] {
        let word = |height: i32| height as u32 ^ 0x8000_0000;
        [word(self.highest), !word(self.lowest), self.deviation, self.stitched, self.second_difference]
    }
}
