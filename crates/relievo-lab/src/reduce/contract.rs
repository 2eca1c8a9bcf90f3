//! Contraction of pairs of points to the best place (Garland and Heckbert, "Surface Simplification Using Quadric Error
//! Metrics", SIGGRAPH 1997): the cheapest legal pair first.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use glam::DVec3;
use plan::Plan;
use relievo::ops::mesh::simplify::{Stopped, Surface};

use crate::reduce::Reduced;
use crate::reduce::mesh::{Corner, Mesh, normal, unique};
use crate::reduce::plane_quadric::PlaneQuadric;
use crate::reduce::steps::{Solid, Steps};

mod pairs;
mod plan;

/// Which pairs are contracted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Pairs {
    /// Edges whose contraction keeps topology and seams.
    Edges,
    /// All edges, and points of different parts that lie within this fraction of the bounding box's diagonal.
    Near(f32),
}

/// A pair in the queue: cost, points, and their versions.
type Entry = Reverse<(u64, [u32; 2], [u32; 2])>;

/// A mesh of which pairs of points are contracted.
pub(super) struct Contraction {
    pairs: Pairs,
    solid: Solid,
    /// The position of each point, as it is given out.
    positions: Vec<[f32; 3]>,
    /// The point at each position.
    at: HashMap<[u32; 3], u32>,
    attributes: Vec<f32>,
    stride: usize,
    quadrics: Vec<PlaneQuadric>,
    /// The pairs of each point that are no edges.
    partners: Vec<Vec<u32>>,
    queue: BinaryHeap<Entry>,
    /// How often each point has changed.
    versions: Vec<u32>,
    /// For each point the others with which it could not be contracted when it was last tried.
    refused: Vec<Vec<u32>>,
}

impl Contraction {
    pub(super) fn new(surface: &Surface<'_>, pairs: Pairs) -> Self {
        let (solid, positions) = Solid::new(surface);
        let Solid { mesh, places, .. } = &solid;
        let quadrics = quadrics(mesh, places);
        let at = positions.iter().map(|position| bits(*position)).zip(0..).collect();
        let partners = match pairs {
            Pairs::Edges => vec![Vec::new(); mesh.points()],
            Pairs::Near(fraction) => pairs::near(mesh, places, fraction),
        };
        let count = mesh.points();
        let mut contraction = Self {
            pairs,
            solid,
            positions,
            at,
            attributes: surface.attributes.to_vec(),
            stride: surface.stride,
            quadrics,
            partners,
            queue: BinaryHeap::new(),
            versions: vec![0; count],
            refused: vec![Vec::new(); count],
        };
        for point in 0..count as u32 {
            let others = contraction.others(point);
            others.iter().filter(|other| **other > point).for_each(|other| contraction.push([point, *other]));
        }
        contraction
    }

    /// The points with which a point makes a pair, ascending.
    fn others(&self, point: u32) -> Vec<u32> {
        let neighbors = self.solid.mesh.neighbors(point);
        unique(neighbors.into_iter().chain(self.partners[point as usize].iter().copied()))
    }

    /// Puts a pair into the queue, or among the refused ones.
    fn push(&mut self, pair: [u32; 2]) {
        let pair = [pair[0].min(pair[1]), pair[0].max(pair[1])];
        match self.plan(pair) {
            // The bits of non-negative floats have the order of the floats.
            Some(plan) => {
                let versions = pair.map(|point| self.versions[point as usize]);
                self.queue.push(Reverse((plan.cost.to_bits(), pair, versions)));
            }
            None => self.refuse(pair),
        }
    }

    fn refuse(&mut self, [a, b]: [u32; 2]) {
        self.refused[a as usize].push(b);
        self.refused[b as usize].push(a);
    }

