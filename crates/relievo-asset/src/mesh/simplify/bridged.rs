//! Distance of the new edges of a collapse from the surface before the collapse.

use glam::DVec3;

use crate::mesh::nearest::precise_nearest_on_triangle;

use super::points::Points;
use super::topology::Topology;

/// Largest number of triangles around a point for which new edges are measured. The time grows with the square of this
/// number.
const MOST: usize = 16;

/// Largest squared distance, in any pose, between the middle of a new edge and the point's triangles before the
/// collapse; at least `least`. This finds edges that bridge a recess, even if the point stays near the planes of its
/// triangles. Two cases are skipped: points with more than [`MOST`] triangles, and new edges on borders.
pub(crate) fn bridged(topology: &Topology, points: &Points, [point, neighbor]: [u32; 2], least: f64) -> f64 {
    let mut worst = least;
    let ring = topology.ring(point);
    if ring.len() > MOST {
        return worst;
    }
    let mut ends = [[DVec3::ZERO; 2]; MOST];
    for pose in 0..topology.poses_around(points, [point, neighbor]) {
        let (from, to) = (points.position(point, pose), points.position(neighbor, pose));
        for (ends, others) in ends.iter_mut().zip(ring) {
            *ends = others.map(|other| points.position(other, pose));
        }
        let ends = &ends[..ring.len()];
        for (&[end, last], [place, _]) in ring.iter().zip(ends) {
            let is_old = end == neighbor || last == neighbor || ring.contains(&[neighbor, end]);
            if is_old {
                continue;
            }
            let middle = (to + *place) * 0.5;
            let mut square = f64::INFINITY;
            for &[next, last] in ends {
                let nearest = precise_nearest_on_triangle(middle, [from, next, last]);
                square = square.min(nearest.distance_squared(middle));
                if square <= worst {
                    break;
                }
            }
            worst = worst.max(square);
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::super::turned::deviation;
    use super::*;

    /// The test mesh has four triangles around a point at the bottom of a valley. The valley's two ends lie `depth`
    /// lower.
    #[test]
    fn edges_across_a_valley_are_off_by_their_middle() {
        let valley = |depth: f32| {
            vec![[0.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [0.0, -1.0, -depth], [1.0, 0.0, 1.0], [0.0, 1.0, -depth]]
        };
        let indices = [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1];
        let off = |poses: &[Vec<[f32; 3]>], neighbor: u32, least: f64| {
            let points = Points::new(poses);
            let (topology, scale) = (Topology::new(&points, &indices, &[], false), points.scale());
            let both = [0, neighbor];
            let square = bridged(&topology, &points, both, (least * scale).powi(2));
            let planes = deviation(&topology, &points, both, &mut 0).map(|square| square.sqrt() / scale);
            (square.sqrt() / scale, planes)
        };
        let is = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
        // The walls rise by 45°, and the middle of the new edge is 1 above the bottom.
        let (across, planes) = off(&[valley(1.0)], 1, 0.0);
        is(across, 0.5_f64.sqrt());
        assert!(planes.is_some_and(|off| off < 0.45), "{planes:?}");
        // Along the bottom, the new edges bridge no recess.
        is(off(&[valley(0.0)], 2, 0.0).0, 0.0);
        is(off(&[valley(0.0)], 2, 0.25).0, 0.25);
        // With several poses, the largest distance counts.
        let flat = valley(0.0).into_iter().map(|[x, y, _]| [x, y, 0.0]).collect();
        is(off(&[flat, valley(0.0)], 1, 0.0).0, 0.5_f64.sqrt());
    }
}
