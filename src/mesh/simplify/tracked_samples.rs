//! Measured distances between the mesh and its simplification, in both directions, sampled at the mesh's points
//! and at the midpoints of edges and triangles.

use glam::Vec3;

use super::points::Points;
use super::topology::Topology;
use crate::mesh::nearest::nearest_on_triangle;

/// Samples of the mesh, each assigned to a remaining triangle that is within the limit of it in every pose.
pub(crate) struct TrackedSamples {
    /// For each triangle, the samples assigned to it: numbers of removed points, and beyond those, numbers of
    /// midpoints.
    samples: Vec<Vec<u32>>,
    middles: Middles,
    /// The square of the largest distance allowed, in the unit of points' positions.
    most: f32,
    /// The collapse that was tested last, if it keeps within the limit.
    looked_at: Option<[u32; 2]>,
    /// For that collapse: samples, with their new triangles.
    found: Vec<(u32, u32)>,
    /// For that collapse: the triangles that would exist afterwards, the changed ones first, with their
    /// corners.
    triangles: Vec<(u32, [u32; 3])>,
    /// For that collapse: the number of triangles that it changes.
    changed: usize,
    /// For that collapse: the triangles of the mesh that the changed ones may lie on.
    below: Vec<[u32; 3]>,
}

/// The midpoints of the mesh's edges and triangles.
struct Middles {
    /// Positions, one midpoint after the other, each in all poses.
    positions: Vec<Vec3>,
    /// For each midpoint, a triangle of the mesh on which it lies, by its points.
    triangles: Vec<[u32; 3]>,
    /// For each midpoint, the rigid body of that triangle, or [`NO_BODY`](super::points::NO_BODY).
    bodies: Vec<u32>,
}

impl TrackedSamples {
    pub(crate) fn new(topology: &Topology, points: &Points, triangles: usize) -> Self {
        let mut samples = vec![Vec::new(); triangles];
        let mut middles = Middles { positions: Vec::new(), triangles: Vec::new(), bodies: Vec::new() };
        for point in 0..points.len() as u32 {
            for ring in topology.one_ring(point) {
                let corners = [point, ring.next.point, ring.last.point];
                // The edge's other triangle has it in the opposite direction, unless the edge is on a border.
                let is_border = || !topology.one_ring(point).any(|other| other.last.point == corners[1]);
                let is_first = corners.iter().all(|other| point <= *other);
                let edge = (point < corners[1] || is_border()).then_some(&corners[..2]);
                for ends in edge.into_iter().chain(is_first.then_some(&corners[..])) {
                    samples[ring.triangle as usize].push((points.len() + middles.triangles.len()) as u32);
                    middles.positions.extend((0..points.poses()).map(|pose| middle(points, ends, pose)));
                    middles.triangles.push(corners);
                    middles.bodies.push(points.common_body(&corners));
                }
            }
        }
        let (found, triangles, below) = (Vec::new(), Vec::new(), Vec::new());
        Self { samples, middles, most: 0.0, looked_at: None, found, triangles, changed: 0, below }
    }

    /// Sets the largest distance that is allowed from now on, in the unit of points' positions.
    pub(crate) fn set_most(&mut self, distance: f32) {
        self.most = distance * distance;
    }

    /// Tests the collapse of a point into its neighbour. It passes if the point and all samples on the
    /// triangles that change find a triangle within the limit among those that the two points have afterwards,
    /// and if the midpoints of the changed triangles and of their edges lie within the limit of the mesh.
    pub(crate) fn keeps_near(
        &mut self,
        topology: &Topology,
        points: &Points,
        point: u32,
        neighbor: u32,
    ) -> bool {
        self.looked_at = None;
        self.triangles.clear();
        self.found.clear();
        self.below.clear();
        for (around, other) in [(point, neighbor), (neighbor, point)] {
            self.changed = self.triangles.len();
            for ring in topology.one_ring(around) {
                let ends = [ring.next.point, ring.last.point];
                if !ends.contains(&other) {
                    self.triangles.push((ring.triangle, [neighbor, ends[0], ends[1]]));
                }
                let middles = self.samples[ring.triangle as usize]
                    .iter()
                    .filter_map(|sample| (*sample as usize).checked_sub(points.len()));
                for middle in middles {
                    let below = self.middles.triangles[middle];
                    // The midpoints of a triangle and of its edges mostly follow each other.
                    if self.below.last() != Some(&below) {
                        self.below.push(below);
                    }
                }
            }
        }
        let samples = topology.around(point).iter().flat_map(|triangle| &self.samples[*triangle as usize]);
        for sample in std::iter::once(&point).chain(samples) {
            let Some(triangle) = self.nearest(points, *sample) else { return false };
            self.found.push((*sample, triangle));
        }
        let is_near = self.triangles[..self.changed].iter().all(|(_, [to, next, last])| {
            let sides: [&[u32]; 3] = [&[*to, *next], &[*last, *to], &[*to, *next, *last]];
            sides.iter().all(|side| self.is_near(points, side))
        });
        self.looked_at = is_near.then_some([point, neighbor]);
        is_near
    }

