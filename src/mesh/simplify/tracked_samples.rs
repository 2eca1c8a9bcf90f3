//! Measured distances between the mesh and its simplification, in both directions, sampled at the mesh's points
//! and at the midpoints of edges and triangles.

use glam::Vec3;

use super::points::Points;
use super::topology::Topology;
use crate::mesh::nearest::nearest_on_triangle;

/// Number of samples of a point that are tested first.
const WITNESSES: usize = 4;

/// No sample, or no triangle.
const NONE: u32 = u32::MAX;

/// Samples of the mesh, each assigned to a remaining triangle that is within the limit of it in every pose.
pub(crate) struct TrackedSamples {
    /// For each triangle, the samples assigned to it: numbers of removed points, and beyond those, numbers of
    /// midpoints.
    samples: Vec<Vec<u32>>,
    /// For each sample, the triangle to which it is assigned.
    homes: Vec<u32>,
    /// For each point, the samples that forbade its collapses last: most are tested again and again, and one sample is
    /// mostly enough.
    witnesses: Vec<[u32; WITNESSES]>,
    middles: Middles,
    /// The square of the largest distance allowed, in the unit of points' positions.
    most: f32,
    /// The collapse that was tested last, if it keeps within the limit.
    looked_at: Option<[u32; 2]>,
    /// For that collapse: the triangles that would exist afterwards, the changed ones first.
    faces: Vec<Face>,
    /// For that collapse: the number of triangles that it changes.
    changed: usize,
    /// For that collapse: midpoints on the triangles of the mesh that the changed ones may lie on.
    below: Vec<u32>,
}

/// The midpoints of the mesh's edges and triangles.
struct Middles {
    /// Positions, one midpoint after the other, each in all poses.
    positions: Vec<Vec3>,
    /// For each midpoint, a triangle of the mesh on which it lies.
    triangles: Vec<Face>,
}

/// A triangle, and what tells that it is far from a position.
#[derive(Clone, Copy)]
struct Face {
    number: u32,
    /// Its points.
    corners: [u32; 3],
    /// Its rigid body, or [`NO_BODY`](super::points::NO_BODY).
    body: u32,
    /// The middle of a sphere around it in the first pose, and the radius.
    middle: Vec3,
    radius: f32,
    /// Its unit normal in the first pose; 0 if it is nearly a line.
    normal: Vec3,
    /// How far rounding may move the distances from plane and sphere.
    rounding: f32,
}

impl Face {
    fn new(points: &Points, number: u32, corners: [u32; 3]) -> Self {
        /// The square of the sine of the angle below which a triangle's normal is not exact enough.
        const LEAST: f32 = 1e-4;
        let [a, b, c] = corners.map(|corner| points.position(corner, 0).as_vec3());
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let edges = ab.length_squared() * ac.length_squared();
        let is_exact = normal.length_squared() > LEAST * edges;
        let middle = (a + b + c) / 3.0;
        let radius =
            [a, b, c].map(|corner| corner.distance_squared(middle)).into_iter().fold(0.0, f32::max).sqrt();
        Self {
            number,
            corners,
            body: points.common_body(&corners),
            middle,
            radius,
            normal: if is_exact { normal.normalize_or_zero() } else { Vec3::ZERO },
            // Positions are within ±2 mostly; the normal is off by 2⁻²⁴ over the sine, for each unit of length.
            rounding: 1e-6 * (middle.abs().max_element() + 2.0) + 4e-5 * radius,
        }
    }

    /// Whether all of it is surely further than `limit` from a position in the first pose.
    #[inline]
    fn is_far(&self, position: Vec3, limit: f32) -> bool {
        let (from, limit) = (position - self.middle, limit + self.rounding);
        let reach = self.radius + limit;
        from.dot(self.normal).abs() > limit || from.length_squared() > reach * reach
    }

    /// The square of its largest distance from a sample in any pose; more than `most` if it is larger than that.
    fn off(&self, points: &Points, body: u32, wanted: impl Fn(usize) -> Vec3, most: f32) -> f32 {
        let mut largest = 0.0_f32;
        for pose in 0..points.poses_between(body, self.body) {
            let (wanted, corners) =
                (wanted(pose), self.corners.map(|corner| points.position(corner, pose).as_vec3()));
            largest = largest.max(nearest_on_triangle(wanted, corners).distance_squared(wanted));
            if largest > most {
                break;
            }
        }
        largest
    }
}

