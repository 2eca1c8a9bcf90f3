//! Measures the distance between the mesh and its simplification, in both directions. Samples are the points of the
//! mesh, and the midpoints of its edges and triangles.

use glam::Vec3;

use super::points::Points;
use super::topology::Topology;
use crate::mesh::nearest::nearest_on_triangle;

/// Number of witnesses per point: samples that are tested before all others.
const WITNESSES: usize = 4;

/// Marks a missing sample or triangle.
const NONE: u32 = u32::MAX;

/// Used instead of a mesh index. For a sample: triangles of any mesh may represent it. For a triangle: all triangles
/// belong to one mesh.
const ANY: u32 = u32::MAX;

/// Samples of the mesh. Each sample is assigned to a remaining triangle, and is within the allowed distance of it in
/// every pose.
pub(crate) struct TrackedSamples {
    /// For each triangle, the samples assigned to it. An entry below the number of points is a removed point. Any other
    /// entry is a midpoint.
    samples: Vec<Vec<u32>>,
    /// For each sample, the triangle to which it is assigned.
    homes: Vec<u32>,
    /// For each point, its mesh in the original; [`ANY`] if several meshes or none had the point. A sample is assigned
    /// only to triangles of its own mesh.
    meshes_of_points: Vec<u32>,
    /// For each point, the samples that caused the latest refusals of its collapses. Most collapses are tested
    /// repeatedly, and one sample is usually enough to refuse a collapse.
    witnesses: Vec<[u32; WITNESSES]>,
    middles: Middles,
    /// Square of the largest allowed distance, in scaled units.
    most: f32,
    verdicts: Verdicts,
    /// The last tested collapse, if it stays within the allowed distance.
    looked_at: Option<[u32; 2]>,
    /// Triangles around both points after the last tested collapse, the changed triangles first.
    faces: Vec<Face>,
    /// Number of triangles that the last tested collapse changes.
    changed: usize,
    /// Triangles of the original mesh that may lie below the changed triangles. Each is given by one of its midpoints.
    below: Vec<u32>,
}

/// Cached results of tested collapses. A result is valid until a triangle around one of the two points changes, or
/// gains or loses a sample.
struct Verdicts {
    /// For each point, the results of its tested collapses.
    of: Vec<Vec<Verdict>>,
    /// For each point, the value of `collapses` when a triangle around it last changed.
    changed: Vec<u32>,
    /// Number of collapses made so far.
    collapses: u32,
}

#[derive(Clone, Copy)]
struct Verdict {
    neighbor: u32,
    /// Number of collapses made before the test.
    collapses: u32,
    /// Lower bound on the square of the distance limit at which the collapse would pass; 0 if it has passed.
    needed: f32,
}

impl Verdicts {
    fn new(points: usize) -> Self {
        Self { of: vec![Vec::new(); points], changed: vec![0; points], collapses: 0 }
    }

    /// Whether a collapse is known to pass or fail at the squared distance limit `most`. `None` if it must be tested.
    fn get(&self, [point, neighbor]: [u32; 2], most: f32) -> Option<bool> {
        let changed = self.changed[point as usize].max(self.changed[neighbor as usize]);
        let mut of = self.of[point as usize].iter();
        let known = of.find(|known| known.neighbor == neighbor && known.collapses >= changed)?;
        (known.needed == 0.0 || known.needed > most).then_some(known.needed == 0.0)
    }

    fn set(&mut self, [point, neighbor]: [u32; 2], needed: f32) {
        let changed = self.changed[point as usize];
        let of = &mut self.of[point as usize];
        of.retain(|known| known.collapses >= changed && known.neighbor != neighbor);
        of.push(Verdict { neighbor, collapses: self.collapses, needed });
    }

    /// Records a collapse before it is made.
    fn collapse(&mut self, topology: &Topology, both: [u32; 2]) {
        self.collapses += 1;
        for other in both.iter().flat_map(|point| topology.ring(*point)).flatten() {
            self.changed[*other as usize] = self.collapses;
        }
    }
}

