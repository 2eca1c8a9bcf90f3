//! Collapse after collapse.

use super::attached::Attached;
use super::melax;
use super::neighbors::{Neighbor, Neighbors};
use super::points::Points;
use super::quadrics::Quadrics;
use super::queue::{Best, Queue};
use super::topology::{Kind, Marks, Topology};
use super::turned::turns_any;
use super::{Collapse, Cost, Options, Simplified, Stopped, Surface};

/// A mesh on its way down.
struct Reducer<'a> {
    points: Points,
    topology: Topology,
    cost: Cost,
    /// With [`Cost::Quadric`] alone.
    quadrics: Option<Quadrics<'a>>,
    /// Where distances are limited.
    attached: Option<Attached>,
    neighbors: Neighbors,
    /// Of points, and of vertices.
    marks: [Marks; 2],
}

/// Collapses as the options say.
pub fn reduce(
    surface: &Surface<'_>,
    points: Points,
    topology: Topology,
    options: &Options,
    distances: &[f32],
) -> Simplified {
    let triangles = topology.triangles();
    let quadrics = match options.cost {
        Cost::Quadric => Some(Quadrics::new(surface, &points, &topology)),
        Cost::Melax { .. } => None,
    };
    let marks = [points.len(), surface.poses[0].len()].map(Marks::new);
    let is_limited = distances.iter().any(|distance| *distance < f32::INFINITY);
    let attached = is_limited.then(|| Attached::new(&topology, &points, surface.indices.len() / 3));
    let neighbors = Neighbors::default();
    let mut reducer = Reducer { points, topology, cost: options.cost, quadrics, attached, neighbors, marks };
    let mut done = Done::default();
    let mut stopped = Stopped::Exhausted;
    for distance in distances {
        stopped = reducer.run(options, *distance, &mut done);
        if stopped != Stopped::Exhausted {
            break;
        }
    }
    let Done { collapses, moved, .. } = done;
    Simplified { collapses, moved, points: reducer.points.into_of(), triangles, stopped }
}

/// What was done.
#[derive(Default)]
struct Done {
    collapses: Vec<Collapse>,
    moved: Vec<[u32; 2]>,
    error: f32,
}

