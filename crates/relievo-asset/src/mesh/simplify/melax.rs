//! The cost function of Melax (B equation 3.1).

use glam::DVec3;

use super::points::Points;
use super::topology::Topology;
use super::turned::normal;

/// Square of the cost of a collapse, the largest over all poses. Quadric costs are also squares, so both kinds can be
/// sorted and converted alike.
pub(crate) fn cost(topology: &Topology, points: &Points, [point, neighbor]: [u32; 2]) -> f64 {
    let mut worst = 0.0_f64;
    for pose in 0..points.poses() {
        let unit = |[next, last]: &[u32; 2]| unit_normal(points, [point, *next, *last], pose);
        let is_at_edge = |others: &&[u32; 2]| others.contains(&neighbor);
        let mut at_edge = [DVec3::ZERO; 2];
        let all = topology.ring(point).iter().filter(is_at_edge);
        let count = at_edge.iter_mut().zip(all).map(|(normal, ring)| *normal = unit(ring)).count();
        let mut curvature = 0.0_f64;
        for normal in topology.ring(point).iter().map(unit) {
            let nearest = at_edge[..count].iter().map(|edge| (1.0 - normal.dot(*edge)) * 0.5);
            curvature = curvature.max(nearest.fold(1.0, f64::min));
        }
        let d = points.position(neighbor, pose) - points.position(point, pose);
        worst = worst.max(d.length_squared() * curvature * curvature);
    }
    worst
}

/// Whether the normals of two points are more than 90° apart in the first pose. A point's normal is the sum of the unit
/// normals of its triangles.
pub(crate) fn differ(topology: &Topology, points: &Points, both: [u32; 2]) -> bool {
    let sum = |point| -> DVec3 {
        let ring = topology.ring(point).iter();
        ring.map(|[next, last]| unit_normal(points, [point, *next, *last], 0)).sum()
    };
    let [a, b] = both.map(sum);
    a.dot(b) < 0.0
}

/// Unit normal of a triangle in a pose; 0 for a triangle without area.
fn unit_normal(points: &Points, corners: [u32; 3], pose: usize) -> DVec3 {
    normal(corners.map(|corner| points.position(corner, pose)))
        .map_or(DVec3::ZERO, |normal| normal / normal.length())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(positions: &[[f32; 3]], indices: &[u32]) -> (Points, Topology) {
        let points = Points::new(&[positions.to_vec()]);
        let topology = Topology::new(&points, indices, &[], false);
        (points, topology)
    }

    /// A floor of four squares meets a wall of four. Moving a point along the edge between them costs nothing. Moving
    /// it away from the edge costs half of the distance moved, because the triangles on the other side are turned by
    /// 90°.
    #[test]
    fn edges_are_kept() {
        let mut positions = Vec::new();
        for along in 0..3 {
            let at = |row: i32| [along as f32, row.max(0) as f32 * 3.0, row.min(0) as f32 * -2.0];
            positions.extend((-2..=2).map(at));
        }
        let mut indices = Vec::new();
        for along in 0..2 {
            for row in 0..4 {
                let at = along * 5 + row;
                indices.extend([at, at + 6, at + 5, at, at + 1, at + 6]);
            }
        }
        let (points, topology) = of(&positions, &indices);
        let cost = |from, to| cost(&topology, &points, [from, to]).sqrt() / points.scale();
        assert_eq!(cost(7, 2), 0.0);
        assert_eq!(cost(7, 12), 0.0);
        assert_eq!(cost(7, 6), 1.0);
        assert_eq!(cost(7, 8), 1.5);
        assert_eq!(cost(6, 7), 0.0);
        assert!(!differ(&topology, &points, [6, 8]));
    }

    #[test]
    fn a_tetrahedrons_corners_face_away_from_each_other() {
        let positions = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let (points, topology) = of(&positions, &[0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2]);
        assert!(differ(&topology, &points, [0, 3]));
    }
}
