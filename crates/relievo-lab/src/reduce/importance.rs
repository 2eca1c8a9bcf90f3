//! Clustering by importance (Rossignac and Borrel, "Multi-resolution 3D Approximations for Rendering Complex Scenes", 1993)
//! with floating cells (Low and Tan, "Model Simplification Using Vertex-Clustering", I3D 1997): cells are balls around the
//! points of the highest grades.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use glam::DVec3;
use relievo::ops::mesh::simplify::{Stopped, Surface, weld};
use rustc_hash::FxHasher;

use crate::reduce::mesh::Mesh;
use crate::reduce::{Limits, Reduced};

/// Steps of the search for a radius; each halves what is left of the diagonal.
const STEPS: usize = 20;

/// The number of edges of a point that its grade compares with each other; of more, every second, third, … one.
const MAX_EDGES: usize = 64;

/// The points in each cell of a grid of cubes. Most of the time goes into looking up cells.
pub(super) type Grid = HashMap<[i64; 3], Vec<u32>, BuildHasherDefault<FxHasher>>;

/// The mesh, and its points from the highest grade to the lowest.
pub(super) struct Graded<'a> {
    surface: Surface<'a>,
    points: Vec<u32>,
    places: Vec<DVec3>,
    order: Vec<u32>,
    /// The largest magnitude of a coordinate.
    largest: f64,
}

/// The points of the mesh that stand for all of them, with the largest distance of one from its own.
struct Cells {
    centers: Vec<u32>,
    error: f32,
}

impl<'a> Graded<'a> {
    pub(super) fn new(surface: &Surface<'a>) -> Self {
        let (mesh, positions) = Mesh::new(surface);
        let places: Vec<DVec3> =
            positions.iter().map(|position| glam::Vec3::from(*position).as_dvec3()).collect();
        let grades: Vec<f64> = (0..places.len() as u32).map(|point| grade(&mesh, &places, point)).collect();
        let mut order: Vec<u32> = (0..places.len() as u32).collect();
        order.sort_by(|a, b| grades[*b as usize].total_cmp(&grades[*a as usize]).then(a.cmp(b)));
        let largest = places.iter().map(|place| place.abs().max_element()).fold(0.0, f64::max);
        Self { surface: *surface, points: weld(surface.poses), places, order, largest }
    }

    /// Searches the radius of cells for a limit.
    pub(super) fn reduce(&self, limit: &Limits) -> Reduced {
        let fits = |cells: &Cells| self.count(cells) <= limit.triangles;
        let low = self.places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = self.places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        // Twice, since rounding could leave the farthest point outside.
        let diagonal = if self.places.is_empty() { 0.0 } else { 2.0 * low.distance(high) };
        let apart = self.cells(0.0);
        if fits(&apart) {
            return self.reduced(&apart, Stopped::Triangles);
        }
        // The number of triangles mostly falls with the radius, which bisection takes for granted. In one cell there is none.
        let (mut least, mut most, mut found) = (0.0, diagonal, self.cells(diagonal));
        for _ in 0..STEPS {
            let middle = (least + most) * 0.5;
            let cells = self.cells(middle);
            if fits(&cells) {
                (most, found) = (middle, cells);
            } else {
                least = middle;
            }
        }
        if found.error <= limit.error {
            return self.reduced(&found, Stopped::Triangles);
        }
        let within = self.cells(f64::from(limit.error));
        let stopped = if fits(&within) { Stopped::Triangles } else { Stopped::Error };
        self.reduced(&within, stopped)
    }