/// Midpoints of the mesh's edges and triangles, which serve as samples.
struct Middles {
    /// Positions of the midpoints. All poses of midpoint 0 come first.
    positions: Vec<Vec3>,
    /// For each midpoint, a triangle of the original mesh that contains it.
    triangles: Vec<Face>,
}

/// A triangle given by three points.
#[derive(Clone, Copy)]
struct Corners {
    points: [u32; 3],
    /// Rigid body that all three corners belong to, or [`NO_BODY`](super::points::NO_BODY).
    body: u32,
    /// Positions of the three corners in the first pose.
    first: [Vec3; 3],
}

impl Corners {
    #[inline]
    fn new(points: &Points, corners: [u32; 3]) -> Self {
        let first = corners.map(|corner| points.position(corner, 0).as_vec3());
        Self { points: corners, body: points.common_body(&corners), first }
    }
}

/// Largest squared distance between a triangle and a sample over all poses. If it exceeds `most`, the result may be any
/// value above `most`.
#[inline]
fn off(points: &Points, corners: &Corners, sample: &Place<impl Fn(usize) -> Vec3>, most: f32) -> f32 {
    let mut largest = nearest_on_triangle(sample.first, corners.first).distance_squared(sample.first);
    for pose in 1..points.poses_between(sample.body, corners.body) {
        if largest > most {
            break;
        }
        let wanted = (sample.at)(pose);
        let corners = corners.points.map(|corner| points.position(corner, pose).as_vec3());
        largest = largest.max(nearest_on_triangle(wanted, corners).distance_squared(wanted));
    }
    largest
}

/// Squared distance from a sample to the nearest of those `faces` that may represent it. The distance to a face is the
/// largest over all poses.
fn nearest_off<'a>(
    points: &Points,
    sample: &Place<impl Fn(usize) -> Vec3>,
    faces: impl Iterator<Item = &'a Face>,
) -> f32 {
    let own = faces.filter(|face| sample.may_be_on(face.mesh));
    own.fold(f32::INFINITY, |least, face| least.min(off(points, &face.corners, sample, least)))
}

/// A triangle with bounds that quickly show whether it is far from a position.
#[derive(Clone, Copy)]
struct Face {
    number: u32,
    /// Mesh of the triangle, or [`ANY`].
    mesh: u32,
    corners: Corners,
    /// Center and radius of a bounding sphere in the first pose.
    middle: Vec3,
    radius: f32,
    /// Unit normal in the first pose; 0 if the triangle is so thin that the normal would be inexact.
    normal: Vec3,
    /// Bound on the rounding errors of distances to the plane and the sphere.
    rounding: f32,
}

impl Face {
    fn new(points: &Points, [number, mesh]: [u32; 2], corners: [u32; 3]) -> Self {
        /// Smallest squared sine of a triangle's angle at which the normal is exact enough.
        const LEAST: f32 = 1e-4;
        let corners = Corners::new(points, corners);
        let [a, b, c] = corners.first;
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let edges = ab.length_squared() * ac.length_squared();
        let is_exact = normal.length_squared() > LEAST * edges;
        let middle = (a + b + c) / 3.0;
        let radius =
            [a, b, c].map(|corner| corner.distance_squared(middle)).into_iter().fold(0.0, f32::max).sqrt();
        Self {
            number,
            mesh,
            corners,
            middle,
            radius,
            normal: if is_exact { normal.normalize_or_zero() } else { Vec3::ZERO },
            // The first term bounds the errors of positions, which are mostly within ±2. The second bounds the error of
            // the normal. Per unit of length, it is 2⁻²⁴ divided by the sine, which is at least 0.01.
            rounding: 1e-6 * (middle.abs().max_element() + 2.0) + 4e-5 * radius,
        }
    }

    /// Whether the whole triangle is certainly farther than `limit` from a position in the first pose.
    #[inline]
    fn is_far(&self, position: Vec3, limit: f32) -> bool {
        let (from, limit) = (position - self.middle, limit + self.rounding);
        let reach = self.radius + limit;
        from.dot(self.normal).abs() > limit || from.length_squared() > reach * reach
    }

