//! The quadric cost: the quadrics of every point in each pose, and of every vertex's attributes.

use super::Surface;
use super::attributes::Attributes;
use super::neighbors::{Neighbor, Neighbors, Wedge};
use super::points::Points;
use super::quadric::Quadric;
use super::topology::{Corner, Topology};
use super::turned::normal;

/// The quadrics of a mesh.
pub(crate) struct Quadrics<'a> {
    /// Quadrics of positions, point by point, each in all poses.
    shape: Vec<Quadric>,
    attributes: Option<Attributes<'a>>,
}

impl<'a> Quadrics<'a> {
    pub(crate) fn new(surface: &Surface<'a>, points: &Points, topology: &Topology) -> Self {
        let mut shape = vec![Quadric::default(); points.len() * points.poses()];
        let triangles = (surface.indices.len() / 3) as u32;
        for triangle in 0..triangles {
            add_triangle(&mut shape, points, topology, triangle);
        }
        let attributes = (surface.stride > 0).then(|| {
            let position = |point| points.position(point, 0);
            Attributes::new(topology, triangles, position, surface.attributes, surface.stride)
        });
        Self { shape, attributes }
    }

    pub(crate) fn has_attributes(&self) -> bool {
        self.attributes.is_some()
    }

    /// The mean squared distance of a point's planes from its neighbour, in the worst pose. `None` if it is not
    /// below `most`.
    pub(crate) fn shape_cost(&self, points: &Points, [point, neighbor]: [u32; 2], most: f64) -> Option<f64> {
        let mut worst = 0.0_f64;
        for pose in 0..points.poses() {
            let quadric = &self.shape[point as usize * points.poses() + pose];
            let d = points.position(neighbor, pose) - points.position(point, pose);
            if quadric.weight > 0.0 {
                worst = worst.max(quadric.at(d) / quadric.weight);
            }
            if worst >= most {
                return None;
            }
        }
        Some(worst)
    }

    /// The mean squared difference in attributes if a point collapses and each of its wedges is replaced by the
    /// cheapest vertex allowed.
    pub(crate) fn attribute_cost(
        &self,
        points: &Points,
        neighbors: &Neighbors,
        point: u32,
        neighbor: &Neighbor,
    ) -> f64 {
        let Some(attributes) = &self.attributes else { return 0.0 };
        let (mut sum, mut weight) = (0.0, 0.0);
        for wedge in neighbors.wedges() {
            let (_, cost) = self.target(points, neighbors, point, neighbor, wedge);
            sum += cost;
            weight += attributes.weight(wedge.vertex);
        }
        if weight > 0.0 { sum / weight } else { 0.0 }
    }

    /// The cheapest replacement of a wedge, and its cost in attributes.
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
        let all = neighbors.remap(neighbor, wedge).into_iter().map(|target| (target, cost(target)));
        all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((wedge.vertex, 0.0))
    }

    /// Merges a point into its neighbour, and its wedges into the vertices that `moved` names.
    pub(crate) fn merge(&mut self, points: &Points, point: u32, neighbor: u32, moved: &[[u32; 2]]) {
        for pose in 0..points.poses() {
            let d = points.position(neighbor, pose) - points.position(point, pose);
            let [from, to] = [point, neighbor].map(|point| point as usize * points.poses() + pose);
            let quadric = self.shape[from].moved(d);
            self.shape[to].add(&quadric);
        }
        if let Some(attributes) = &mut self.attributes {
            let d = points.position(neighbor, 0) - points.position(point, 0);
            moved.iter().for_each(|[from, to]| attributes.merge(*from, *to, d));
        }
    }
}

/// Adds a triangle's plane to each corner, weighted by the area, and for each held edge the plane across it to
/// both ends, weighted by the square of the edge's length: displacing a border by a distance costs about that
/// distance. The planes of held edges do not count in the weight by which sums are divided; otherwise the ends
/// of borders would seem closer to their triangles than they are.
fn add_triangle(shape: &mut [Quadric], points: &Points, topology: &Topology, triangle: u32) {
    let corners = topology.corners(triangle);
    let of = corners.map(|corner| corner.point);
    // The triangle has no area in any pose.
    if of[0] == of[1] || of[1] == of[2] || of[2] == of[0] {
        return;
    }
    let held = [0, 1, 2].map(|at| is_held(topology, triangle, corners[at], corners[(at + 1) % 3]));
    for pose in 0..points.poses() {
        let positions = of.map(|point| points.position(point, pose));
        let Ok(normal) = normal(positions) else { continue };
        let length = normal.length();
        let at = of.map(|point| point as usize * points.poses() + pose);
        let plane = Quadric::linear(normal / length, length * 0.5);
        at.iter().for_each(|at| shape[*at].add(&plane));
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            if held[from] {
                let edge = positions[to] - positions[from];
                let across = Quadric::linear(edge.cross(normal).normalize(), edge.length_squared());
                shape[at[from]].add_unweighted(&across);
                shape[at[to]].add_unweighted(&across);
            }
        }
    }
}

/// Whether an edge is held: it is on a border, or the triangle on its other side has different wedges at both
/// ends.
fn is_held(topology: &Topology, triangle: u32, from: Corner, to: Corner) -> bool {
    let is_shorter = topology.around(from.point).len() < topology.around(to.point).len();
    let [near, far] = if is_shorter { [from, to] } else { [to, from] };
    let mut others = topology.one_ring(near.point).filter(|ring| ring.triangle != triangle);
    let beside = others.find_map(|ring| {
        let end = [ring.next, ring.last].into_iter().find(|end| end.point == far.point)?;
        Some([ring.vertex, end.vertex])
    });
    beside.is_none_or(|[vertex, end]| vertex != near.vertex && end != far.vertex)
}