impl Reducer<'_> {
    /// Goes on until nothing is left that is legal, with no point further off than a distance.
    fn run(&mut self, options: &Options, distance: f32, done: &mut Done) -> Stopped {
        if let Some(attached) = &mut self.attached {
            attached.set_most(distance);
        }
        let first = (0..self.points.len() as u32).map(|point| self.find(point)).collect();
        let mut queue = Queue::new(first);
        let mut surroundings = Vec::new();
        loop {
            if self.topology.triangles() <= options.triangles {
                return Stopped::Triangles;
            }
            let Some((point, best)) = queue.pop() else { return Stopped::Exhausted };
            if !self.is_legal(point, best.neighbor) {
                queue.set(point, self.find_legal(point));
                continue;
            }
            let cost = best.cost.sqrt() as f32;
            if cost > options.error {
                return Stopped::Error;
            }
            done.error = done.error.max(cost);
            self.look_around([point, best.neighbor], &mut surroundings);
            self.collapse(point, best.neighbor, &mut done.moved);
            let (error, end) = (done.error, done.moved.len() as u32);
            let triangles = self.topology.triangles() as u32;
            done.collapses.push(Collapse { end, error, distance, triangles });
            queue.set(point, None);
            for &(other, is_changed) in &surroundings {
                // The others' triangles are as they were, so are their costs; what was illegal may be legal now.
                if is_changed || queue.best(other).is_none_or(|best| best.is_second) {
                    queue.set(other, self.find(other));
                }
            }
        }
    }

    /// Who neighbours a point that is about to become another, whether its triangles change, and that other.
    fn look_around(&mut self, [point, neighbor]: [u32; 2], surroundings: &mut Vec<(u32, bool)>) {
        surroundings.clear();
        surroundings.push((neighbor, true));
        let marks = &mut self.marks[0];
        marks.clear();
        [point, neighbor].iter().for_each(|known| marks.set(*known, 0));
        for (around, is_changed) in [(point, true), (neighbor, false)] {
            for spoke in self.topology.spokes(around) {
                for other in [spoke.next.point, spoke.last.point] {
                    if marks.insert(other) {
                        surroundings.push((other, is_changed));
                    }
                }
            }
        }
    }

    /// The cheapest of a point's collapses, legal or not; the lower neighbour of two.
    fn find(&mut self, point: u32) -> Option<Best> {
        if self.topology.kind(point) == Kind::Locked {
            return None;
        }
        self.neighbors.look(&self.topology, point, &mut self.marks);
        let mut best: Option<Best> = None;
        for neighbor in self.neighbors.all() {
            let most = best.map_or(f64::INFINITY, |best| best.cost);
            let is_lower = best.is_some_and(|best| neighbor.point < best.neighbor);
            // The next number, so that an equal cost is told too.
            let Some(cost) = self.cost(point, neighbor, if is_lower { most.next_up() } else { most }) else {
                continue;
            };
            best = Some(Best { neighbor: neighbor.point, cost, is_second: false });
        }
        best
    }

    /// The cheapest that is legal as things are.
    fn find_legal(&mut self, point: u32) -> Option<Best> {
        self.neighbors.look(&self.topology, point, &mut self.marks);
        let costs = self.neighbors.all().iter();
        let mut all: Vec<(u64, u32)> = costs
            .filter_map(|neighbor| {
                let cost = self.cost(point, neighbor, f64::INFINITY)?;
                Some((cost.to_bits(), neighbor.point))
            })
            .collect();
        all.sort_unstable();
        let (cost, neighbor) = all.into_iter().find(|(_, neighbor)| self.is_legal(point, *neighbor))?;
        Some(Best { neighbor, cost: f64::from_bits(cost), is_second: true })
    }

    /// Of a collapse to one of the neighbours last looked at; none where it is not below `most`.
    fn cost(&self, point: u32, neighbor: &Neighbor, most: f64) -> Option<f64> {
        match &self.quadrics {
            Some(quadrics) => quadrics.cost(&self.points, &self.neighbors, point, neighbor, most),
            None => melax::cost(&self.topology, &self.points, [point, neighbor.point], most),
        }
    }

    fn is_legal(&mut self, point: u32, neighbor: u32) -> bool {
        let differ = match self.cost {
            Cost::Melax { check_normals: true } => {
                melax::differ(&self.topology, &self.points, [point, neighbor])
            }
            Cost::Melax { check_normals: false } | Cost::Quadric => false,
        };
        !differ
            && self.topology.keeps_topology(point, neighbor, &mut self.marks[0])
            && !turns_any(&self.topology, &self.points, point, neighbor)
            && self
                .attached
                .as_mut()
                .is_none_or(|attached| attached.keeps_near(&self.topology, &self.points, point, neighbor))
    }

    /// A point becomes its neighbour: all its vertices, those too that have no triangles any more.
    fn collapse(&mut self, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        let start = moved.len();
        self.neighbors.look(&self.topology, point, &mut self.marks);
        if let Some(to) = self.neighbors.all().iter().find(|other| other.point == neighbor) {
            for wedge in self.neighbors.wedges() {
                let heir = match &self.quadrics {
                    Some(quadrics) => quadrics.heir(&self.points, &self.neighbors, point, to, wedge).0,
                    None => self.neighbors.heirs(to, wedge).into_iter().next().unwrap_or(wedge.vertex),
                };
                moved.push([wedge.vertex, heir]);
            }
        }
        let live = moved.len();
        if let Some(attached) = &mut self.attached {
            attached.collapse(&self.topology, point);
        }
        self.topology.collapse(point, neighbor, &moved[start..]);
        if let Some(quadrics) = &mut self.quadrics {
            quadrics.merge(&self.points, point, neighbor, &moved[start..]);
        }
        let heir = moved[start][1];
        for &wedge in self.points.wedges(point) {
            if !moved[start..live].iter().any(|[from, _]| *from == wedge) {
                moved.push([wedge, heir]);
            }
        }
    }
}