    /// Whether the triangle is within `limit` of a sample in all poses. `most` is the square of `limit`.
    #[inline]
    fn is_near(
        &self,
        points: &Points,
        sample: &Place<impl Fn(usize) -> Vec3>,
        [limit, most]: [f32; 2],
    ) -> bool {
        sample.may_be_on(self.mesh)
            && !self.is_far(sample.first, limit)
            && off(points, &self.corners, sample, most) <= most
    }
}

/// Position of a sample in all poses.
struct Place<F> {
    /// Rigid body of the sample, or [`NO_BODY`](super::points::NO_BODY).
    body: u32,
    /// Mesh of the sample, or [`ANY`].
    mesh: u32,
    /// Position in the first pose.
    first: Vec3,
    /// Function that returns the position in a pose.
    at: F,
}

impl<F: Fn(usize) -> Vec3> Place<F> {
    fn new(body: u32, mesh: u32, at: F) -> Self {
        Self { body, mesh, first: at(0), at }
    }

    /// Whether triangles of `mesh` may represent the sample.
    #[inline]
    fn may_be_on(&self, mesh: u32) -> bool {
        self.mesh == ANY || self.mesh == mesh
    }
}

impl TrackedSamples {
    /// Takes the samples, and assigns each midpoint to a triangle that contains it. `triangles` is the number of
    /// triangles.
    pub(crate) fn new(topology: &Topology, points: &Points, triangles: usize) -> Self {
        let mut samples = vec![Vec::new(); triangles];
        let mut homes = vec![NONE; points.len()];
        let mut middles = Middles { positions: Vec::new(), triangles: Vec::new() };
        for point in 0..points.len() as u32 {
            for ring in topology.one_ring(point) {
                let corners = [point, ring.next.point, ring.last.point];
                // The edge's other triangle lists the edge in the opposite direction, unless the edge is on a border.
                let is_border = || !topology.one_ring(point).any(|other| other.last.point == corners[1]);
                let is_first = corners.iter().all(|other| point <= *other);
                let edge = (point < corners[1] || is_border()).then_some(&corners[..2]);
                for ends in edge.into_iter().chain(is_first.then_some(&corners[..])) {
                    samples[ring.triangle as usize].push(homes.len() as u32);
                    homes.push(ring.triangle);
                    middles.positions.extend((0..points.poses()).map(|pose| middle(points, ends, pose)));
                    let number = [ring.triangle, mesh_of(topology, ring.triangle)];
                    middles.triangles.push(Face::new(points, number, corners));
                }
            }
        }
        let mesh_of_point = |point: u32| {
            let mut all = topology.around(point).iter().map(|triangle| mesh_of(topology, *triangle));
            let first = all.next().unwrap_or(ANY);
            if all.all(|other| other == first) { first } else { ANY }
        };
        let meshes_of_points = (0..points.len() as u32).map(mesh_of_point).collect();
        let (faces, below) = (Vec::new(), Vec::new());
        let witnesses = vec![[NONE; WITNESSES]; points.len()];
        let verdicts = Verdicts::new(points.len());
        Self {
            samples,
            homes,
            meshes_of_points,
            witnesses,
            middles,
            most: 0.0,
            verdicts,
            looked_at: None,
            faces,
            changed: 0,
            below,
        }
    }

    /// Sets the largest allowed distance from now on, in scaled units.
    pub(crate) fn set_most(&mut self, distance: f32) {
        self.most = distance * distance;
    }

