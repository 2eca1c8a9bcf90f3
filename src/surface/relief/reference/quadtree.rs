//! Max-mip traversal: the CPU reference of `wgsl/surface/quadtree.wgsl`.

use super::grid::{Grid, Node};
use crate::surface::height_pyramid::PyramidLayout;
use crate::surface::map::HeightMap;
use crate::surface::relief::{March, Outcome, ReliefHit, ReliefRay};

/// Traces a ray by traversing the map's max-mip pyramid. The pyramid must have been computed for the address mode of `march`.
pub(crate) fn quadtree(map: &HeightMap, pyramid: &[f32], ray: &ReliefRay, march: &March) -> ReliefHit {
    let layout = PyramidLayout::new([map.width(), map.height()], march.address);
    let grid = Grid::new(map, ray, march.address);
    let top = layout.levels - 1;
    let longest = grid.travel[0].abs().max(grid.travel[1].abs()) as u32;
    let mut level = (longest / 2).max(1).ilog2().min(top);
    let (mut cell, mut parameter, mut samples) = ([0, 0], 0.0, 0);
    for _ in 0..grid.bound(top) {
        let node = grid.node(cell, level);
        let exits = grid.exits(&node);
        let leave = exits[0].min(exits[1]).max(parameter).min(1.0);
        let highest = pyramid[layout.index(level, node.index.map(|at| at as u32))];
        samples += 1;
        if 1.0 - leave <= highest {
            parameter = f32::max(parameter, 1.0 - highest);
            if level > 0 {
                level -= 1;
                cell = grid.cell(&node, parameter);
                continue;
            }
            let corners = grid.corners(map, node.index);
            samples += 4;
            let found = grid.patch(corners, node.corner(), parameter, leave);
            if found >= 0.0 {
                return ReliefHit::of(ray, found, samples, Outcome::Hit);
            }
            if leave >= 1.0 {
                return ReliefHit::of(ray, 1.0, samples, Outcome::Hit);
            }
        }
        cell = grid.beyond(&node, exits, leave);
        parameter = leave;
        if leaves_parent(&grid, &node, exits, level) {
            level = (level + 1).min(top);
        }
    }
    ReliefHit::of(ray, parameter, samples, Outcome::Exhausted)
}

fn leaves_parent(grid: &Grid, node: &Node, exits: [f32; 2], level: u32) -> bool {
    let axis = usize::from(exits[0] > exits[1]);
    let index = node.index[axis];
    let is_odd = index & 1 == 1;
    let is_last = (index + 1) << level >= grid.cells[axis];
    if grid.travel[axis] >= 0.0 { is_odd || is_last } else { !is_odd }
}