impl TrackedSamples {
    pub(crate) fn new(topology: &Topology, points: &Points, triangles: usize) -> Self {
        let mut samples = vec![Vec::new(); triangles];
        let mut homes = vec![NONE; points.len()];
        let mut middles = Middles { positions: Vec::new(), triangles: Vec::new() };
        for point in 0..points.len() as u32 {
            for ring in topology.one_ring(point) {
                let corners = [point, ring.next.point, ring.last.point];
                // The edge's other triangle has it in the opposite direction, unless the edge is on a border.
                let is_border = || !topology.one_ring(point).any(|other| other.last.point == corners[1]);
                let is_first = corners.iter().all(|other| point <= *other);
                let edge = (point < corners[1] || is_border()).then_some(&corners[..2]);
                for ends in edge.into_iter().chain(is_first.then_some(&corners[..])) {
                    samples[ring.triangle as usize].push(homes.len() as u32);
                    homes.push(ring.triangle);
                    middles.positions.extend((0..points.poses()).map(|pose| middle(points, ends, pose)));
                    middles.triangles.push(Face::new(points, ring.triangle, corners));
                }
            }
        }
        let (faces, below) = (Vec::new(), Vec::new());
        let witnesses = vec![[NONE; WITNESSES]; points.len()];
        Self { samples, homes, witnesses, middles, most: 0.0, looked_at: None, faces, changed: 0, below }
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
        self.list_faces(topology, points, point, neighbor);
        if !self.has_near(points, point) {
            return false;
        }
        let around = topology.around(point);
        for sample in self.witnesses[point as usize] {
            let home = self.homes.get(sample as usize).copied().unwrap_or(NONE);
            if around.contains(&home) && !self.has_near(points, sample) {
                return false;
            }
        }
        let samples = around.iter().flat_map(|triangle| &self.samples[*triangle as usize]);
        if let Some(&far) = samples.into_iter().find(|sample| !self.has_near(points, **sample)) {
            let witnesses = &mut self.witnesses[point as usize];
            witnesses.rotate_right(1);
            witnesses[0] = far;
            return false;
        }
        self.list_below(topology, points, [point, neighbor]);
        let is_near = self.faces[..self.changed].iter().all(|face| {
            let [to, next, last] = face.corners;
            let sides: [&[u32]; 3] = [&[to, next], &[last, to], &[to, next, last]];
            sides.iter().all(|side| self.is_near(points, side))
        });
        self.looked_at = is_near.then_some([point, neighbor]);
        is_near
    }

    /// Lists the triangles that would exist after a collapse.
    fn list_faces(&mut self, topology: &Topology, points: &Points, point: u32, neighbor: u32) {
        self.faces.clear();
        for (around, other) in [(point, neighbor), (neighbor, point)] {
            self.changed = self.faces.len();
            for ring in topology.one_ring(around) {
                let ends = [ring.next.point, ring.last.point];
                if !ends.contains(&other) {
                    self.faces.push(Face::new(points, ring.triangle, [neighbor, ends[0], ends[1]]));
                }
            }
        }
    }

    /// Lists the midpoints of the mesh that are assigned to triangles around two points.
    fn list_below(&mut self, topology: &Topology, points: &Points, both: [u32; 2]) {
        self.below.clear();
        let mut last = NONE;
        for triangle in both.iter().flat_map(|point| topology.around(*point)) {
            for sample in &self.samples[*triangle as usize] {
                let Some(middle) = (*sample as usize).checked_sub(points.len()) else { continue };
                // The midpoints of a triangle and of its edges mostly follow each other.
                let of = self.middles.triangles[middle].number;
                if of != last {
                    self.below.push(middle as u32);
                }
                last = of;
            }
        }
    }

