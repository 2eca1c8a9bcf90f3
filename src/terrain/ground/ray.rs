//! Ray queries against the triangles of the ground.

use glam::DVec3;

use super::Ground;
use crate::mesh::ray::distance_to;

/// Hit of a ray on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundHit {
    /// Distance along the ray, in lengths of the ray's direction vector.
    pub distance: f64,
    /// Upward normal of the hit triangle; not normalized.
    pub normal: DVec3,
}

impl Ground {
    /// First hit of a ray on a patch; `None` if there is no hit or no such patch. The ray is a start `at` and a `direction`.
    /// Positions are in world units from the patch's first sample: x east, y up, z south. `limit` is the largest distance, in
    /// lengths of `direction`.
    ///
    /// The query tests the drawn triangles, from both sides. It follows the ray from cell to cell and tests each cell below or
    /// above the ray once.
    pub fn hit(&self, patch: [i32; 2], [at, direction]: [DVec3; 2], limit: f64) -> Option<GroundHit> {
        let field = self.patches.get(&patch)?;
        let cells = self.size as usize - 1;
        let edge = self.spacing * cells as f64;
        let corners = [(0.0, f64::NEG_INFINITY), (edge, f64::INFINITY)].map(|(at, y)| DVec3::new(at, y, at));
        let [mut from, to] = within(corners, at, direction, limit)?;
        let mut walk = Walk::new([at, direction], from, self.spacing, cells);
        while from <= to {
            let [column, row] = walk.cell;
            let corner = |dx: usize, dz: usize| {
                let [x, z] = [column + dx, row + dz];
                let height = field.point(x, z).unwrap_or(0.0);
                DVec3::new(x as f64 * self.spacing, height, z as f64 * self.spacing) - at
            };
            // The diagonal of a cell runs from its north-eastern corner to its south-western corner.
            let [first, east, south, last] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
            let hits = [[first, south, east], [east, south, last]].into_iter().filter_map(|[a, b, c]| {
                let distance = distance_to([a, b, c], direction)?;
                (distance <= limit).then(|| GroundHit { distance, normal: (b - a).cross(c - a) })
            });
            let nearest = hits.reduce(|one, other| if other.distance < one.distance { other } else { one });
            if nearest.is_some() {
                return nearest;
            }
            from = walk.step()?;
        }
        None
    }
}

/// Distances from 0 to `limit` at which a ray enters and leaves a box, which may be infinite; `None` if it misses the box.
pub(crate) fn within([low, high]: [DVec3; 2], at: DVec3, direction: DVec3, limit: f64) -> Option<[f64; 2]> {
    let [mut from, mut to] = [0.0, limit];
    for axis in 0..3 {
        let [enter, leave] = slab([low[axis], high[axis]], at[axis], direction[axis])?;
        (from, to) = (f64::max(from, enter), f64::min(to, leave));
    }
    (from <= to).then_some([from, to])
}