    /// Tests the collapse of a point into its neighbour. The collapse passes under two conditions. First, the point and
    /// each sample on the changed triangles must be within the limit of some triangle around the merged point. Second,
    /// the midpoints of the changed triangles and of their edges must be within the limit of the original mesh.
    pub(crate) fn keeps_near(
        &mut self,
        topology: &Topology,
        points: &Points,
        point: u32,
        neighbor: u32,
    ) -> bool {
        let both = [point, neighbor];
        if let Some(known) = self.verdicts.get(both, self.most) {
            return known;
        }
        let mut needed = self.needed_by_point(topology, points, both);
        if needed <= self.most {
            needed = self.needed_by_all(topology, points, both);
        }
        self.verdicts.set(both, needed);
        needed == 0.0
    }

    /// The remaining tests of [`Self::keeps_near`], after the collapsing point itself has passed. Returns a lower bound
    /// on the square of the distance limit at which the collapse would pass, or 0 if it passes now.
    fn needed_by_all(&mut self, topology: &Topology, points: &Points, both: [u32; 2]) -> f32 {
        let [point, neighbor] = both;
        self.looked_at = None;
        self.list_faces(topology, points, point, neighbor);
        let (around, mut near) = (topology.around(point), 0);
        for sample in self.witnesses[point as usize] {
            let home = self.homes.get(sample as usize).copied().unwrap_or(NONE);
            if around.contains(&home) && self.near(points, sample, near).is_none() {
                return self.needed(points, sample);
            }
        }
        let mut samples = around.iter().flat_map(|triangle| &self.samples[*triangle as usize]);
        let far = samples.find(|sample| match self.near(points, **sample, near) {
            None => true,
            Some(at) => {
                near = at;
                false
            }
        });
        if let Some(&far) = far {
            let witnesses = &mut self.witnesses[point as usize];
            witnesses.rotate_right(1);
            witnesses[0] = far;
            return self.needed(points, far);
        }
        self.list_below(topology, points, both);
        let mut behind = 0;
        for face in &self.faces[..self.changed] {
            let [to, next, last] = face.corners.points;
            for side in [&[to, next][..], &[last, to], &[to, next, last]] {
                match self.behind(points, face.mesh, side, behind) {
                    Ok(at) => behind = at,
                    Err(needed) => return needed,
                }
            }
        }
        self.looked_at = Some(both);
        0.0
    }

    /// Squared distance from the collapsing point to the nearest triangle after the collapse, or to any triangle within
    /// the limit. Most refused collapses fail here, so triangles are listed only afterwards.
    fn needed_by_point(&self, topology: &Topology, points: &Points, [point, neighbor]: [u32; 2]) -> f32 {
        let place = self.place(points, point);
        let mut least = f32::INFINITY;
        for (around, other) in [(point, neighbor), (neighbor, point)] {
            let numbers = topology.around(around).iter().copied();
            let rings = topology.ring(around).iter().zip(numbers);
            for ([next, last], number) in rings.filter(|(ends, _)| !ends.contains(&other)) {
                if !place.may_be_on(mesh_of(topology, number)) {
                    continue;
                }
                least =
                    least.min(off(points, &Corners::new(points, [neighbor, *next, *last]), &place, least));
                if least <= self.most {
                    return least;
                }
            }
        }
        least
    }

    /// Squared distance from a sample to the nearest triangle after a collapse.
    fn needed(&self, points: &Points, sample: u32) -> f32 {
        nearest_off(points, &self.place(points, sample), self.faces.iter())
    }

    /// Lists in `faces` the triangles of both points as they are after a collapse, the changed triangles first.
    fn list_faces(&mut self, topology: &Topology, points: &Points, point: u32, neighbor: u32) {
        self.faces.clear();
        for (around, other) in [(point, neighbor), (neighbor, point)] {
            self.changed = self.faces.len();
            for ring in topology.one_ring(around) {
                let ends = [ring.next.point, ring.last.point];
                if !ends.contains(&other) {
                    let number = [ring.triangle, mesh_of(topology, ring.triangle)];
                    self.faces.push(Face::new(points, number, [neighbor, ends[0], ends[1]]));
                }
            }
        }
    }