    /// Whether the midpoint of some points is within the limit of a triangle of the mesh, the same one in all
    /// poses.
    fn is_near(&self, points: &Points, ends: &[u32]) -> bool {
        let is_near = |triangle: &[u32; 3], pose: usize| {
            let wanted = middle(points, ends, pose);
            let corners = triangle.map(|corner| points.position(corner, pose).as_vec3());
            nearest_on_triangle(wanted, corners).distance_squared(wanted) <= self.most
        };
        let body = points.common_body(ends);
        self.below.iter().any(|triangle| {
            let poses = points.poses_between(body, points.common_body(triangle));
            (0..poses).all(|pose| is_near(triangle, pose))
        })
    }

    /// The triangle whose largest distance from the sample in any pose is smallest, if that is within the
    /// limit.
    fn nearest(&self, points: &Points, sample: u32) -> Option<u32> {
        let position = |point: u32, pose: usize| -> Vec3 { points.position(point, pose).as_vec3() };
        let mut best = None;
        let mut least = self.most.next_up();
        let body = match (sample as usize).checked_sub(points.len()) {
            None => points.body(sample),
            Some(at) => self.middles.bodies[at],
        };
        for (triangle, corners) in &self.triangles {
            let mut most = 0.0_f32;
            for pose in 0..points.poses_between(body, points.common_body(corners)) {
                let wanted = match (sample as usize).checked_sub(points.len()) {
                    None => position(sample, pose),
                    Some(at) => self.middles.positions[at * points.poses() + pose],
                };
                let found = nearest_on_triangle(wanted, corners.map(|corner| position(corner, pose)));
                most = most.max(found.distance_squared(wanted));
                if most >= least {
                    break;
                }
            }
            if most < least {
                (best, least) = (Some(*triangle), most);
            }
        }
        best
    }

    /// Records a collapse that keeps within the limit. Call it before the collapse happens.
    pub(crate) fn collapse(&mut self, topology: &Topology, points: &Points, point: u32, neighbor: u32) {
        // Other collapses may have been tested in between.
        if self.looked_at.take() != Some([point, neighbor]) {
            self.keeps_near(topology, points, point, neighbor);
        }
        for triangle in topology.around(point) {
            self.samples[*triangle as usize].clear();
        }
        for (sample, triangle) in self.found.drain(..) {
            self.samples[triangle as usize].push(sample);
        }
    }
}

