//! Removal of vertices (Schroeder, Zarge and Lorensen, "Decimation of Triangle Meshes", SIGGRAPH 1992): the point that is
//! nearest to the average plane of its triangles goes first, and the hole that it leaves is triangulated again.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;
use relievo::ops::mesh::simplify::{Stopped, Surface};

use crate::reduce::Reduced;
use crate::reduce::mesh::{Corner, Fan, Ring, normal};
use crate::reduce::steps::{Solid, Steps};

mod hole;

/// The cosine of the angle between triangles from which their edge is a feature: 45°.
const FEATURE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The largest number of triangles around a point that is removed: to triangulate a hole takes the cube of it.
const MAX_FAN: usize = 64;

/// A loop of points around a hole or a part of one, with the normal of the average plane of the triangles that were there, and
/// the lowest triangle of the input of these.
struct Loop {
    corners: Vec<Corner>,
    normal: DVec3,
    origin: u32,
}

/// What takes the place of a point: new triangles instead of its own.
pub(super) struct Patch {
    point: u32,
    cost: f64,
    triangles: Vec<([Corner; 3], u32)>,
}

/// A mesh of which vertices are removed.
pub(super) struct Removal<'a> {
    surface: Surface<'a>,
    solid: Solid,
    /// Squared distances with points and their versions.
    queue: BinaryHeap<Reverse<(u64, u32, u32)>>,
    versions: Vec<u32>,
}

impl<'a> Removal<'a> {
    pub(super) fn new(surface: &Surface<'a>) -> Self {
        let (solid, _) = Solid::new(surface);
        let count = solid.mesh.points();
        let (queue, versions) = (BinaryHeap::new(), vec![0; count]);
        let mut removal = Self { surface: *surface, solid, queue, versions };
        (0..count as u32).for_each(|point| removal.push(point));
        removal
    }

    fn push(&mut self, point: u32) {
        let version = self.versions[point as usize];
        if let Some((_, cost)) = self.loops(point, true) {
            // The bits of non-negative floats have the order of the floats.
            self.queue.push(Reverse((cost.to_bits(), point, version)));
        }
    }

    /// The triangles instead of those of a point, with a feature through it or, if that is not possible, without one.
    fn patch(&self, point: u32) -> Option<Patch> {
        self.filled(point, true).or_else(|| self.filled(point, false))
    }

    fn filled(&self, point: u32, has_features: bool) -> Option<Patch> {
        let (loops, cost) = self.loops(point, has_features)?;
        let mut triangles = Vec::new();
        for of in &loops {
            let new = hole::triangulated(&self.solid.mesh, &self.solid.places, point, of)?;
            triangles.extend(new.into_iter().map(|corners| (corners, of.origin)));
        }
        // Two loops with the same chord, or none of which a triangle is left: nothing may remain of an island.
        (!triangles.is_empty()).then_some(Patch { point, cost, triangles })
    }

    /// The loops that a point leaves, and the square of its distance to the average plane, or to the line through its
    /// neighbours along a border, a seam or a feature. `None` if it has to stay.
    fn loops(&self, point: u32, has_features: bool) -> Option<(Vec<Loop>, f64)> {
        let fan = self.solid.mesh.fan(point)?;
        let count = fan.triangles.len();
        if count > MAX_FAN || (fan.is_closed && count < 3) {
            return None;
        }
        let at = self.solid.places[point as usize];
        let parts: Vec<Vec<Ring>> = match (fan.is_closed, self.lines(at, &fan, has_features).as_slice()) {
            (true, []) => {
                let of = self.around(point, &fan.triangles, true)?;
                let cost = self.plane_cost(point, &fan, of.normal);
                return Some((vec![of], cost));
            }
            (true, [first, second]) => {
                let mut turned = fan.triangles;
                turned.rotate_left(*first);
                let rest = turned.split_off(second - first);
                vec![turned, rest]
            }
            (false, []) => vec![fan.triangles],
            _ => return None,
        };
        let chord = [parts[0].first()?.next.point, parts[0].last()?.last.point];
        let loops: Option<Vec<Loop>> = parts.iter().map(|part| self.around(point, part, false)).collect();
        Some((loops?, line_cost(at, chord.map(|end| self.solid.places[end as usize]))))
    }