    /// Lists in `below` the triangles of the original mesh whose midpoints are assigned to triangles around two points.
    /// Each is given by one of its midpoints.
    fn list_below(&mut self, topology: &Topology, points: &Points, both: [u32; 2]) {
        self.below.clear();
        let mut last = NONE;
        for triangle in both.iter().flat_map(|point| topology.around(*point)) {
            for sample in &self.samples[*triangle as usize] {
                let Some(middle) = (*sample as usize).checked_sub(points.len()) else { continue };
                // Midpoints of one triangle are mostly consecutive, so this skips most duplicates.
                let of = self.middles.triangles[middle].number;
                if of != last {
                    self.below.push(middle as u32);
                }
                last = of;
            }
        }
    }

    /// Finds an original triangle that belongs to `mesh`. In all poses, it must be within the limit of the midpoint of
    /// `ends`. Returns its index in `below`: `likely` if that triangle qualifies, otherwise the first that does. If
    /// there is none, the error is the square of the smallest distance.
    fn behind(&self, points: &Points, mesh: u32, ends: &[u32], likely: usize) -> Result<usize, f32> {
        let place = Place::new(points.common_body(ends), mesh, |pose| middle(points, ends, pose));
        let limits = [self.most.sqrt(), self.most];
        let face = |at: &u32| &self.middles.triangles[*at as usize];
        let is_near = |at: &u32| face(at).is_near(points, &place, limits);
        if self.below.get(likely).is_some_and(is_near) {
            return Ok(likely);
        }
        let near = self.below.iter().position(is_near);
        near.ok_or_else(|| nearest_off(points, &place, self.below.iter().map(face)))
    }

    /// Position of a sample in all poses.
    fn place(&self, points: &Points, sample: u32) -> Place<impl Fn(usize) -> Vec3> {
        let middle = (sample as usize).checked_sub(points.len());
        let body = middle.map_or_else(|| points.body(sample), |at| self.middles.triangles[at].corners.body);
        let mesh = match middle {
            None => self.meshes_of_points[sample as usize],
            Some(at) => self.middles.triangles[at].mesh,
        };
        Place::new(body, mesh, move |pose| match middle {
            None => points.position(sample, pose).as_vec3(),
            Some(at) => self.middles.positions[at * points.poses() + pose],
        })
    }

    /// Finds a triangle after the collapse that is within the limit of a sample in all poses. Returns its index in
    /// `faces`: `likely` if that triangle qualifies, otherwise the first that does. `None` if there is none.
    fn near(&self, points: &Points, sample: u32, likely: usize) -> Option<usize> {
        let (place, limits) = (self.place(points, sample), [self.most.sqrt(), self.most]);
        let is_near = |face: &Face| face.is_near(points, &place, limits);
        if self.faces.get(likely).is_some_and(is_near) {
            return Some(likely);
        }
        self.faces.iter().position(is_near)
    }

    /// Finds the triangle after the collapse that is nearest to a sample. Returns its index in `faces`; `None` if it is
    /// beyond the limit. The distance is the largest over all poses. `likely` is tested first, so that most other
    /// triangles can be rejected quickly.
    fn nearest(&self, points: &Points, sample: u32, likely: usize) -> Option<usize> {
        let place = self.place(points, sample);
        let off = |face: &Face, most| off(points, &face.corners, &place, most);
        let likely = self.faces.get(likely).filter(|face| place.may_be_on(face.mesh));
        let first = likely.map_or(self.most, |face| off(face, self.most));
        let most = first.min(self.most);
        let (mut best, mut limit, mut least) = (None, most.sqrt(), most.next_up());
        for (at, face) in self.faces.iter().enumerate() {
            if !place.may_be_on(face.mesh) || face.is_far(place.first, limit) {
                continue;
            }
            let off = off(face, least);
            if off < least {
                (best, limit, least) = (Some(at), off.sqrt(), off);
            }
        }
        best
    }