    /// Whether a contraction keeps the topology, where that is promised, and turns no triangle.
    fn is_legal(&self, plan: &Plan) -> bool {
        let keeps = match self.pairs {
            Pairs::Edges => {
                let ends = [plan.gone, plan.keep];
                let borders = ends.map(|point| self.solid.mesh.fan(point).is_some_and(|fan| !fan.is_closed));
                self.solid.mesh.keeps_topology(ends, borders)
            }
            Pairs::Near(_) => true,
        };
        let ends = [plan.gone, plan.keep];
        let is_free = self.at.get(&bits(plan.position)).is_none_or(|point| ends.contains(point));
        keeps
            && is_free
            && self.stays(ends, plan.position)
            && self.stays([plan.keep, plan.gone], plan.position)
    }

    /// Whether no triangle at a point, other than those that it shares with the other one, turns by 90° or more or loses its
    /// area when the point moves. Triangles without area may do anything.
    fn stays(&self, [point, other]: [u32; 2], position: [f32; 3]) -> bool {
        let place = self.solid.frame.of(position);
        self.solid.mesh.ring(point).filter(|ring| !ring.has(other)).all(|ring| {
            let [next, last] = [ring.next, ring.last].map(|corner| self.solid.places[corner.point as usize]);
            match (normal([self.solid.places[point as usize], next, last]), normal([place, next, last])) {
                (None, _) => true,
                (_, None) => false,
                (Some(before), Some(after)) => before.dot(after) > 0.0,
            }
        })
    }

    fn apply(&mut self, plan: &Plan) {
        let Plan { gone, keep, .. } = *plan;
        for [from, to] in &plan.vertices {
            self.blend(*from, *to, plan.fraction);
        }
        for ring in self.solid.mesh.ring(gone).collect::<Vec<_>>() {
            if ring.has(keep) {
                self.solid.mesh.remove(ring.triangle);
                continue;
            }
            let to = plan.vertices.iter().find(|[from, _]| *from == ring.vertex);
            let vertex = to.map_or(ring.vertex, |[_, to]| *to);
            self.solid.mesh.turn_over(ring.triangle, gone, Corner { vertex, point: keep });
        }
        for point in [gone, keep] {
            self.at.remove(&bits(self.positions[point as usize]));
        }
        self.at.insert(bits(plan.position), keep);
        self.positions[keep as usize] = plan.position;
        self.solid.places[keep as usize] = self.solid.frame.of(plan.position);
        self.quadrics[keep as usize] = self.quadrics[keep as usize].sum(&self.quadrics[gone as usize]);
        self.inherit(gone, keep);
        if self.pairs != Pairs::Edges {
            self.drop_opposites(keep);
        }
    }

    /// Moves the attributes of the vertex that is kept towards those of the one that is gone.
    fn blend(&mut self, from: u32, to: u32, fraction: f32) {
        for at in 0..self.stride {
            let from = self.attributes[from as usize * self.stride + at];
            let to = &mut self.attributes[to as usize * self.stride + at];
            *to = if fraction == 0.0 { *to } else { *to * (1.0 - fraction) + from * fraction };
        }
    }

    /// Gives the pairs of a point that is gone to the one that is kept.
    fn inherit(&mut self, gone: u32, keep: u32) {
        for other in std::mem::take(&mut self.partners[gone as usize]) {
            self.partners[other as usize].retain(|partner| *partner != gone && *partner != keep);
            self.partners[keep as usize].retain(|partner| *partner != other);
            if other != keep {
                self.partners[other as usize].push(keep);
                self.partners[keep as usize].push(other);
            }
        }
        self.partners[keep as usize].retain(|partner| *partner != gone);
    }

    /// Removes pairs of triangles with the same corners that face each other.
    fn drop_opposites(&mut self, point: u32) {
        let mut rings: Vec<_> = self.solid.mesh.ring(point).collect();
        rings.sort_unstable_by_key(|ring| (ring.next.point, ring.last.point, ring.triangle));
        let mut is_gone = vec![false; rings.len()];
        for (at, ring) in rings.iter().enumerate().filter(|(_, ring)| ring.next.point < ring.last.point) {
            let key = (ring.last.point, ring.next.point);
            let first = rings.partition_point(|other| (other.next.point, other.last.point) < key);
            let same = rings[first..].iter().take_while(|other| (other.next.point, other.last.point) == key);
            if let Some(other) = (first..first + same.count()).find(|other| !is_gone[*other]) {
                (is_gone[at], is_gone[other]) = (true, true);
            }
        }
        for (ring, _) in rings.iter().zip(is_gone).filter(|(_, is_gone)| *is_gone) {
            self.solid.mesh.remove(ring.triangle);
        }
    }
}

