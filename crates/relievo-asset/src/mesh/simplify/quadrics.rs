//! The quadric cost: quadrics of every point's position in each pose, and of every vertex's attributes.

use super::Surface;
use super::attributes::{Attributes, Joint};
use super::neighbors::{Neighbor, Neighbors, Wedge};
use super::points::{NO_BODY, Points};
use super::quadric::Quadric;
use super::topology::{Kind, Topology};
use super::turned::normal;

/// Weight of the planes that hold border edges, relative to the planes of triangles. It is 2 because a border edge has
/// one triangle instead of two. If a single spot leaves the border, `deviation` detects it. With a weight five times as
/// large, models with many borders keep too many points on borders, and too few elsewhere.
const BORDER: f64 = 2.0;

/// Weight of the planes that hold seam edges, for each of the two triangles at an edge. It is smaller than [`BORDER`]
/// because the surface continues across a seam, so only the seam's course must be kept. With a larger weight, models of
/// many hard-edged parts have larger errors.
const SEAM: f64 = 0.25;

/// If a point has at least this number of wedges, their attributes are summed once instead of once per neighbour. An
/// example is the pole of a sphere, which has one wedge per neighbour.
const JOINED: usize = 8;

/// All quadrics of a mesh.
pub(crate) struct Quadrics<'a> {
    /// Quadrics of positions. All poses of point 0 come first.
    shape: Vec<Quadric>,
    /// For each point, the rigid body that all of its planes belong to, or [`NO_BODY`].
    bodies: Vec<u32>,
    attributes: Option<Attributes<'a>>,
    /// Summed attribute errors of the point that was last passed to [`Quadrics::join`].
    joint: Joint<'a>,
}

impl<'a> Quadrics<'a> {
    pub(crate) fn new(surface: &Surface<'a>, points: &Points, topology: &Topology) -> Self {
        let mut shape = vec![Quadric::default(); points.len() * points.poses()];
        let mut bodies: Vec<u32> = (0..points.len() as u32).map(|point| points.body(point)).collect();
        for &triangle in surface.indices.as_chunks().0 {
            add_triangle(&mut shape, points, topology, triangle);
            let corners = triangle.map(|vertex| points.of(vertex));
            if points.common_body(&corners) == NO_BODY {
                corners.iter().for_each(|corner| bodies[*corner as usize] = NO_BODY);
            }
        }
        let attributes = (surface.stride > 0).then(|| Attributes::new(surface, points));
        Self { shape, bodies, attributes, joint: Joint::default() }
    }

    /// Whether attributes are part of the cost.
    #[inline]
    pub(crate) fn has_attributes(&self) -> bool {
        self.attributes.is_some()
    }

    /// Mean squared distance between the planes of a point and the position of its neighbour, in the worst pose.
    #[inline]
    pub(crate) fn shape_cost(&self, points: &Points, [point, neighbor]: [u32; 2]) -> f64 {
        let mut worst = 0.0_f64;
        for pose in 0..points.poses_between(self.bodies[point as usize], points.body(neighbor)) {
            let quadric = &self.shape[point as usize * points.poses() + pose];
            let d = points.position(neighbor, pose) - points.position(point, pose);
            if quadric.weight > 0.0 {
                worst = worst.max(quadric.at(d) / quadric.weight);
            }
        }
        worst
    }

    /// Cheapest collapse of a point with one vertex: the cost and the neighbour. Among equal costs, the neighbour with
    /// the lower index is taken. `None` if the point has no neighbour, or if there are attributes and a neighbour has
    /// several vertices.
    #[inline]
    pub(crate) fn cheapest(
        &self,
        points: &Points,
        [point, vertex]: [u32; 2],
        ring: &[[u32; 2]],
    ) -> Option<(f32, u32)> {
        if points.poses() > 1 {
            return self.cheapest_in_all(points, [point, vertex], ring);
        }
        let origin = points.position(point, 0);
        let shape = self.shape[point as usize];
        let mut best = Cheapest::default();
        match &self.attributes {
            None => {
                let inverse = shape.inverse_weight();
                for &[neighbor, _] in ring {
                    best.add(shape.at(points.position(neighbor, 0) - origin) * inverse, neighbor);
                }
            }
            Some(attributes) => {
                let of = attributes.of(vertex);
                let all = of.with(&shape);
                for &[neighbor, _] in ring {
                    let (target, d) = (points.only_wedge(neighbor)?, points.position(neighbor, 0) - origin);
                    let change = of.change(attributes.values_of(target), d.as_vec3());
                    best.add((all.at(d) + f64::from(change)).max(0.0), neighbor);
                }
            }
        }
        best.found()
    }

