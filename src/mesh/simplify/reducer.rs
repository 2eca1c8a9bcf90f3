//! The main loop of simplification: one collapse after the other.

mod search;

use super::neighbors::Neighbors;
use super::points::Points;
use super::quadrics::Quadrics;
use super::queue::{Best, Queue};
use super::topology::{Kind, Marks, Topology};
use super::tracked_samples::TrackedSamples;
use super::{Collapse, Cost, Options, Simplified, Stopped, Surface};

/// The state of a mesh that is being simplified.
struct Reducer<'a> {
    points: Points,
    topology: Topology,
    cost: Cost,
    /// Only for [`Cost::Quadric`].
    quadrics: Option<Quadrics<'a>>,
    /// Only where distances are limited.
    tracked_samples: Option<TrackedSamples>,
    neighbors: Neighbors,
    /// Marks for points, and for vertices.
    marks: [Marks; 2],
    /// The points whose triangles the last collapse changed.
    changed: Vec<u32>,
}

/// Collapses until a limit of `options` is reached, within one distance after the other.
pub(crate) fn reduce(
    surface: &Surface<'_>,
    points: Points,
    topology: Topology,
    options: &Options,
    distances: &[f32],
) -> Simplified {
    let triangles = topology.triangles();
    let is_limited = distances.iter().any(|distance| *distance < f32::INFINITY);
    let mut reducer = Reducer::new(surface, points, topology, options.cost, is_limited);
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

/// The collapses so far.
#[derive(Default)]
struct Done {
    collapses: Vec<Collapse>,
    moved: Vec<[u32; 2]>,
    error: f32,
}

impl<'a> Reducer<'a> {
    fn new(surface: &Surface<'a>, points: Points, topology: Topology, cost: Cost, is_limited: bool) -> Self {
        let quadrics = match cost {
            Cost::Quadric => Some(Quadrics::new(surface, &points, &topology)),
            Cost::Melax { .. } => None,
        };
        let tracked_samples =
            is_limited.then(|| TrackedSamples::new(&topology, &points, surface.indices.len() / 3));
        let marks = [points.len(), surface.poses[0].len()].map(Marks::new);
        let (neighbors, changed) = (Neighbors::default(), Vec::new());
        Self { points, topology, cost, quadrics, tracked_samples, neighbors, marks, changed }
    }

    /// Collapses until no legal collapse keeps every sample within `distance`, or until a limit of `options` is
    /// reached.
    fn run(&mut self, options: &Options, distance: f32, done: &mut Done) -> Stopped {
        if let Some(tracked_samples) = &mut self.tracked_samples {
            tracked_samples.set_most(distance);
        }
        let mut queue = self.queue();
        loop {
            if self.topology.triangles() <= options.triangles {
                return Stopped::Triangles;
            }
            let Some((point, best)) = self.next(&mut queue) else { return Stopped::Exhausted };
            let cost = best.cost.sqrt() as f32;
            if cost > options.error {
                return Stopped::Error;
            }
            done.error = done.error.max(cost);
            self.step(&mut queue, point, best.neighbor, &mut done.moved);
            let (error, end) = (done.error, done.moved.len() as u32);
            let triangles = self.topology.triangles() as u32;
            done.collapses.push(Collapse { end, error, distance, triangles });
        }
    }

    fn queue(&mut self) -> Queue {
        Queue::new((0..self.points.len() as u32).map(|point| self.find(point)).collect())
    }

    /// The cheapest legal collapse.
    fn next(&mut self, queue: &mut Queue) -> Option<(u32, Best)> {
        loop {
            let (point, best) = queue.pop()?;
            if self.is_legal(point, best.neighbor) {
                return Some((point, best));
            }
            queue.set(point, self.find_legal(point));
        }
    }

    /// Performs a collapse, and updates the best collapses of the points around it.
    fn step(&mut self, queue: &mut Queue, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        let mut changed = std::mem::take(&mut self.changed);
        self.collect(&[point], &mut changed);
        self.collapse(point, neighbor, moved);
        queue.set(point, None);
        for &other in &changed {
            let before = queue.best(other).copied();
            let now = match before {
                Some(before) if other != neighbor && self.is_plain(other, point, &before) => {
                    self.nearer(other, neighbor, before)
                }
                _ => self.find(other),
            };
            if now != before {
                queue.set(other, now);
            }
        }
        if self.cost == (Cost::Melax { check_normals: true }) || self.tracked_samples.is_some() {
            self.wake(queue, &changed);
        }
        self.changed = changed;
    }

    /// Reconsiders the neighbours of changed points. Normals of points have changed, and so have the triangles
    /// to which samples may be assigned; a collapse of a neighbour that was refused before may be legal now.
    /// For points whose own triangles are unchanged, nothing else can become legal: their triangles turn as
    /// before, and the set of points that neighbour both ends of an edge can only grow.
    fn wake(&mut self, queue: &mut Queue, changed: &[u32]) {
        let mut around = Vec::new();
        self.collect(changed, &mut around);
        for other in around {
            if queue.best(other).is_none_or(|best| best.is_second) {
                queue.set(other, self.find(other));
            }
        }
    }

    /// Whether the best collapse of `point` is still valid and its other costs are unchanged, except the cost
    /// of collapsing into the neighbour that replaced `collapsed`.
    fn is_plain(&self, point: u32, collapsed: u32, best: &Best) -> bool {
        self.quadrics.as_ref().is_some_and(|quadrics| !quadrics.has_attributes())
            && self.topology.kind(point) == Kind::Interior
            && self.points.wedges(point).len() == 1
            && !best.is_second
            && best.neighbor != collapsed
    }

    /// Collects the neighbours of some points, each once.
    fn collect(&mut self, points: &[u32], around: &mut Vec<u32>) {
        around.clear();
        let marks = &mut self.marks[0];
        marks.clear();
        for ring in points.iter().flat_map(|point| self.topology.one_ring(*point)) {
            for other in [ring.next.point, ring.last.point] {
                if marks.insert(other) {
                    around.push(other);
                }
            }
        }
    }

    /// Merges a point into its neighbour: all its vertices, including those that no longer belong to a
    /// triangle.
    fn collapse(&mut self, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        let start = moved.len();
        self.neighbors.look(&self.topology, point, &mut self.marks);
        if let Some(to) = self.neighbors.all().iter().find(|other| other.point == neighbor) {
            for wedge in self.neighbors.wedges() {
                let target = match &self.quadrics {
                    Some(quadrics) => quadrics.target(&self.points, &self.neighbors, point, to, wedge).0,
                    None => self.neighbors.remap(to, wedge).into_iter().next().unwrap_or(wedge.vertex),
                };
                moved.push([wedge.vertex, target]);
            }
        }
        let live = moved.len();
        if let Some(tracked_samples) = &mut self.tracked_samples {
            tracked_samples.collapse(&self.topology, &self.points, point, neighbor);
        }
        self.topology.collapse(point, neighbor, &moved[start..]);
        if let Some(quadrics) = &mut self.quadrics {
            quadrics.merge(&self.points, point, neighbor, &moved[start..]);
        }
        let target = moved[start][1];
        for &wedge in self.points.wedges(point) {
            if !moved[start..live].iter().any(|[from, _]| *from == wedge) {
                moved.push([wedge, target]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cylinder with a seam and with bumps of the given height, in two poses: straight and bent.
    fn pipe(bumps: f32, seed: usize) -> ([Vec<[f32; 3]>; 2], Vec<f32>, Vec<u32>) {
        let (sides, rings) = (9, 8);
        let (mut positions, mut uv, mut indices) = ([Vec::new(), Vec::new()], Vec::new(), Vec::new());
        for ring in 0..=rings {
            for side in 0..=sides {
                let turn = std::f32::consts::TAU * (side % sides) as f32 / sides as f32;
                let along = ring as f32 * 0.5;
                let bump = ((side % sides) * (ring + 2) * (5 + seed) + ring * seed * seed) % 7;
                let radius = 1.0 + bumps * bump as f32;
                let [x, z] = [radius * turn.cos(), -radius * turn.sin()];
                positions[0].push([x, along, z]);
                positions[1].push([x + 0.2 * along * along, along, z]);
                uv.extend([side as f32 / sides as f32, along]);
            }
        }
        for ring in 0..rings {
            for side in 0..sides {
                let [a, b] = [0, 1].map(|up| ((ring + up) * (sides + 1) + side) as u32);
                indices.extend([a, a + 1, b + 1, a, b + 1, b]);
            }
        }
        (positions, uv, indices)
    }

    /// Simplifies until nothing is legal. Returns the number of steps, and how often the collapse taken was not
    /// the cheapest of its point.
    fn check(cost: Cost, surface: &Surface<'_>, distance: f32) -> [usize; 2] {
        let points = Points::new(surface.poses);
        let topology = Topology::new(&points, surface.indices);
        let mut reducer = Reducer::new(surface, points, topology, cost, distance < f32::INFINITY);
        reducer.tracked_samples.iter_mut().for_each(|tracked_samples| tracked_samples.set_most(distance));
        let mut queue = reducer.queue();
        let (mut moved, mut seconds, mut steps) = (Vec::new(), 0, 0);
        while let Some((point, best)) = reducer.next(&mut queue) {
            let all = 0..reducer.points.len() as u32;
            let all = all.filter_map(|point| Some((reducer.find_legal(point)?, point)));
            let cheapest = all.min_by(|a, b| a.0.cost.total_cmp(&b.0.cost).then(a.1.cmp(&b.1)));
            let cheapest = cheapest.map(|(best, point)| (point, best.neighbor, best.cost));
            assert_eq!(cheapest, Some((point, best.neighbor, best.cost)), "{cost:?} after {steps}");
            seconds += usize::from(best.is_second);
            steps += 1;
            reducer.step(&mut queue, point, best.neighbor, &mut moved);
        }
        assert!((0..reducer.points.len() as u32).all(|point| reducer.find_legal(point).is_none()));
        [steps, seconds]
    }

    /// The queue always returns the cheapest of all legal collapses, as a full search finds it.
    #[test]
    fn the_cheapest_legal_collapse_is_always_next() {
        for (cost, distance) in [
            (Cost::Quadric, f32::INFINITY),
            (Cost::Quadric, 0.25),
            (Cost::Quadric, 0.12),
            (Cost::Quadric, 0.5),
            (Cost::Melax { check_normals: false }, f32::INFINITY),
            (Cost::Melax { check_normals: true }, f32::INFINITY),
        ] {
            let mut sums = [0, 0];
            for seed in 0..6 {
                let (positions, uv, indices) = pipe([0.03, 0.2][seed % 2], seed);
                let surface = Surface { poses: &positions, indices: &indices, attributes: &[], stride: 0 };
                let first = Surface { poses: &positions[..1], attributes: &uv, stride: 2, ..surface };
                for [steps, seconds] in [surface, first].map(|surface| check(cost, &surface, distance)) {
                    sums = [sums[0] + steps, sums[1] + seconds];
                }
            }
            let [steps, seconds] = sums;
            assert!(steps > 200 && seconds > 5, "{cost:?} within {distance}: {steps}, {seconds}");
        }
    }
}
