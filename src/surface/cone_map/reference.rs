//! Cone maps: the CPU reference of `kernels/surface/cone_map.wgsl`.

use crate::parallel;
use crate::shared::surface::cone_map::{LEAST_RISE, NARROWING, OPENING, WIDEST};
use crate::surface::height_pyramid::PyramidLayout;
use crate::surface::map::{Address, HeightMap};

/// Cone map of a height map, from the map and its pyramid. For each cell, row by row, it has the height of the highest corner and
/// the cone radius.
pub fn cone_map(map: &HeightMap, pyramid: &[f32], address: Address) -> Vec<[f32; 2]> {
    let layout = PyramidLayout::new([map.width(), map.height()], address);
    Search { map, pyramid, layout, address, rounding: 1.0 }.cones()
}

struct Search<'a> {
    map: &'a HeightMap,
    pyramid: &'a [f32],
    layout: PyramidLayout,
    address: Address,
    /// What rounding makes of a reach: a factor, 1 but for tests.
    rounding: f32,
}

impl Search<'_> {
    fn cones(&self) -> Vec<[f32; 2]> {
        let [columns, rows] = self.layout.cells;
        let cell = |at: usize| [at as u32 % columns, at as u32 / columns].map(|along| along as i32);
        parallel::map_range((columns * rows) as usize, |at| self.cone(cell(at)))
    }

    fn cone(&self, cell: [i32; 2]) -> [f32; 2] {
        let cells = self.layout.cells.map(|edge| edge as i32);
        let own = self.highest(0, cell);
        let mut radius = cells[0].min(cells[1]) as f32;
        let images = if self.address == Address::Wrap { 9 } else { 1 };
        for image in 0..images {
            let number = (image + 4) % 9;
            let offset = [(number % 3 - 1) * cells[0], (number / 3 - 1) * cells[1]];
            radius = self.narrowed([cell[0] - offset[0], cell[1] - offset[1]], own, radius);
        }
        [own, radius * NARROWING]
    }

    fn highest(&self, level: u32, node: [i32; 2]) -> f32 {
        self.pyramid[self.layout.index(level, node.map(|at| at as u32))]
    }

    fn corners(&self, node: [i32; 2]) -> [f32; 4] {
        let first = if self.address == Address::Wrap { node } else { node.map(|at| at - 1) };
        [[0, 0], [1, 0], [0, 1], [1, 1]]
            .map(|[dx, dy]| self.map.texel(first[0] + dx, first[1] + dy, self.address))
    }

    /// Returns `radius`, narrowed by the nodes of one periodic image of the tile. `cell` is relative to that image.
    fn narrowed(&self, cell: [i32; 2], own: f32, radius: f32) -> f32 {
        let cells = self.layout.cells.map(|edge| edge as i32);
        let top = self.layout.levels - 1;
        let at_rim = |i: usize| cell[i] <= 0 || cell[i] >= cells[i] - 1;
        let is_rim = self.address == Address::Clamp && (at_rim(0) || at_rim(1));
        let (mut narrowest, mut level, mut node, mut orders) = (radius, top, [0, 0], 0_u32);
        loop {
            let low = node.map(|at| at << level);
            let mut open = false;
            if low[0] < cells[0] && low[1] < cells[1] {
                let gap = [0, 1].map(|i| {
                    let high = (low[i] + (1 << level)).min(cells[i]);
                    (low[i] - cell[i] - 1).max(cell[i] - high).max(0) as f32
                });
                let rise = self.highest(level, node) - own;
                let distance = gap[0] * gap[0] + gap[1] * gap[1];
                let reach = narrowest * rise * self.rounding;
                if rise > 0.0 && distance < reach * reach {
                    let suffices = distance.sqrt() / rise;
                    if level == 0 {
                        let corners = self.corners(node);
                        let offset = [node[0] - cell[0], node[1] - cell[1]];
                        if is_rim || !rises(corners, offset) {
                            narrowest = narrowest.min(leaf_radius(corners, offset, own).max(suffices));
                        }
                    } else if distance >= OPENING * OPENING * (1_u32 << (2 * level)) as f32 {
                        narrowest = suffices;
                    } else {
                        open = true;
                    }
                }
            }
            if open {
                level -= 1;
                orders &= !(3 << (2 * level));
                node = nearest_child(node, cell, level);
                continue;
            }
            let last_children = (!orders.wrapping_shr(2 * level)).trailing_zeros() >> 1;
            node = node.map(|at| at >> last_children);
            level += last_children;
            if level >= top {
                return narrowest;
            }
            let order = ((orders >> (2 * level)) & 3) + 1;
            orders = (orders & !(3 << (2 * level))) | (order << (2 * level));
            let first = nearest_child(node.map(|at| at >> 1), cell, level);
            node = [first[0] ^ (order & 1) as i32, first[1] ^ (order >> 1) as i32];
        }
    }
}