impl Steps for Contraction {
    type Step = Plan;

    fn solid(&self) -> &Solid {
        &self.solid
    }

    /// The cheapest contraction that is legal; of equal ones that of the lower points.
    fn find(&mut self) -> Option<Plan> {
        while let Some(Reverse((cost, pair, versions))) = self.queue.pop() {
            if pair.map(|point| self.versions[point as usize]) != versions {
                continue;
            }
            match self.plan(pair) {
                Some(plan) if plan.cost.to_bits() > cost => self.push(pair),
                Some(plan) if self.is_legal(&plan) => return Some(plan),
                _ => self.refuse(pair),
            }
        }
        None
    }

    fn cost(plan: &Plan) -> f64 {
        plan.cost
    }

    fn take(&mut self, plan: Plan) {
        let around = self.solid.mesh.neighbors(plan.gone);
        self.apply(&plan);
        self.versions[plan.gone as usize] += 1;
        self.versions[plan.keep as usize] += 1;
        self.refused[plan.keep as usize].clear();
        for other in self.others(plan.keep) {
            self.push([plan.keep, other]);
        }
        // What was refused may be legal now.
        let changed = unique(self.solid.mesh.neighbors(plan.keep).into_iter().chain(around));
        for point in changed.into_iter().filter(|point| ![plan.keep, plan.gone].contains(point)) {
            let others = unique(std::mem::take(&mut self.refused[point as usize]));
            let known = self.others(point);
            for other in others.into_iter().filter(|other| *other != plan.keep && known.contains(other)) {
                self.push([point, other]);
            }
        }
    }

    fn reduced(&self, error: f32, stopped: Stopped) -> Reduced {
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for (triangle, origin) in self.solid.mesh.all() {
            corners.extend(triangle);
            triangles.push(origin);
        }
        let position = |corner: &Corner| (corner.vertex, self.positions[corner.point as usize]);
        let placed: Vec<_> = corners.iter().map(position).collect();
        Reduced::placed(&placed, &self.attributes, self.stride, triangles, error, stopped)
    }
}

/// A position as a key; adding 0 turns −0 into +0.
fn bits(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

/// The quadric of each point: the planes of its triangles, weighted by area, and for each border edge the plane across it,
/// weighted by the square of its length, which does not count in the weight by which sums are divided.
fn quadrics(mesh: &Mesh, places: &[DVec3]) -> Vec<PlaneQuadric> {
    let mut quadrics = vec![PlaneQuadric::default(); mesh.points()];
    let mut add = |point: u32, plane: &PlaneQuadric| {
        let sum = quadrics[point as usize].sum(plane);
        quadrics[point as usize] = sum;
    };
    for (corners, _) in mesh.all() {
        let of = corners.map(|corner| corner.point);
        let at = of.map(|point| places[point as usize]);
        let Some(normal) = normal(at) else { continue };
        let length = normal.length();
        let plane = PlaneQuadric::plane(normal / length, at[0], length * 0.5);
        of.iter().for_each(|point| add(*point, &plane));
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            if is_held(mesh, corners[from], corners[to]) {
                let edge = at[to] - at[from];
                let across = edge.cross(normal).normalize();
                let held = PlaneQuadric::plane(across, at[from], edge.length_squared());
                let held = held.unweighted();
                [of[from], of[to]].iter().for_each(|point| add(*point, &held));
            }
        }
    }
    quadrics
}

/// Whether an edge of a triangle is on a border or a seam: no other triangle has it with the same vertices.
fn is_held(mesh: &Mesh, from: Corner, to: Corner) -> bool {
    let meets = mesh.ring(from.point).filter(|ring| ring.vertex == from.vertex);
    meets.filter(|ring| ring.next == to || ring.last == to).count() < 2
}