    /// As [`Self::cheapest`], but for several poses.
    fn cheapest_in_all(
        &self,
        points: &Points,
        [point, vertex]: [u32; 2],
        ring: &[[u32; 2]],
    ) -> Option<(f32, u32)> {
        let mut best = Cheapest::default();
        for &[neighbor, _] in ring {
            let shape = self.shape_cost(points, [point, neighbor]);
            let attributes = match &self.attributes {
                None => 0.0,
                Some(attributes) => {
                    let d = points.position(neighbor, 0) - points.position(point, 0);
                    attributes.cost(vertex, points.only_wedge(neighbor)?, d)
                }
            };
            best.add(shape + attributes, neighbor);
        }
        best.found()
    }

    /// Reads the data of a point and of its first vertex to prefetch it. The returned number only prevents the compiler
    /// from dropping the reads.
    #[inline]
    pub(crate) fn touch(&self, points: &Points, point: u32) -> u32 {
        let quadric = self.shape[point as usize * points.poses()].touch() as u32;
        match (&self.attributes, points.only_wedge(point)) {
            (Some(attributes), Some(vertex)) => quadric ^ attributes.touch(vertex),
            _ => quadric,
        }
    }

    /// Prepares [`Self::attribute_cost`] for the point that `neighbors` describes.
    pub(crate) fn join(&mut self, points: &Points, neighbors: &Neighbors) {
        if let Some(attributes) = self.attributes.as_ref().filter(|_| is_joined(points, neighbors)) {
            attributes.join(neighbors.wedges().iter().map(|wedge| wedge.vertex), &mut self.joint);
        }
    }

    /// Attribute cost of a collapse in which each wedge of the point is replaced by the cheapest vertex that may
    /// replace it. The cost is a sum of squared differences, weighted by area. If the sum exceeds `most`, a partial sum
    /// above `most` may be returned.
    pub(crate) fn attribute_cost(
        &self,
        points: &Points,
        neighbors: &Neighbors,
        point: u32,
        neighbor: &Neighbor,
        most: f64,
    ) -> f64 {
        let mut sum = 0.0;
        if let Some(attributes) = &self.attributes {
            if let Some(target) = neighbor.only_target().filter(|_| is_joined(points, neighbors)) {
                let d = points.position(neighbor.point, 0) - points.position(point, 0);
                return attributes.joint_cost(&self.joint, target, d);
            }
            for wedge in neighbors.wedges() {
                sum += self.target(points, neighbors, point, neighbor, wedge).1;
                // It is safe to compare before rounding, because rounding to f32 is monotonic.
                if sum > most {
                    break;
                }
            }
        }
        sum
    }

    /// Cheapest replacement of a wedge, and its attribute cost.
    pub(crate) fn target(
        &self,
        points: &Points,
        neighbors: &Neighbors,
        point: u32,
        neighbor: &Neighbor,
        wedge: &Wedge,
    ) -> (u32, f64) {
        let d = points.position(neighbor.point, 0) - points.position(point, 0);
        let cost = |target| self.attributes.as_ref().map_or(0.0, |all| all.cost(wedge.vertex, target, d));
        let near = neighbors.remap(neighbor, wedge).into_iter().map(|target| (target, cost(target)));
        let near = near.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((wedge.vertex, 0.0));
        // Vertices of one chart are in ascending order. Among equally cheap vertices, the first is taken.
        let beyond = neighbors.beyond(points, neighbor, near.0).map(|target| (target, cost(target)));
        beyond.fold(near, |best, other| if other.1 < best.1 { other } else { best })
    }

    /// Attribute cost of removing the triangles of the points in `part`.
    pub(crate) fn lost(&self, points: &Points, part: &[u32]) -> f64 {
        let vertices = || part.iter().flat_map(|point| points.wedges(*point)).copied();
        self.attributes.as_ref().map_or(0.0, |attributes| attributes.lost(vertices))
    }

    /// Merges the quadrics of a point into its neighbour's quadrics. `moved` gives the replacement of each wedge of the
    /// point.
    pub(crate) fn merge(&mut self, points: &Points, point: u32, neighbor: u32, moved: &[[u32; 2]]) {
        for pose in 0..points.poses() {
            let d = points.position(neighbor, pose) - points.position(point, pose);
            let [from, to] = [point, neighbor].map(|point| point as usize * points.poses() + pose);
            let quadric = self.shape[from].moved(d);
            self.shape[to].add(&quadric);
        }
        if self.bodies[point as usize] != self.bodies[neighbor as usize] {
            self.bodies[neighbor as usize] = NO_BODY;
        }
        if let Some(attributes) = &mut self.attributes {
            let d = points.position(neighbor, 0) - points.position(point, 0);
            moved.iter().for_each(|[from, to]| attributes.merge(*from, *to, d));
        }
    }
}

