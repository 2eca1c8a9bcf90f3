//! The main loop of simplification: one collapse after the other.

mod search;

use super::marks::Marks;
use super::neighbors::Neighbors;
use super::points::Points;
use super::quadrics::Quadrics;
use super::queue::{Best, Queue};
use super::topology::{Change, Kind, Topology};
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
    /// Points for which a cheaper collapse than the queue's may become legal when triangles around them change.
    watched: Vec<bool>,
    /// Marks for points, and for vertices.
    marks: [Marks; 2],
    /// The points whose triangles the last collapse changed.
    changed: Vec<u32>,
}

/// Collapses until a limit of `options` is reached, within one distance after the other.
pub(crate) fn reduce(surface: &Surface<'_>, options: &Options, distances: &[f32]) -> Simplified {
    let is_limited = distances.iter().any(|distance| *distance < f32::INFINITY);
    let mut reducer = Reducer::new(surface, options.cost, is_limited);
    let triangles = reducer.topology.triangles();
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
    fn new(surface: &Surface<'a>, cost: Cost, is_limited: bool) -> Self {
        let points = Points::new(surface.poses);
        let topology = Topology::new(&points, surface.indices, is_limited);
        let quadrics = match cost {
            Cost::Quadric => Some(Quadrics::new(surface, &points, &topology)),
            Cost::Melax { .. } => None,
        };
        let tracked_samples =
            is_limited.then(|| TrackedSamples::new(&topology, &points, surface.indices.len() / 3));
        let marks = [points.len(), surface.poses[0].len()].map(Marks::new);
        let (neighbors, changed, watched) = (Neighbors::default(), Vec::new(), vec![false; points.len()]);
        Self { points, topology, cost, quadrics, tracked_samples, neighbors, watched, marks, changed }
    }

    /// Collapses until no legal collapse keeps every sample within `distance`, or until a limit of `options` is
    /// reached.
    fn run(&mut self, options: &Options, distance: f32, done: &mut Done) -> Stopped {
        if let Some(tracked_samples) = &mut self.tracked_samples {
            tracked_samples.set_most((f64::from(distance) * self.points.scale()) as f32);
        }
        let mut queue = self.queue();
        loop {
            if self.topology.triangles() <= options.triangles {
                return Stopped::Triangles;
            }
            let Some((point, best)) = self.next(&mut queue) else { return Stopped::Exhausted };
            let cost = (f64::from(best.cost).sqrt() / self.points.scale()) as f32;
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
        let mut queue = Queue::new(self.points.len(), self.points.extent());
        (0..self.points.len() as u32).for_each(|point| self.set(&mut queue, point));
        queue
    }

    /// Finds the best collapse of a point anew.
    fn set(&mut self, queue: &mut Queue, point: u32) {
        self.topology.refresh(point);
        self.topology.take_change(point);
        let best = self.find(point);
        self.watched[point as usize] = best.is_none();
        queue.set(point, best);
    }

    /// The cheapest legal collapse, up to the width of the queue's buckets.
    fn next(&mut self, queue: &mut Queue) -> Option<(u32, Best)> {
        loop {
            self.fetch(queue);
            let (point, queued) = queue.pop()?;
            self.topology.refresh(point);
            let mut best = queued;
            if self.is_outdated(point, &queued) {
                let found = self.find(point);
                self.watched[point as usize] = found.is_none();
                let Some(found) = found else { continue };
                best = found;
            }
            if !queue.is_later(&best, &queued) {
                match self.check(point, best) {
                    None => {
                        self.watched[point as usize] = true;
                        let second = self.find_legal(point);
                        queue.set(point, second);
                        continue;
                    }
                    Some(checked) => best = checked,
                }
            }
            if !queue.is_later(&best, &queued) {
                return Some((point, best));
            }
            queue.set(point, Some(best));
        }
    }

    /// Whether the best collapse of a point, all of whose triangles are up to date, must be found anew. Where it is not
    /// merged into, its other costs have not changed, and a new neighbour is hardly ever cheaper than the best old one.
    fn is_outdated(&mut self, point: u32, best: &Best) -> bool {
        match self.topology.take_change(point) {
            Change::None => false,
            Change::Around if self.quadrics.is_some() && self.topology.kind(point) == Kind::Interior => {
                self.topology.is_gone(best.neighbor) || self.points.only_wedge(point).is_none()
            }
            Change::Around | Change::Merged => true,
        }
    }

    /// Reads what the next few points need, so that the processor waits for all of it at once: points that follow each
    /// other in cost lie anywhere.
    fn fetch(&self, queue: &Queue) {
        let mut read = 0;
        for &point in queue.ahead() {
            read ^= self.topology.touch(point);
            read ^= self.quadrics.as_ref().map_or(0, |quadrics| quadrics.touch(&self.points, point)) as u32;
            for &[other, _] in self.topology.ring(point) {
                read ^= self.points.touch(other);
            }
            if let Some(best) = queue.best(point) {
                read ^= self.topology.touch(best.neighbor);
                read ^=
                    self.quadrics.as_ref().map_or(0, |quadrics| quadrics.touch(&self.points, best.neighbor))
                        as u32;
            }
        }
        std::hint::black_box(read);
    }

    /// Performs a collapse, and updates the best collapses of the points around it.
    fn step(&mut self, queue: &mut Queue, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        let mut changed = std::mem::take(&mut self.changed);
        self.collect(point, &mut changed);
        self.collapse(point, neighbor, moved);
        for &other in &changed {
            // Melax's costs fall as well as rise when triangles around a point change.
            if self.watched[other as usize] || self.quadrics.is_none() {
                self.set(queue, other);
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
        changed.iter().for_each(|point| self.topology.refresh(*point));
        let marks = &mut self.marks[0];
        marks.clear();
        let all = changed.iter().flat_map(|point| self.topology.ring(*point)).flatten();
        around.extend(all.copied().filter(|other| marks.insert(*other)));
        for other in around {
            if self.watched[other as usize] {
                self.set(queue, other);
            }
        }
    }

    /// Collects the neighbours of a point, each once.
    fn collect(&self, point: u32, around: &mut Vec<u32>) {
        around.clear();
        let ring = self.topology.ring(point);
        around.extend(ring.iter().map(|[next, _]| *next));
        if self.topology.kind(point) != Kind::Interior {
            let first = |last: &u32| ring.iter().all(|[next, _]| next != last);
            around.extend(ring.iter().map(|[_, last]| *last).filter(first));
        }
    }

    /// Lists the vertices of a point that belong to triangles, each with the one that is to replace it.
    fn replace(&mut self, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        if let [Some(vertex), Some(target)] = [point, neighbor].map(|point| self.points.only_wedge(point)) {
            moved.push([vertex, target]);
            return;
        }
        self.neighbors.look(&self.topology, point, &mut self.marks);
        let Some(to) = self.neighbors.all().iter().find(|other| other.point == neighbor) else { return };
        for wedge in self.neighbors.wedges() {
            let target = match &self.quadrics {
                Some(quadrics) => quadrics.target(&self.points, &self.neighbors, point, to, wedge).0,
                None => self.neighbors.remap(to, wedge).into_iter().next().unwrap_or(wedge.vertex),
            };
            moved.push([wedge.vertex, target]);
        }
    }

    /// Merges a point into its neighbour: all its vertices, including those that no longer belong to a
    /// triangle.
    fn collapse(&mut self, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        let start = moved.len();
        self.replace(point, neighbor, moved);
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

    /// The cost of the collapse of a point if it were its turn.
    fn now(reducer: &mut Reducer<'_>, point: u32) -> Option<f32> {
        reducer.topology.refresh(point);
        let found = reducer.find(point)?;
        let checked = reducer.check(point, found).or_else(|| reducer.find_legal(point));
        checked.map(|best| best.cost)
    }

    /// Simplifies until nothing is legal, and compares each collapse with those of all other points. Returns the number of
    /// steps, how often the collapse was more than a tenth above the cheapest, and how often it was not the cheapest of
    /// its point.
    fn check(cost: Cost, surface: &Surface<'_>, distance: f32) -> [usize; 3] {
        let mut reducer = Reducer::new(surface, cost, distance < f32::INFINITY);
        let most = (f64::from(distance) * reducer.points.scale()) as f32;
        reducer.tracked_samples.iter_mut().for_each(|tracked_samples| tracked_samples.set_most(most));
        let mut queue = reducer.queue();
        let (mut moved, [mut steps, mut dearer, mut seconds]) = (Vec::new(), [0; 3]);
        let find = |reducer: &mut Reducer<'_>, point: u32| {
            reducer.topology.refresh(point);
            reducer.find_legal(point)
        };
        while let Some((point, best)) = reducer.next(&mut queue) {
            let all = 0..reducer.points.len() as u32;
            let costs = all.clone().filter_map(|point| Some(find(&mut reducer, point)?.cost));
            assert!(best.cost >= costs.fold(f32::INFINITY, f32::min), "{cost:?} after {steps}");
            let cheapest = all.filter_map(|point| now(&mut reducer, point)).fold(f32::INFINITY, f32::min);
            dearer += usize::from(best.cost.sqrt() > 1.1 * cheapest.sqrt() + 1e-6);
            seconds += usize::from(best.is_second);
            steps += 1;
            reducer.step(&mut queue, point, best.neighbor, &mut moved);
        }
        assert!(
            (0..reducer.points.len() as u32).all(|point| find(&mut reducer, point).is_none()),
            "{cost:?}"
        );
        [steps, dearer, seconds]
    }

    /// Collapses come in the order of their costs, up to the width of a bucket and to what became cheaper since the queue
    /// last looked; nothing that is legal is left.
    #[test]
    fn a_cheapest_legal_collapse_is_nearly_always_next() {
        for (cost, distance) in [
            (Cost::Quadric, f32::INFINITY),
            (Cost::Quadric, 0.25),
            (Cost::Quadric, 0.12),
            (Cost::Quadric, 0.5),
            (Cost::Melax { check_normals: false }, f32::INFINITY),
            (Cost::Melax { check_normals: true }, f32::INFINITY),
        ] {
            let mut sums = [0; 3];
            for seed in 0..6 {
                let (positions, uv, indices) = pipe([0.03, 0.2][seed % 2], seed);
                let surface = Surface { poses: &positions, indices: &indices, attributes: &[], stride: 0 };
                let first = Surface { poses: &positions[..1], attributes: &uv, stride: 2, ..surface };
                for found in [surface, first].map(|surface| check(cost, &surface, distance)) {
                    sums = [0, 1, 2].map(|at| sums[at] + found[at]);
                }
            }
            let [steps, dearer, seconds] = sums;
            assert!(steps > 200 && seconds > 3, "{cost:?} within {distance}: {steps}, {seconds}");
            assert!(8 * dearer < steps, "{cost:?} within {distance}: {dearer} of {steps}");
        }
    }
}
