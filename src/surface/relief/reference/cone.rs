//! Cone stepping: the CPU reference of `wgsl/surface/cone.wgsl`.

use super::grid::Grid;
use super::linear::narrowed;
use crate::surface::map::HeightMap;
use crate::surface::relief::{March, Outcome, ReliefHit, ReliefRay};

/// Traces a ray by stepping over the map's cones. For each cell, row by row, `cones` has the height of the highest corner and the
/// cone radius. The cones must have been computed for the address mode of `march`.
pub(crate) fn cone(map: &HeightMap, cones: &[[f32; 2]], ray: &ReliefRay, march: &March) -> ReliefHit {
    let grid = Grid::new(map, ray, march.address);
    let distance = (grid.travel[0] * grid.travel[0] + grid.travel[1] * grid.travel[1]).sqrt();
    let (mut cell, mut parameter, mut above, mut samples) = ([0, 0], 0.0, 0.0, 0);
    for _ in 0..grid.bound(0) {
        let node = grid.node(cell, 0);
        let exits = grid.exits(&node);
        let leave = exits[0].min(exits[1]).max(parameter).min(1.0);
        let [highest, radius] = cones[(node.index[1] * grid.cells[0] + node.index[0]) as usize];
        samples += 1;
        let room = 1.0 - parameter - highest;
        if 1.0 - leave > highest {
            above = parameter;
            let reach = parameter + radius * room / (distance + radius);
            if reach > leave {
                parameter = reach.min(1.0);
                cell = grid.at(parameter);
                continue;
            }
        } else {
            samples += 4;
            let found = grid.patch(grid.corners(map, node.index), node.corner(), parameter, leave);
            if found > parameter || (found == parameter && above == parameter) {
                return ReliefHit::of(ray, found, samples, Outcome::Hit);
            }
            if found >= 0.0 {
                return narrowed(map, ray, march, [above, parameter], samples);
            }
            if leave >= 1.0 {
                return ReliefHit::of(ray, 1.0, samples, Outcome::Hit);
            }
            above = parameter;
        }
        cell = grid.beyond(&node, exits, leave);
        parameter = leave;
    }
    ReliefHit::of(ray, parameter, samples, Outcome::Exhausted)
}
