//! Where the mesh lies on what is left of it: how far it is off, measured, at its points and at the middles of its
//! edges and triangles.

use glam::Vec3;

use super::points::Points;
use super::topology::Topology;
use crate::mesh::nearest::nearest_on_triangle;

/// Places of the mesh, each with a triangle that it is within a distance of in every pose.
pub struct Attached {
    /// Of each triangle: points that are gone, and behind all points numbers of middles.
    gone: Vec<Vec<u32>>,
    middles: Middles,
    /// The most that a place may be off, squared.
    most: f32,
    /// Of the collapse that was last looked at: places and their triangles.
    found: Vec<(u32, u32)>,
    /// Likewise: triangles that there would be, those that it changes first, and their corners.
    triangles: Vec<(u32, [u32; 3])>,
    /// How many it changes.
    changed: usize,
    /// Triangles of the mesh that these may lie on.
    below: Vec<[u32; 3]>,
}

/// Middles of the mesh's edges and triangles.
struct Middles {
    /// One after another, each in all poses.
    places: Vec<Vec3>,
    /// A triangle of the mesh that each lies on: its points.
    triangles: Vec<[u32; 3]>,
}

impl Attached {
    pub fn new(topology: &Topology, points: &Points, triangles: usize) -> Self {
        let mut gone = vec![Vec::new(); triangles];
        let mut middles = Middles { places: Vec::new(), triangles: Vec::new() };
        for point in 0..points.len() as u32 {
            for spoke in topology.spokes(point) {
                let corners = [point, spoke.next.point, spoke.last.point];
                // The other triangle of an edge has it the other way round, unless it is a border's.
                let is_border = || !topology.spokes(point).any(|other| other.last.point == corners[1]);
                let is_first = corners.iter().all(|other| point <= *other);
                let edge = (point < corners[1] || is_border()).then_some(&corners[..2]);
                for ends in edge.into_iter().chain(is_first.then_some(&corners[..])) {
                    gone[spoke.triangle as usize].push((points.len() + middles.triangles.len()) as u32);
                    middles.places.extend((0..points.poses()).map(|pose| middle(points, ends, pose)));
                    middles.triangles.push(corners);
                }
            }
        }
        let (found, triangles, below) = (Vec::new(), Vec::new(), Vec::new());
        Self { gone, middles, most: 0.0, found, triangles, changed: 0, below }
    }

    /// Chooses the most that a place may be off from now on.
    pub fn set_most(&mut self, distance: f32) {
        self.most = distance * distance;
    }

    /// Whether a point may become its neighbour: it, and all places on the triangles that this changes, find a triangle
    /// among those that both have then; and the middles of these and of their edges lie near the mesh.
    pub fn keeps_near(&mut self, topology: &Topology, points: &Points, point: u32, neighbor: u32) -> bool {
        self.triangles.clear();
        self.found.clear();
        self.below.clear();
        for (around, other) in [(point, neighbor), (neighbor, point)] {
            self.changed = self.triangles.len();
            for spoke in topology.spokes(around) {
                let ends = [spoke.next.point, spoke.last.point];
                if !ends.contains(&other) {
                    self.triangles.push((spoke.triangle, [neighbor, ends[0], ends[1]]));
                }
                let middles = self.gone[spoke.triangle as usize]
                    .iter()
                    .filter_map(|gone| (*gone as usize).checked_sub(points.len()));
                self.below.extend(middles.map(|middle| self.middles.triangles[middle]));
            }
        }
        let gone = topology.around(point).iter().flat_map(|triangle| &self.gone[*triangle as usize]);
        for gone in std::iter::once(&point).chain(gone) {
            let Some(triangle) = self.nearest(points, *gone) else { return false };
            self.found.push((*gone, triangle));
        }
        self.triangles[..self.changed].iter().all(|(_, [to, next, last])| {
            let sides: [&[u32]; 3] = [&[*to, *next], &[*last, *to], &[*to, *next, *last]];
            sides.iter().all(|side| self.is_near(points, side))
        })
    }

    /// Whether the middle of some points lies near one and the same triangle of the mesh in all poses.
    fn is_near(&self, points: &Points, ends: &[u32]) -> bool {
        let is_near = |triangle: &[u32; 3], pose: usize| {
            let wanted = middle(points, ends, pose);
            let corners = triangle.map(|corner| points.place(corner, pose).as_vec3());
            nearest_on_triangle(wanted, corners).distance_squared(wanted) <= self.most
        };
        self.below.iter().any(|triangle| (0..points.poses()).all(|pose| is_near(triangle, pose)))
    }

    /// The triangle whose largest distance in any pose is least, if it is not too large.
    fn nearest(&self, points: &Points, gone: u32) -> Option<u32> {
        let place = |point: u32, pose: usize| -> Vec3 { points.place(point, pose).as_vec3() };
        let mut best = None;
        let mut least = self.most.next_up();
        for (triangle, corners) in &self.triangles {
            let mut most = 0.0_f32;
            for pose in 0..points.poses() {
                let wanted = match (gone as usize).checked_sub(points.len()) {
                    None => place(gone, pose),
                    Some(at) => self.middles.places[at * points.poses() + pose],
                };
                let found = nearest_on_triangle(wanted, corners.map(|corner| place(corner, pose)));
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

    /// Takes note of the collapse that was last looked at, before it happens.
    pub fn collapse(&mut self, topology: &Topology, point: u32) {
        for triangle in topology.around(point) {
            self.gone[*triangle as usize].clear();
        }
        for (gone, triangle) in self.found.drain(..) {
            self.gone[triangle as usize].push(gone);
        }
    }
}

fn middle(points: &Points, ends: &[u32], pose: usize) -> Vec3 {
    let sum: Vec3 = ends.iter().map(|end| points.place(*end, pose).as_vec3()).sum();
    sum / ends.len() as f32
}