fn middle(points: &Points, ends: &[u32], pose: usize) -> Vec3 {
    let sum: Vec3 = ends.iter().map(|end| points.position(*end, pose).as_vec3()).sum();
    sum / ends.len() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::simplify::{Options, Simplified, Stopped, Surface, simplify, simplify_within};

    const SIDE: u32 = 18;

    /// A bumpy sheet in two poses: flat, and bent.
    fn sheet() -> (Vec<Vec<[f32; 3]>>, Vec<u32>) {
        let bump =
            |x: u32, y: u32| 0.02 * libm::sinf(0.9 * x as f32) + 0.03 * libm::cosf(0.55 * (x + 2 * y) as f32);
        let flat = |x: u32, y: u32| [x as f32 / 17.0, y as f32 / 17.0, bump(x, y)];
        let bent = |x: u32, y: u32| {
            let [turn, height] = [2.0 * x as f32 / 17.0, 0.5 + bump(x, y)];
            [height * libm::sinf(turn), y as f32 / 17.0, height * libm::cosf(turn)]
        };
        let all = || (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
        let poses = vec![all().map(|(x, y)| flat(x, y)).collect(), all().map(|(x, y)| bent(x, y)).collect()];
        let corner = |x, y| y * SIDE + x;
        let quad = |(x, y): (u32, u32)| {
            let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            [a, b, c, a, c, d]
        };
        (poses, all().filter(|(x, y)| x.max(y) < &(SIDE - 1)).flat_map(quad).collect())
    }

    /// Corners, and midpoints of edges and triangles.
    fn positions(pose: &[[f32; 3]], indices: &[u32]) -> Vec<Vec3> {
        let of = |triangle: &[u32]| {
            let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from(pose[triangle[corner] as usize]));
            [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0]
        };
        indices.chunks_exact(3).flat_map(of).collect()
    }

    /// The largest distance between samples of one surface and the other, in both directions and in all poses.
    fn off(poses: &[Vec<[f32; 3]>], mesh: &[u32], level: &[u32]) -> f32 {
        let one_way = |pose: &Vec<[f32; 3]>, from: &[u32], to: &[u32]| {
            let distance = |position: Vec3| {
                let on = |triangle: &[u32]| {
                    let corners = [0, 1, 2].map(|corner| Vec3::from(pose[triangle[corner] as usize]));
                    nearest_on_triangle(position, corners).distance(position)
                };
                to.chunks_exact(3).map(on).fold(f32::INFINITY, f32::min)
            };
            positions(pose, from).into_iter().map(distance).fold(0.0, f32::max)
        };
        let ways = poses.iter().flat_map(|pose| [one_way(pose, mesh, level), one_way(pose, level, mesh)]);
        ways.fold(0.0, f32::max)
    }

    #[test]
    fn distances_are_kept_both_ways_in_every_pose() {
        let (poses, indices) = sheet();
        let surface = Surface { poses: &poses, indices: &indices, attributes: &[], stride: 0 };
        let distances = [0.0, 0.008, 0.02, 0.05];
        let found = simplify_within(&surface, &Options::default(), &distances).expect("valid");
        assert_eq!(found.stopped(), Stopped::Exhausted);
        let level = |found: &Simplified, count| found.triangles(&indices, count);
        let mut last = indices.len();
        for distance in distances {
            let triangles = level(&found, found.collapses_near(distance));
            let worst = off(&poses, &indices, &triangles);
            assert!(worst <= distance * 1.001 + 1e-6, "{worst} of {distance}");
            assert!(
                distance == 0.0 || (triangles.len() < last && worst > 0.5 * distance),
                "{worst} of {distance}"
            );
            last = triangles.len();
        }
        assert!(6 * last < indices.len(), "{last} indices left");
        // Quadrics alone leave more triangles when they first reach this distance.
        let plain = simplify(&surface, &Options::default()).expect("valid");
        assert!(plain.collapses().iter().all(|collapse| collapse.distance == f32::INFINITY));
        let within = |count| off(&poses, &indices, &level(&plain, count)) <= 0.02;
        let far =
            (0..plain.collapses().len()).step_by(5).find(|count| !within(*count)).expect("far off at last");
        let near = level(&found, found.collapses_near(0.02)).len();
        assert!(5 * level(&plain, far).len() > 6 * near, "{} and {near}", level(&plain, far).len());
    }

    #[test]
    fn distances_are_checked() {
        let (poses, indices) = sheet();
        let surface = Surface { poses: &poses, indices: &indices, attributes: &[], stride: 0 };
        let refused = |distances: &[f32]| {
            simplify_within(&surface, &Options::default(), distances).expect_err("refused").path
        };
        assert_eq!(refused(&[-1.0]), "distances[0]");
        assert_eq!(refused(&[0.5, 0.25]), "distances[1]");
        assert_eq!(refused(&[0.5, f32::NAN]), "distances[1]");
        let none = simplify_within(&surface, &Options::default(), &[]).expect("valid");
        assert_eq!((none.collapses().len(), none.stopped()), (0, Stopped::Exhausted));
    }
}