/// Distances at which a ray enters and leaves a slab between two planes across an axis; `None` if the ray is parallel to the slab and
/// outside it.
pub(crate) fn slab([low, high]: [f64; 2], at: f64, direction: f64) -> Option<[f64; 2]> {
    if direction == 0.0 {
        return (low..=high).contains(&at).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let [a, b] = [(low - at) / direction, (high - at) / direction];
    Some([a.min(b), a.max(b)])
}

/// Traversal of the grid cells that lie below or above a ray.
struct Walk {
    cell: [usize; 2],
    /// Number of cells along each axis.
    cells: usize,
    /// Per axis: distance along the ray to the border of the next cell. `step` is the distance between two such borders.
    next: [f64; 2],
    step: [f64; 2],
    forward: [bool; 2],
}

impl Walk {
    fn new([at, direction]: [DVec3; 2], from: f64, spacing: f64, cells: usize) -> Self {
        let start = at + from * direction;
        let axes = [(at.x, direction.x, start.x), (at.z, direction.z, start.z)];
        // The conversion to `usize` saturates, so that a huge start position gives the last cell.
        let cell = axes.map(|(_, _, start)| ((start / spacing).floor().max(0.0) as usize).min(cells - 1));
        let forward = axes.map(|(_, direction, _)| direction > 0.0);
        let next = std::array::from_fn(|axis| {
            let (at, direction, _) = axes[axis];
            let border = (cell[axis] + usize::from(forward[axis])) as f64 * spacing;
            if direction == 0.0 { f64::INFINITY } else { (border - at) / direction }
        });
        let step = axes.map(|(_, direction, _)| spacing / direction.abs());
        Self { cell, cells, next, step, forward }
    }

    /// Advances to the next cell. Returns the distance along the ray at which that cell begins; `None` at the patch's edge.
    fn step(&mut self) -> Option<f64> {
        let axis = usize::from(self.next[1] < self.next[0]);
        let begins = self.next[axis];
        if !begins.is_finite() {
            return None;
        }
        self.cell[axis] = match self.forward[axis] {
            true => Some(self.cell[axis] + 1).filter(|cell| *cell < self.cells)?,
            false => self.cell[axis].checked_sub(1)?,
        };
        self.next[axis] += self.step[axis];
        Some(begins)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::config::TerrainConfig;
    use crate::terrain::field::field;
    use crate::terrain::recipe::Recipe;

    /// Every ray hits the triangle that a search through all triangles finds. The hit's height equals the ground's height at the
    /// hit's position.
    #[test]
    fn rays_hit_the_triangles_that_are_drawn() {
        let config = TerrainConfig::new(33, 6.0, "rays").expect("valid");
        let heights = field(&Recipe::new(config.clone()), &[[1, -2]], 0).expect("generated");
        let mut ground = Ground::new(&config).expect("valid");
        ground.insert([1, -2], &heights[0], 0).expect("whole");
        let edge = config.edge_length();
        let mut seed = 3_u32;
        let mut draw = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        let mut hits = 0;
        for _ in 0..1_600 {
            let at =
                DVec3::new(edge * (2.0 * draw() - 0.5), 40.0 * draw() - 10.0, edge * (2.0 * draw() - 0.5));
            let direction = DVec3::new(draw() - 0.5, 0.6 * (draw() - 0.7), draw() - 0.5);
            let found = ground.hit([1, -2], [at, direction], f64::INFINITY);
            let expected = nearest(&ground, [at, direction]);
            assert_eq!(found.map(|hit| hit.distance), expected, "{at} {direction}");
            let Some(GroundHit { distance, normal }) = found else { continue };
            hits += 1;
            let place = at + distance * direction;
            let there = ground.point_from([1, -2], place.x, place.z).expect("inside");
            assert!((there.height - place.y).abs() < 1e-6 * edge, "{} {}", there.height, place.y);
            assert!(
                normal.normalize().distance(DVec3::from(there.normal)) < 1e-9
                    || distance < 1e-3
                    || is_on_edge(&config, place)
            );
            assert_eq!(ground.hit([1, -2], [at, direction], 0.99 * distance), None);
        }
        assert!(hits > 100, "{hits}");
        assert_eq!(ground.hit([0, 0], [DVec3::Y * 90.0, DVec3::NEG_Y], 1e9), None);
        let down = ground.hit([1, -2], [DVec3::new(3.0, 900.0, 4.0), DVec3::NEG_Y], 1e9).expect("below");
        assert!(
            (900.0 - down.distance - ground.point_from([1, -2], 3.0, 4.0).expect("inside").height).abs()
                < 1e-9
        );
    }

    /// Whether a place is so close to a triangle's edge that rounding decides which triangle answers.
    fn is_on_edge(config: &TerrainConfig, place: DVec3) -> bool {
        let [u, v] = [place.x, place.z].map(|at| (at / config.terrain_scale).rem_euclid(1.0));
        [u, v, u + v - 1.0].iter().any(|distance| distance.abs() < 1e-6 || distance.abs() > 1.0 - 1e-6)
    }

    /// Distance of the first hit of a ray, found by a search through all triangles of the patch.
    fn nearest(ground: &Ground, [at, direction]: [DVec3; 2]) -> Option<f64> {
        let field = &ground.patches[&[1, -2]];
        let cells = ground.size as usize - 1;
        let mut found: Option<f64> = None;
        for index in 0..cells * cells {
            let corner = |dx: usize, dz: usize| {
                let [x, z] = [index % cells + dx, index / cells + dz];
                let height = field.point(x, z).expect("inside");
                DVec3::new(x as f64 * ground.spacing, height, z as f64 * ground.spacing) - at
            };
            let quad = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
            for triangle in [[quad[0], quad[1], quad[2]], [quad[2], quad[1], quad[3]]] {
                let distance = distance_to(triangle, direction);
                found = found.into_iter().chain(distance).reduce(f64::min);
            }
        }
        found
    }
}