    /// Whether the midpoint of some points is within the limit of a triangle of the mesh, the same one in all
    /// poses.
    fn is_near(&self, points: &Points, ends: &[u32]) -> bool {
        let (body, first, limit) = (points.common_body(ends), middle(points, ends, 0), self.most.sqrt());
        self.below.iter().any(|at| {
            let face = &self.middles.triangles[*at as usize];
            !face.is_far(first, limit)
                && face.off(points, body, |pose| middle(points, ends, pose), self.most) <= self.most
        })
    }

    /// The position of a sample in a pose.
    fn position(&self, points: &Points, sample: u32, pose: usize) -> Vec3 {
        match (sample as usize).checked_sub(points.len()) {
            None => points.position(sample, pose).as_vec3(),
            Some(at) => self.middles.positions[at * points.poses() + pose],
        }
    }

    /// The rigid body of a sample, or [`NO_BODY`](super::points::NO_BODY).
    fn body(&self, points: &Points, sample: u32) -> u32 {
        match (sample as usize).checked_sub(points.len()) {
            None => points.body(sample),
            Some(at) => self.middles.triangles[at].body,
        }
    }

    /// Whether one of the triangles is within the limit of a sample in all poses.
    fn has_near(&self, points: &Points, sample: u32) -> bool {
        let (first, limit) = (self.position(points, sample, 0), self.most.sqrt());
        let body = self.body(points, sample);
        self.faces.iter().any(|face| {
            !face.is_far(first, limit)
                && face.off(points, body, |pose| self.position(points, sample, pose), self.most) <= self.most
        })
    }

    /// The triangle whose largest distance from the sample in any pose is smallest, if that is within the
    /// limit.
    fn nearest(&self, points: &Points, sample: u32) -> Option<u32> {
        let (first, limit) = (self.position(points, sample, 0), self.most.sqrt());
        let body = self.body(points, sample);
        let mut best = None;
        let mut least = self.most.next_up();
        for face in self.faces.iter().filter(|face| !face.is_far(first, limit)) {
            let off = face.off(points, body, |pose| self.position(points, sample, pose), least);
            if off < least {
                (best, least) = (Some(face.number), off);
            }
        }
        best
    }

    /// Records a collapse that keeps within the limit. Call it before the collapse happens.
    pub(crate) fn collapse(&mut self, topology: &Topology, points: &Points, point: u32, neighbor: u32) {
        // Other collapses may have been tested in between.
        if self.looked_at.take() != Some([point, neighbor]) {
            self.list_faces(topology, points, point, neighbor);
        }
        let mut moved = vec![point];
        for triangle in topology.around(point) {
            moved.append(&mut self.samples[*triangle as usize]);
        }
        for sample in moved {
            if let Some(triangle) = self.nearest(points, sample) {
                self.samples[triangle as usize].push(sample);
                self.homes[sample as usize] = triangle;
            }
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

    /// What is called far is further than the limit, also from slivers and from afar.
    #[test]
    fn far_triangles_are_far() {
        let (mut far, mut all) = (0, 0);
        for at in 0..4000 {
            let wave = |turn: f32| libm::sinf(turn * at as f32);
            let size = [1.0, 0.1, 0.01][at % 3];
            let place = |one: f32| Vec3::new(wave(one), wave(1.3 * one), wave(1.9 * one));
            let first = place(1.1);
            let sliver = if at % 2 == 0 { size } else { 1e-4 * size };
            let corners =
                [first, first + size * place(2.3), first + size * place(2.3) * 0.5 + sliver * place(3.1)];
            let points = Points::new(&[corners.map(|corner| corner.to_array()).to_vec()]);
            if points.len() < 3 {
                continue;
            }
            let placed = [0, 1, 2].map(|point| points.position(point, 0).as_vec3());
            let face = Face::new(&points, 0, [0, 1, 2]);
            let position = placed[0] + 2.0 * size * place(4.7);
            let off = nearest_on_triangle(position, placed).distance(position);
            for limit in [0.2 * off, 0.9 * off, 0.999_999 * off, off, 1.1 * off] {
                let is_far = face.is_far(position, limit);
                assert!(!is_far || off > limit, "{corners:?} {position}: {off} {limit}");
                far += usize::from(is_far);
                all += 1;
            }
        }
        // Three limits of five are below the distance, and one of these by less than rounding.
        assert!(6 * far > all, "{far} of {all}");
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