fn nearest_child(parent: [i32; 2], cell: [i32; 2], level: u32) -> [i32; 2] {
    [0, 1].map(|i| 2 * parent[i] + i32::from(cell[i] >= (2 * parent[i] + 1) << level))
}

fn leaf_radius(corners: [f32; 4], offset: [i32; 2], own: f32) -> f32 {
    let away = offset.map(|at| at.abs() as f32);
    let center = away.map(|away| (away - 0.5).max(0.0));
    let length = (center[0] * center[0] + center[1] * center[1]).sqrt().max(0.5);
    // Distances of the leaf's lower and upper edge along axis `i`, projected onto the line to the leaf's center.
    let edges = |i: usize| {
        let direction = center[i] / length;
        let (near, far) = ((away[i] - 1.0).max(0.0) * direction, away[i] * direction);
        if offset[i] < 0 { [far, near] } else { [near, far] }
    };
    let (x, y) = (edges(0), edges(1));
    let distances = [x[0] + y[0], x[1] + y[0], x[0] + y[1], x[1] + y[1]];
    let radii = corners.into_iter().zip(distances).filter(|(height, _)| height - own > 0.0);
    radii.map(|(height, distance)| distance / (height - own).max(LEAST_RISE)).fold(WIDEST, f32::min)
}

fn rises([h00, h10, h01, h11]: [f32; 4], offset: [i32; 2]) -> bool {
    let least = |slopes: [f32; 2], offset: i32| {
        let [low, high] = [(offset - 1) as f32, (offset + 1) as f32];
        slopes.map(|slope| (slope * low).min(slope * high)).into_iter().fold(f32::INFINITY, f32::min)
    };
    least([h10 - h00, h11 - h01], offset[0]) + least([h01 - h00, h11 - h10], offset[1]) >= 0.0
}

#[cfg(test)]
mod tests {
    use super::Search;
    use crate::samples::BuiltInMap;
    use crate::surface::cone_map::RADIUS_BOUND;
    use crate::surface::height_pyramid::PyramidLayout;
    use crate::surface::height_pyramid::reference::height_pyramid;
    use crate::surface::{Address, HeightMap};

    /// A node whose cone is as wide as the narrowest so far counts or not, as a device rounds.
    #[test]
    fn a_rounding_that_decides_about_a_node_does_not_decide_about_a_cone() {
        let noise =
            (0..64_u32 * 64).map(|at| (at.wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 24) as f32);
        let noise = HeightMap::new(64, 64, noise.collect()).expect("valid");
        for map in [BuiltInMap::Cobbles.height_map(64).expect("valid"), noise] {
            for address in [Address::Wrap, Address::Clamp] {
                let pyramid = height_pyramid(&map, address);
                let cones = |rounding: f32| {
                    let layout = PyramidLayout::new([map.width(), map.height()], address);
                    Search { map: &map, pyramid: &pyramid, layout, address, rounding }.cones()
                };
                let exact = cones(1.0);
                for rounding in [1.0 - 4e-7, 1.0 + 4e-7] {
                    for ([_, radius], [_, exact]) in cones(rounding).into_iter().zip(&exact) {
                        assert!(
                            (radius - exact).abs() <= exact * RADIUS_BOUND,
                            "{radius} instead of {exact}"
                        );
                    }
                }
            }
        }
    }
}
