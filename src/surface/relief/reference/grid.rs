//! Grid of bilinear cells of a height map: the CPU reference of `wgsl/surface/grid.wgsl`.

use crate::shared::surface::grid::{
    SURFACE_FAR as FAR, SURFACE_LEAST_TRAVEL as LEAST_TRAVEL, SURFACE_MAX_CROSSED, SURFACE_NEVER as NEVER,
};
use crate::surface::map::{Address, HeightMap};
use crate::surface::relief::ReliefRay;

/// Grid of bilinear cells that a ray crosses. A cell lies between four texel centers.
pub(crate) struct Grid {
    size: [i32; 2],
    pub cells: [i32; 2],
    base: [i32; 2],
    pub start: [f32; 2],
    pub travel: [f32; 2],
    inverse: [f32; 2],
    address: Address,
}

/// A square of cells: a node of the pyramid. `index` is the node's column and row in its level. `low` and `high` are its edges,
/// in cells from the grid's base; `high` is exclusive.
pub(crate) struct Node {
    pub index: [i32; 2],
    low: [i32; 2],
    high: [i32; 2],
}

impl Grid {
    pub(crate) fn new(map: &HeightMap, ray: &ReliefRay, address: Address) -> Self {
        let size = [map.width(), map.height()];
        let texel = [0, 1].map(|i| ray.origin[i] * size[i] as f32 - 0.5);
        let travel = [0, 1].map(|i| ray.slope[i] * size[i] as f32);
        let inverse = travel.map(|travel| if travel.abs() < LEAST_TRAVEL { 0.0 } else { 1.0 / travel });
        let size = size.map(|edge| edge as i32);
        let base = [0, 1].map(|i| texel[i].floor() as i32);
        let (base, cells) = match address {
            Address::Wrap => ([0, 1].map(|i| base[i].rem_euclid(size[i])), size),
            Address::Clamp => (base, size.map(|edge| edge + 1)),
        };
        Self { size, cells, base, start: texel.map(|at| at - at.floor()), travel, inverse, address }
    }

    pub(crate) fn bound(&self, levels: u32) -> u32 {
        let crossed = (self.travel[0].abs() + self.travel[1].abs()).min(SURFACE_MAX_CROSSED);
        2 * (crossed as u32 + 3) + levels
    }

    pub(crate) fn node(&self, cell: [i32; 2], level: u32) -> Node {
        let axis = |axis: usize| {
            let absolute = self.base[axis] + cell[axis];
            let (inside, tile) = match self.address {
                Address::Wrap => {
                    let inside = absolute.rem_euclid(self.size[axis]);
                    (inside, absolute - inside - self.base[axis])
                }
                Address::Clamp => ((absolute + 1).clamp(0, self.size[axis]), -1 - self.base[axis]),
            };
            let index = inside >> level;
            let first = index << level;
            let last = (first + (1 << level)).min(self.cells[axis]);
            let reaches = |rim: bool| self.address == Address::Clamp && rim;
            let low = if reaches(first == 0) { -FAR } else { tile + first };
            let high = if reaches(last == self.cells[axis]) { FAR } else { tile + last };
            (index, low, high)
        };
        let (x, y) = (axis(0), axis(1));
        Node { index: [x.0, y.0], low: [x.1, y.1], high: [x.2, y.2] }
    }

    pub(crate) fn exits(&self, node: &Node) -> [f32; 2] {
        [0, 1].map(|axis| {
            let edge = if self.travel[axis] >= 0.0 { node.high[axis] } else { node.low[axis] };
            let exit = (edge as f32 - self.start[axis]) * self.inverse[axis];
            if self.inverse[axis] == 0.0 { NEVER } else { exit }
        })
    }

    pub(crate) fn cell(&self, node: &Node, parameter: f32) -> [i32; 2] {
        let at = self.at(parameter);
        [0, 1].map(|axis| at[axis].clamp(node.low[axis], node.high[axis] - 1))
    }

    /// Cell that contains the ray at a parameter, in cells from the grid's base.
    pub(crate) fn at(&self, parameter: f32) -> [i32; 2] {
        [0, 1].map(|axis| (self.start[axis] + parameter * self.travel[axis]).floor() as i32)
    }

    pub(crate) fn beyond(&self, node: &Node, exits: [f32; 2], parameter: f32) -> [i32; 2] {
        let mut next = self.cell(node, parameter);
        let axis = usize::from(exits[0] > exits[1]);
        next[axis] = if self.travel[axis] >= 0.0 { node.high[axis] } else { node.low[axis] - 1 };
        next
    }

    /// Heights of a cell's four corners, in the order (0,0), (1,0), (0,1), (1,1).
    pub(crate) fn corners(&self, map: &HeightMap, index: [i32; 2]) -> [f32; 4] {
        let first = if self.address == Address::Wrap { index } else { index.map(|at| at - 1) };
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| map.texel(first[0] + dx, first[1] + dy, self.address))
    }

    /// Returns the first parameter in enter..=leave at which the ray is on or below a cell's bilinear patch, or −1 if there is
    /// none. `low` is the cell's lower corner.
    pub(crate) fn patch(&self, corners: [f32; 4], low: [i32; 2], enter: f32, leave: f32) -> f32 {
        let [h00, h10, h01, h11] = corners;
        let at = [0, 1].map(|i| (self.start[i] - low[i] as f32) + enter * self.travel[i]);
        let slope = [h10 - h00, h01 - h00];
        let twist = (h11 - h01) - slope[0];
        let length = leave - enter;
        let ahead = self.travel.map(|travel| travel * length);
        let height = h00 + slope[0] * at[0] + (slope[1] + twist * at[0]) * at[1];
        let c = 1.0 - enter - height;
        if c <= 0.0 {
            return enter;
        }
        let b = -0.5
            * (length
                + slope[0] * ahead[0]
                + slope[1] * ahead[1]
                + twist * (at[0] * ahead[1] + at[1] * ahead[0]));
        let a = -twist * ahead[0] * ahead[1];
        let discriminant = b * b - a * c;
        let root = discriminant.max(0.0).sqrt();
        let (over, under) = if b > 0.0 { (b + root, -a) } else { (c, root - b) };
        if discriminant >= 0.0 && under >= over {
            return enter + length * (over / under);
        }
        if a + 2.0 * b + c <= 0.0 { leave } else { -1.0 }
    }
}

impl Node {
    /// Corner of a leaf that serves as the origin of its bilinear patch.
    pub(crate) fn corner(&self) -> [i32; 2] {
        [0, 1].map(|axis| if self.low[axis] == -FAR { self.high[axis] - 1 } else { self.low[axis] })
    }
}