    /// The cells of a radius: in descending order of grades, a point that is in no cell yet gets one of its own. In the end
    /// each point belongs to the nearest center; of several to the one of the highest grade.
    fn cells(&self, radius: f64) -> Cells {
        if radius == 0.0 {
            return Cells { centers: (0..self.places.len() as u32).collect(), error: 0.0 };
        }
        // A little more, so that rounding cannot put a near center two cells away; and numbers of cells fit into f64.
        let edge = (radius * 1.001).max(self.largest * 1e-15);
        let cell = |place: DVec3| (place / edge).floor().to_array().map(|x| x as i64);
        let mut grid = Grid::default();
        let square = radius * radius;
        for point in &self.order {
            let at = self.places[*point as usize];
            let is_near = around(&grid, cell(at))
                .any(|center| self.places[center as usize].distance_squared(at) <= square);
            if !is_near {
                grid.entry(cell(at)).or_default().push(*point);
            }
        }
        let mut ranks = vec![0; self.places.len()];
        (0_u32..).zip(&self.order).for_each(|(rank, point)| ranks[*point as usize] = rank);
        let mut largest = 0.0_f64;
        let nearest = |at: &DVec3| {
            let keys = around(&grid, cell(*at))
                .map(|center| (self.places[center as usize].distance_squared(*at), ranks[center as usize]));
            let (distance, rank) =
                keys.fold((f64::INFINITY, u32::MAX), |best, key| if key < best { key } else { best });
            largest = largest.max(distance);
            self.order[rank as usize]
        };
        let centers = self.places.iter().map(nearest).collect();
        Cells { centers, error: largest.sqrt() as f32 }
    }

    /// The centers of a triangle's corners, if they differ.
    fn corners(&self, cells: &Cells, triangle: &[u32]) -> Option<[u32; 3]> {
        let [a, b, c] = [0, 1, 2].map(|at| cells.centers[self.points[triangle[at] as usize] as usize]);
        (a != b && b != c && c != a).then_some([a, b, c])
    }

    /// Number of triangles that stay.
    fn count(&self, cells: &Cells) -> usize {
        self.surface.indices.chunks_exact(3).filter_map(|triangle| self.corners(cells, triangle)).count()
    }

    fn reduced(&self, cells: &Cells, stopped: Stopped) -> Reduced {
        let mut wedges: Vec<Vec<u32>> = vec![Vec::new(); self.places.len()];
        (0_u32..).zip(&self.points).for_each(|(vertex, point)| wedges[*point as usize].push(vertex));
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for (triangle, vertices) in (0_u32..).zip(self.surface.indices.chunks_exact(3)) {
            let Some(centers) = self.corners(cells, vertices) else { continue };
            corners.extend([0, 1, 2].map(|at| self.wedge(&wedges[centers[at] as usize], vertices[at])));
            triangles.push(triangle);
        }
        Reduced::of_vertices(&self.surface, &corners, triangles, cells.error, stopped)
    }

    /// Of some wedges the one whose attributes are nearest to those of a vertex; of several the lowest.
    fn wedge(&self, wedges: &[u32], vertex: u32) -> u32 {
        let stride = self.surface.stride;
        let attributes = |of: u32| &self.surface.attributes[of as usize * stride..][..stride];
        let apart = |wedge: &u32| -> f64 {
            let pairs = attributes(*wedge).iter().zip(attributes(vertex));
            pairs.map(|(a, b)| f64::from(*a) - f64::from(*b)).map(|apart| apart * apart).sum()
        };
        wedges.iter().copied().min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(vertex)
    }
}

/// The points in a cell of a grid and in those around it.
pub(super) fn around(grid: &Grid, [x, y, z]: [i64; 3]) -> impl Iterator<Item = u32> {
    let cells = (0..27).map(move |at| {
        [x.saturating_add(at % 3 - 1), y.saturating_add(at / 3 % 3 - 1), z.saturating_add(at / 9 - 1)]
    });
    cells.filter_map(|cell| grid.get(&cell)).flatten().copied()
}

/// How much a point counts: the cosine of half the largest angle between two of its edges, times the longest edge. Points of
/// corners and of silhouettes thus come before those of flat ground, where opposite edges make the cosine 0.
fn grade(mesh: &Mesh, places: &[DVec3], point: u32) -> f64 {
    let at = places[point as usize];
    let edges = mesh.neighbors(point).into_iter().map(|other| places[other as usize] - at);
    let edges: Vec<DVec3> = edges.collect();
    let longest = edges.iter().map(|edge| edge.length()).fold(0.0, f64::max);
    let step = edges.len().div_ceil(MAX_EDGES).max(1);
    let directions: Vec<DVec3> = edges.iter().step_by(step).map(|edge| *edge / edge.length()).collect();
    let mut least = 1.0_f64;
    for (at, direction) in directions.iter().enumerate() {
        least = directions[..at].iter().map(|other| direction.dot(*other)).fold(least, f64::min);
    }
    ((1.0 + least.max(-1.0)) * 0.5).sqrt() * longest
}
