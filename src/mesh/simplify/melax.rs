//! The cost by Melax (B equation 3.1).

use glam::DVec3;

use super::points::Points;
use super::topology::{Spoke, Topology};
use super::turned::normal;

/// Squared, so that it is ordered and rooted as quadrics are; the largest over the poses. None where it is not below
/// `most`.
pub fn cost(topology: &Topology, points: &Points, [point, neighbor]: [u32; 2], most: f64) -> Option<f64> {
    let mut worst = 0.0_f64;
    for pose in 0..points.poses() {
        let unit = |spoke: &Spoke| unit_normal(topology, points, spoke.triangle, pose);
        let is_at_edge = |spoke: &Spoke| [spoke.next.point, spoke.last.point].contains(&neighbor);
        let mut at_edge = [DVec3::ZERO; 2];
        let all = topology.spokes(point).filter(is_at_edge);
        let count = at_edge.iter_mut().zip(all).map(|(normal, spoke)| *normal = unit(&spoke)).count();
        let mut curvature = 0.0_f64;
        for normal in topology.spokes(point).map(|spoke| unit(&spoke)) {
            let nearest = at_edge[..count].iter().map(|edge| (1.0 - normal.dot(*edge)) * 0.5);
            curvature = curvature.max(nearest.fold(1.0, f64::min));
        }
        let d = points.place(neighbor, pose) - points.place(point, pose);
        worst = worst.max(d.length_squared() * curvature * curvature);
        if worst >= most {
            return None;
        }
    }
    Some(worst)
}

/// Whether the normals of two points, sums of those of their triangles, are more than 90° apart in the first pose.
pub fn differ(topology: &Topology, points: &Points, both: [u32; 2]) -> bool {
    let sum = |point| -> DVec3 {
        topology.spokes(point).map(|spoke| unit_normal(topology, points, spoke.triangle, 0)).sum()
    };
    let [a, b] = both.map(sum);
    a.dot(b) < 0.0
}

/// 0 without an area.
fn unit_normal(topology: &Topology, points: &Points, triangle: u32, pose: usize) -> DVec3 {
    let places = topology.corners(triangle).map(|corner| points.place(corner.point, pose));
    normal(places).map_or(DVec3::ZERO, |normal| normal / normal.length())
}