    /// Records a collapse that stays within the allowed distance. Call this before the collapse is made.
    pub(crate) fn collapse(&mut self, topology: &Topology, points: &Points, point: u32, neighbor: u32) {
        // Other collapses may have been tested in between, so the lists may be outdated.
        if self.looked_at.take() != Some([point, neighbor]) {
            self.list_faces(topology, points, point, neighbor);
        }
        let mut moved = vec![point];
        for triangle in topology.around(point) {
            moved.append(&mut self.samples[*triangle as usize]);
        }
        self.verdicts.collapse(topology, [point, neighbor]);
        let mut likely = 0;
        for sample in moved {
            if let Some(at) = self.nearest(points, sample, likely) {
                likely = at;
                let triangle = self.faces[at].number;
                self.samples[triangle as usize].push(sample);
                self.homes[sample as usize] = triangle;
            }
        }
    }
}

/// Mesh of a triangle, or [`ANY`].
#[inline]
fn mesh_of(topology: &Topology, triangle: u32) -> u32 {
    topology.mesh(triangle).unwrap_or(ANY)
}

fn middle(points: &Points, ends: &[u32], pose: usize) -> Vec3 {
    let sum: Vec3 = ends.iter().map(|end| points.position(*end, pose).as_vec3()).sum();
    sum / ends.len() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::simplify::{Simplified, SimplifyOptions, Stopped, Surface, simplify, simplify_within};

    const SIDE: u32 = 18;

    /// A bumpy sheet in two poses: flat and bent.
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

    /// Samples of triangles: their corners, and the midpoints of edges and triangles.
    fn positions(pose: &[[f32; 3]], indices: &[u32]) -> Vec<Vec3> {
        let of = |triangle: &[u32]| {
            let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from(pose[triangle[corner] as usize]));
            [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0]
        };
        indices.chunks_exact(3).flat_map(of).collect()
    }

    /// Largest distance from the samples of either surface to the other surface, over all poses.
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
        let found = simplify_within(&surface, &SimplifyOptions::default(), &distances).expect("valid");
        assert_eq!(found.stopped(), Stopped::Distance);
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
        // Without a distance limit, a level that stays within this distance has more triangles.
        let plain = simplify(&surface, &SimplifyOptions::default()).expect("valid");
        assert!(plain.collapses().iter().all(|collapse| collapse.distance == f32::INFINITY));
        let within = |count| off(&poses, &indices, &level(&plain, count)) <= 0.02;
        let far =
            (0..plain.collapses().len()).step_by(5).find(|count| !within(*count)).expect("far off at last");
        let near = level(&found, found.collapses_near(0.02)).len();
        assert!(5 * level(&plain, far).len() > 6 * near, "{} and {near}", level(&plain, far).len());
    }

    /// Every triangle that is reported as far is farther than the limit, even if it is a sliver or distant.
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
            let face = Face::new(&points, [0, ANY], [0, 1, 2]);
            let position = placed[0] + 2.0 * size * place(4.7);
            let off = nearest_on_triangle(position, placed).distance(position);
            for limit in [0.2 * off, 0.9 * off, 0.999_999 * off, off, 1.1 * off] {
                let is_far = face.is_far(position, limit);
                assert!(!is_far || off > limit, "{corners:?} {position}: {off} {limit}");
                far += usize::from(is_far);
                all += 1;
            }
        }
        // Of five limits, three are below the distance, one of them by less than the rounding error.
        assert!(6 * far > all, "{far} of {all}");
    }

    #[test]
    fn distances_are_checked() {
        let (poses, indices) = sheet();
        let surface = Surface { poses: &poses, indices: &indices, attributes: &[], stride: 0 };
        let refused = |distances: &[f32]| {
            simplify_within(&surface, &SimplifyOptions::default(), distances).expect_err("refused").path
        };
        assert_eq!(refused(&[-1.0]), "distances[0]");
        assert_eq!(refused(&[0.5, 0.25]), "distances[1]");
        assert_eq!(refused(&[0.5, f32::NAN]), "distances[1]");
        let none = simplify_within(&surface, &SimplifyOptions::default(), &[]).expect("valid");
        assert_eq!((none.collapses().len(), none.stopped()), (0, Stopped::Distance));
    }
}
