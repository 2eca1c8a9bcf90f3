//! The cost by quadrics: of every point in each pose, and of every vertex's attributes.

use super::Surface;
use super::attributes::Attributes;
use super::neighbors::{Neighbor, Neighbors, Wedge};
use super::points::Points;
use super::quadric::Quadric;
use super::topology::{Corner, Topology};
use super::turned::normal;

/// How much a square on a border's edge counts against as much area of a triangle.
const BORDER: f64 = 10.0;
/// The same of a seam's edge.
const SEAM: f64 = 1.0;

/// Quadrics of everything.
pub struct Quadrics<'a> {
    /// Point by point, each in all poses.
    shape: Vec<Quadric>,
    attributes: Option<Attributes<'a>>,
}

impl<'a> Quadrics<'a> {
    pub fn new(surface: &Surface<'a>, points: &Points, topology: &Topology) -> Self {
        let mut shape = vec![Quadric::default(); points.len() * points.poses()];
        let triangles = (surface.indices.len() / 3) as u32;
        for triangle in 0..triangles {
            add_triangle(&mut shape, points, topology, triangle);
        }
        let attributes = (surface.stride > 0).then(|| {
            let place = |point| points.place(point, 0);
            Attributes::new(topology, triangles, place, surface.attributes, surface.stride)
        });
        Self { shape, attributes }
    }

    /// The mean square distance where a point becomes its neighbour, in the worst pose, and that of its attributes;
    /// none where it is not below `most`.
    pub fn cost(
        &self,
        points: &Points,
        neighbors: &Neighbors,
        point: u32,
        neighbor: &Neighbor,
        most: f64,
    ) -> Option<f64> {
        let mut worst = 0.0_f64;
        for pose in 0..points.poses() {
            let quadric = &self.shape[point as usize * points.poses() + pose];
            let d = points.place(neighbor.point, pose) - points.place(point, pose);
            if quadric.weight > 0.0 {
                worst = worst.max(quadric.at(d) / quadric.weight);
            }
            if worst >= most {
                return None;
            }
        }
        let Some(attributes) = &self.attributes else { return Some(worst) };
        let (mut sum, mut weight) = (0.0, 0.0);
        for wedge in neighbors.wedges() {
            let (_, cost) = self.heir(points, neighbors, point, neighbor, wedge);
            sum += cost;
            weight += attributes.weight(wedge.vertex);
        }
        let cost = if weight > 0.0 { worst + sum / weight } else { worst };
        (cost < most).then_some(cost)
    }

    /// What a wedge becomes, at the least cost to its attributes, and that cost.
    pub fn heir(
        &self,
        points: &Points,
        neighbors: &Neighbors,
        point: u32,
        neighbor: &Neighbor,
        wedge: &Wedge,
    ) -> (u32, f64) {
        let d = points.place(neighbor.point, 0) - points.place(point, 0);
        let cost = |heir| self.attributes.as_ref().map_or(0.0, |all| all.cost(wedge.vertex, heir, d));
        let all = neighbors.heirs(neighbor, wedge).into_iter().map(|heir| (heir, cost(heir)));
        all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((wedge.vertex, 0.0))
    }

    /// A point becomes its neighbour, and its wedges what `moved` says.
    pub fn merge(&mut self, points: &Points, point: u32, neighbor: u32, moved: &[[u32; 2]]) {
        for pose in 0..points.poses() {
            let d = points.place(neighbor, pose) - points.place(point, pose);
            let [from, to] = [point, neighbor].map(|point| point as usize * points.poses() + pose);
            let quadric = self.shape[from].moved(d);
            self.shape[to].add(&quadric);
        }
        if let Some(attributes) = &mut self.attributes {
            let d = points.place(neighbor, 0) - points.place(point, 0);
            moved.iter().for_each(|[from, to]| attributes.merge(*from, *to, d));
        }
    }
}

/// Its plane for each corner, and planes across those of its edges that are of a border or a seam for their ends.
fn add_triangle(shape: &mut [Quadric], points: &Points, topology: &Topology, triangle: u32) {
    let corners = topology.corners(triangle);
    let of = corners.map(|corner| corner.point);
    // Of no area in any pose.
    if of[0] == of[1] || of[1] == of[2] || of[2] == of[0] {
        return;
    }
    let holds = [0, 1, 2].map(|at| hold(topology, triangle, corners[at], corners[(at + 1) % 3]));
    for pose in 0..points.poses() {
        let places = of.map(|point| points.place(point, pose));
        let Ok(normal) = normal(places) else { continue };
        let length = normal.length();
        let mut add = |point: u32, quadric: &Quadric| {
            shape[point as usize * points.poses() + pose].add(quadric);
        };
        let plane = Quadric::linear(normal / length, length * 0.5);
        of.iter().for_each(|point| add(*point, &plane));
        for at in 0..3 {
            if let Some(weight) = holds[at] {
                let edge = places[(at + 1) % 3] - places[at];
                let across = edge.cross(normal).normalize();
                let plane = Quadric::linear(across, edge.length_squared() * weight);
                add(of[at], &plane);
                add(of[(at + 1) % 3], &plane);
            }
        }
    }
}

/// How strongly an edge of a triangle is held in place: on a border, or where both its ends differ from those of the
/// triangle on the other side.
fn hold(topology: &Topology, triangle: u32, from: Corner, to: Corner) -> Option<f64> {
    let [fewer, other] = if topology.around(from.point).len() < topology.around(to.point).len() {
        [from, to]
    } else {
        [to, from]
    };
    let beside = topology.spokes(fewer.point).filter(|spoke| spoke.triangle != triangle).find_map(|spoke| {
        let far = [spoke.next, spoke.last].into_iter().find(|far| far.point == other.point)?;
        Some([spoke.vertex, far.vertex])
    });
    match beside {
        None => Some(BORDER),
        Some([near, far]) => (near != fewer.vertex && far != other.vertex).then_some(SEAM),
    }
}