/// Whether the attribute errors of a point's wedges are summed once for all neighbours. This pays off only for many
/// wedges. It also requires that one vertex replaces all wedges. This holds for a point with one sheet, if seams may
/// not be crossed.
fn is_joined(points: &Points, neighbors: &Neighbors) -> bool {
    neighbors.wedges().len() >= JOINED && !neighbors.is_split() && !points.has_charts()
}

/// The cheapest collapse found so far.
struct Cheapest {
    cost: f32,
    neighbor: u32,
}

impl Default for Cheapest {
    fn default() -> Self {
        Self { cost: f32::INFINITY, neighbor: u32::MAX }
    }
}

impl Cheapest {
    #[inline]
    fn add(&mut self, cost: f64, neighbor: u32) {
        let cost = cost as f32;
        if cost < self.cost || cost == self.cost && neighbor < self.neighbor {
            *self = Self { cost, neighbor };
        }
    }

    fn found(self) -> Option<(f32, u32)> {
        (self.neighbor != u32::MAX).then_some((self.cost, self.neighbor))
    }
}

/// Adds a triangle's plane to the quadric of each corner, weighted by the square root of the area. For each border or
/// seam edge, also adds a plane to both ends, weighted by the edge's length. This plane contains the edge and is
/// perpendicular to the triangle. It does not count in the weight by which sums are divided. Otherwise the ends of
/// borders would seem closer to their triangles than they are.
fn add_triangle(shape: &mut [Quadric], points: &Points, topology: &Topology, vertices: [u32; 3]) {
    let of = [points.of(vertices[0]), points.of(vertices[1]), points.of(vertices[2])];
    // This triangle has no area in any pose.
    if of[0] == of[1] || of[1] == of[2] || of[2] == of[0] {
        return;
    }
    let hold = |from: usize, to: usize, across: usize| {
        hold(points, topology, [of[from], of[to], of[across]], [vertices[from], vertices[to]])
    };
    let held = [hold(0, 1, 2), hold(1, 2, 0), hold(2, 0, 1)];
    for pose in 0..points.poses() {
        let [a, b, c] = of;
        let positions = [points.position(a, pose), points.position(b, pose), points.position(c, pose)];
        let Ok(normal) = normal(positions) else { continue };
        let length = normal.length();
        let at = |corner: usize| of[corner] as usize * points.poses() + pose;
        let plane = Quadric::linear(normal / length, length.sqrt());
        for corner in 0..3 {
            shape[at(corner)].add_plane(&plane);
        }
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            if let Some(factor) = held[from] {
                let edge = positions[to] - positions[from];
                let across = Quadric::linear(edge.cross(normal).normalize(), factor * edge.length());
                shape[at(from)].add_unweighted(&across);
                shape[at(to)].add_unweighted(&across);
            }
        }
    }
}

/// Weight of the plane that holds the edge between a triangle's first two points; `None` unless the edge is on a border
/// or a seam. At a seam, the triangle on the other side has different wedges at both ends. `ends` are this triangle's
/// vertices at the two ends.
fn hold(points: &Points, topology: &Topology, of: [u32; 3], ends: [u32; 2]) -> Option<f64> {
    let [from, to, across] = of;
    let is_inside = |point: u32| topology.kind(point) == Kind::Interior && points.only_wedge(point).is_some();
    if is_inside(from) || is_inside(to) {
        return None;
    }
    let is_shorter = topology.ring(from).len() < topology.ring(to).len();
    let [near, far] = if is_shorter { [from, to] } else { [to, from] };
    let [near_vertex, far_vertex] = if is_shorter { ends } else { [ends[1], ends[0]] };
    let mut others =
        topology.one_ring(near).filter(|ring| ![ring.next.point, ring.last.point].contains(&across));
    let beside = others.find_map(|ring| {
        let end = [ring.next, ring.last].into_iter().find(|end| end.point == far)?;
        Some([ring.vertex, end.vertex])
    });
    match beside {
        None => Some(BORDER),
        Some([vertex, end]) => {
            let is_split = |a: u32, b: u32| points.chart(a) != points.chart(b);
            (is_split(vertex, near_vertex) && is_split(end, far_vertex)).then_some(SEAM)
        }
    }
}