    /// The triangles of a fan that begin at a seam; if there is none and the point is on no border, those that begin at a
    /// feature, if these are two. A border, a seam or a feature stays a line.
    fn lines(&self, at: DVec3, fan: &Fan, has_features: bool) -> Vec<usize> {
        let triangles = &fan.triangles;
        let inner = usize::from(!fan.is_closed)..triangles.len();
        let before = |start: usize| triangles[(start + triangles.len() - 1) % triangles.len()];
        let is_seam = |start: &usize| {
            let (before, ring) = (before(*start), triangles[*start]);
            before.vertex != ring.vertex || before.last.vertex != ring.next.vertex
        };
        let seams: Vec<usize> = inner.clone().filter(is_seam).collect();
        if !seams.is_empty() || !fan.is_closed || !has_features {
            return seams;
        }
        let face = |ring: Ring| {
            normal([
                at,
                self.solid.places[ring.next.point as usize],
                self.solid.places[ring.last.point as usize],
            ])
        };
        let is_feature = |start: &usize| match (face(before(*start)), face(triangles[*start])) {
            (Some(a), Some(b)) => a.dot(b) < FEATURE * a.length() * b.length(),
            _ => false,
        };
        let features: Vec<usize> = inner.filter(is_feature).collect();
        if features.len() == 2 { features } else { Vec::new() }
    }

    /// The loop around consecutive triangles of a fan. `None` if their plane has no direction, or if a point between two of
    /// them has two wedges.
    fn around(&self, point: u32, rings: &[Ring], is_closed: bool) -> Option<Loop> {
        let mut corners: Vec<Corner> = rings.iter().map(|ring| ring.next).collect();
        if !is_closed {
            corners.push(rings.last()?.last);
        }
        let is_whole = rings.iter().enumerate().all(|(at, ring)| {
            ring.vertex == rings[0].vertex && corners[(at + 1) % corners.len()] == ring.last
        });
        let place = |corner: Corner| self.solid.places[corner.point as usize];
        let at = self.solid.places[point as usize];
        let faces = rings.iter().map(|ring| (place(ring.next) - at).cross(place(ring.last) - at));
        let sum: DVec3 = faces.sum();
        let origin = rings.iter().filter_map(|ring| self.solid.mesh.origin(ring.triangle)).min()?;
        let length = sum.length();
        (is_whole && length > 0.0).then(|| Loop { corners, normal: sum / length, origin })
    }

    /// The squared distance of a point from the plane through the centers of its triangles, weighted by area.
    fn plane_cost(&self, point: u32, fan: &Fan, direction: DVec3) -> f64 {
        let at = self.solid.places[point as usize];
        let (mut center, mut weight) = (DVec3::ZERO, 0.0);
        for ring in &fan.triangles {
            let [next, last] =
                [ring.next, ring.last].map(|corner| self.solid.places[corner.point as usize] - at);
            let area = next.cross(last).length();
            center += (next + last) * (area / 3.0);
            weight += area;
        }
        let distance = if weight > 0.0 { direction.dot(center / weight) } else { 0.0 };
        distance * distance
    }
}

/// The squared distance of a place from the segment between two others.
fn line_cost(at: DVec3, [from, to]: [DVec3; 2]) -> f64 {
    let along = to - from;
    let fraction = ((at - from).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    at.distance_squared(from + along * fraction)
}

impl Steps for Removal<'_> {
    type Step = Patch;

    fn solid(&self) -> &Solid {
        &self.solid
    }

    /// The removal with the smallest distance that is possible; of equal ones that of the lowest point.
    fn find(&mut self) -> Option<Patch> {
        while let Some(Reverse((_, point, version))) = self.queue.pop() {
            if self.versions[point as usize] == version
                && let Some(patch) = self.patch(point)
            {
                return Some(patch);
            }
        }
        None
    }

    fn cost(patch: &Patch) -> f64 {
        patch.cost
    }

    fn take(&mut self, patch: Patch) {
        let around = self.solid.mesh.neighbors(patch.point);
        for ring in self.solid.mesh.ring(patch.point).collect::<Vec<_>>() {
            self.solid.mesh.remove(ring.triangle);
        }
        for (corners, origin) in patch.triangles {
            self.solid.mesh.push(corners, origin);
        }
        self.versions[patch.point as usize] += 1;
        for point in around {
            self.versions[point as usize] += 1;
            self.push(point);
        }
    }

    fn reduced(&self, error: f32, stopped: Stopped) -> Reduced {
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for (triangle, origin) in self.solid.mesh.all() {
            corners.extend(triangle.map(|corner| corner.vertex));
            triangles.push(origin);
        }
        Reduced::of_vertices(&self.surface, &corners, triangles, error, stopped)
    }
}
