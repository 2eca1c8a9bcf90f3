//! Main loop of simplification: collapses points one after the other.

mod search;
#[cfg(test)]
mod tests;

use std::ops::ControlFlow;

use super::marks::Marks;
use super::neighbors::Neighbors;
use super::parts::Parts;
use super::points::Points;
use super::quadrics::Quadrics;
use super::queue::{Best, Queue};
use super::topology::{Change, Kind, Topology};
use super::tracked_samples::TrackedSamples;
use super::{Collapse, Cost, Groups, Seams, Simplified, SimplifyOptions, Stopped, Surface};

/// State of a mesh during simplification.
struct Reducer<'a> {
    points: Points,
    topology: Topology,
    cost: Cost,
    /// Quadrics; only for [`Cost::Quadric`].
    quadrics: Option<Quadrics<'a>>,
    /// Samples that measure distances; only if distances are limited.
    tracked_samples: Option<TrackedSamples>,
    neighbors: Neighbors,
    /// Parts that may vanish as a whole.
    parts: Parts,
    /// For each point, whether an illegal collapse is cheaper than the queued collapse. The illegal collapse may become
    /// legal when triangles around the point change.
    watched: Vec<bool>,
    /// Two sets of marks: for points, and for vertices.
    marks: [Marks; 2],
    /// Points whose triangles were changed by the last collapse.
    changed: Vec<u32>,
    /// Point whose collapses are listed in `costs`; `None` after a collapse.
    listed: Option<u32>,
    /// Costs of the listed point's collapses in ascending order, as bits, each with its neighbour.
    costs: Vec<(u32, u32)>,
}

/// Number of collapses between two progress reports.
const REPORT: usize = 256;

/// Simplifies within each of `distances` in turn, until a limit of `options` is reached. `watch` gets the fraction of
/// triangles removed so far, and can stop the simplification by returning `Break`.
pub(crate) fn reduce<B>(
    surface: &Surface<'_>,
    options: &SimplifyOptions,
    distances: &[f32],
    groups: &Groups<'_>,
    watch: &mut dyn FnMut(f64) -> ControlFlow<B>,
) -> ControlFlow<B, Simplified> {
    let is_limited = distances.iter().any(|distance| *distance < f32::INFINITY);
    let mut reducer = Reducer::new(surface, options, is_limited, groups);
    if options.prune && options.cost == Cost::Quadric && !is_limited {
        reducer.parts = Parts::new(&reducer.points, &reducer.topology);
    }
    let triangles = reducer.topology.triangles();
    let mut done = Done::default();
    let mut stopped = Stopped::Exhausted;
    let mut removed = |left: usize| watch(1.0 - left as f64 / triangles.max(1) as f64);
    for distance in distances {
        stopped = reducer.run(options, *distance, &mut done, &mut removed)?;
        if stopped != Stopped::Exhausted {
            break;
        }
    }
    if stopped == Stopped::Exhausted {
        stopped = reducer.hindrance();
    }
    let Done { collapses, moved, .. } = done;
    ControlFlow::Continue(Simplified {
        collapses,
        moved,
        points: reducer.points.into_of(),
        triangles,
        stopped,
    })
}

/// The collapses made so far.
#[derive(Default)]
struct Done {
    collapses: Vec<Collapse>,
    moved: Vec<[u32; 2]>,
    error: f32,
}

impl<'a> Reducer<'a> {
    fn new(surface: &Surface<'a>, options: &SimplifyOptions, is_limited: bool, groups: &Groups<'_>) -> Self {
        let cost = options.cost;
        let points = Points::new(surface.poses);
        let points = match options.seams {
            Seams::Held => points,
            Seams::AllCrossed => points.on_charts(surface.attributes, surface.stride, surface.stride),
            Seams::Crossed { attributes } => points.on_charts(surface.attributes, surface.stride, attributes),
        };
        let points = if groups.bodies.is_empty() { points } else { points.on_bodies(groups.bodies) };
        let topology = Topology::new(&points, surface.indices, groups.meshes, is_limited);
        let quadrics = match cost {
            Cost::Quadric => Some(Quadrics::new(surface, &points, &topology)),
            Cost::Melax { .. } => None,
        };
        let tracked_samples =
            is_limited.then(|| TrackedSamples::new(&topology, &points, surface.indices.len() / 3));
        let marks = [points.len(), surface.poses[0].len()].map(Marks::new);
        let (neighbors, changed, watched) = (Neighbors::default(), Vec::new(), vec![false; points.len()]);
        let (parts, listed, costs) = (Parts::default(), None, Vec::new());
        Self {
            points,
            topology,
            cost,
            quadrics,
            tracked_samples,
            neighbors,
            parts,
            watched,
            marks,
            changed,
            listed,
            costs,
        }
    }

    /// Makes collapses that keep every sample within `distance`, until no legal one is left or a limit of `options` is
    /// reached. `watch` gets the number of remaining triangles.
    fn run<B>(
        &mut self,
        options: &SimplifyOptions,
        distance: f32,
        done: &mut Done,
        watch: &mut dyn FnMut(usize) -> ControlFlow<B>,
    ) -> ControlFlow<B, Stopped> {
        if let Some(tracked_samples) = &mut self.tracked_samples {
            tracked_samples.set_most((f64::from(distance) * self.points.scale()) as f32);
        }
        let mut queue = self.queue();
        loop {
            if self.topology.triangles() <= options.triangles {
                return ControlFlow::Continue(Stopped::Triangles);
            }
            if done.collapses.len().is_multiple_of(REPORT) {
                watch(self.topology.triangles())?;
            }
            let next = self.next(&mut queue);
            let most = next.map_or(f32::INFINITY, |(_, best)| best.cost);
            let part = self.take_part(most);
            let squared = match (&part, next) {
                (Some((_, squared)), _) => *squared,
                (None, Some((_, best))) => best.cost,
                (None, None) => return ControlFlow::Continue(Stopped::Exhausted),
            };
            let cost = (f64::from(squared).sqrt() / self.points.scale()) as f32;
            if cost > options.error {
                return ControlFlow::Continue(Stopped::Error);
            }
            done.error = done.error.max(cost);
            if let Some((part, _)) = part {
                next.into_iter().for_each(|(point, best)| queue.set(point, Some(best)));
                self.vanish(&mut queue, &part, &mut done.moved);
            } else if let Some((point, best)) = next {
                self.step(&mut queue, point, best.neighbor, &mut done.moved);
            }
            let (error, end) = (done.error, done.moved.len() as u32);
            let triangles = self.topology.triangles() as u32;
            done.collapses.push(Collapse { end, error, distance, triangles });
        }
    }

    /// Takes a part that may vanish, if its cost is at most `most`. Returns the part's points and the cost.
    fn take_part(&mut self, most: f32) -> Option<(Vec<u32>, f32)> {
        let Self { parts, points, topology, quadrics, .. } = self;
        let lost = |part: &[u32]| quadrics.as_ref().map_or(0.0, |quadrics| quadrics.lost(points, part));
        parts.take(points, topology, lost, most)
    }

    /// Merges all points of a part into the first of them.
    fn vanish(&mut self, queue: &mut Queue, part: &[u32], moved: &mut Vec<[u32; 2]>) {
        let Some(target) = part.first().and_then(|first| self.points.wedges(*first).first()) else { return };
        for &point in part {
            queue.set(point, None);
            let vertices = self.points.wedges(point).iter().filter(|vertex| *vertex != target);
            moved.extend(vertices.map(|vertex| [*vertex, *target]));
        }
        self.topology.vanish(part);
    }

    fn queue(&mut self) -> Queue {
        let mut queue = Queue::new(self.points.len(), self.points.extent());
        (0..self.points.len() as u32).for_each(|point| self.set(&mut queue, point));
        queue
    }

    /// Recomputes the best collapse of a point, and puts it in the queue.
    fn set(&mut self, queue: &mut Queue, point: u32) {
        self.topology.refresh(point);
        self.topology.take_change(point);
        let mut best = self.find(point);
        self.watched[point as usize] = best.is_none();
        if let Some(found) = best.filter(|_| self.is_measured_early()) {
            best = self.measure(point, found);
            if best.is_none() {
                best = self.find_second(point);
            }
        }
        queue.set(point, best);
    }

    /// Whether the whole cost is measured before a point is queued. This is done if there are attributes. Measuring
    /// raises nearly every attribute cost, so a point measured later would have to be queued again.
    fn is_measured_early(&self) -> bool {
        self.quadrics.as_ref().is_some_and(Quadrics::has_attributes)
    }

    /// The cheapest legal collapse. Costs in the same bucket of the queue count as equal.
    fn next(&mut self, queue: &mut Queue) -> Option<(u32, Best)> {
        loop {
            self.fetch(queue);
            let (point, queued) = queue.pop()?;
            self.topology.refresh(point);
            let Some(best) = self.latest(point, queued) else { continue };
            if queue.is_later(&best, &queued) {
                queue.set(point, Some(best));
                continue;
            }
            let measured = if best.is_measured { Some(best) } else { self.measure(point, best) };
            match measured {
                Some(best) if queue.is_later(&best, &queued) => queue.set(point, Some(best)),
                Some(best) if self.is_allowed(point, best.neighbor) => return Some((point, best)),
                _ => {
                    let second = self.find_second(point);
                    queue.set(point, second);
                }
            }
        }
    }

    /// Best collapse of a point: the queued one if it is still valid, otherwise a new one. The point's triangles must
    /// be up to date.
    fn latest(&mut self, point: u32, queued: Best) -> Option<Best> {
        let change = self.topology.take_change(point);
        if self.is_outdated(point, &queued, change) {
            let found = self.find(point);
            self.watched[point as usize] = found.is_none();
            return found;
        }
        let is_measured = queued.is_measured && change == Change::None;
        Some(Best { is_measured, ..queued })
    }

    /// Cheapest legal collapse of a point whose cheapest collapse is illegal.
    fn find_second(&mut self, point: u32) -> Option<Best> {
        self.watched[point as usize] = true;
        self.find_legal(point)
    }

    /// Whether the best collapse of a point must be recomputed. The point's triangles must be up to date. If no other
    /// point was merged into this point, the costs of collapsing into its old neighbours have not changed. A new
    /// neighbour is hardly ever cheaper than the best old one.
    fn is_outdated(&self, point: u32, best: &Best, change: Change) -> bool {
        match change {
            Change::None => false,
            Change::Around if self.quadrics.is_some() && self.topology.kind(point) == Kind::Interior => {
                self.topology.is_gone(best.neighbor) || self.points.only_wedge(point).is_none()
            }
            Change::Around | Change::Merged => true,
        }
    }

    /// Prefetches the data of the next few points. Points with consecutive costs are scattered in memory. Reading them
    /// together lets the processor wait for all of them at once. Each round of reads yields the addresses for the next
    /// round.
    fn fetch(&self, queue: &Queue) {
        let (mut read, ahead) = (0, queue.ahead());
        let quadric = |point: u32| match &self.quadrics {
            Some(quadrics) => quadrics.touch(&self.points, point),
            None => 0,
        };
        for &point in ahead {
            read ^= queue.neighbor(point) ^ self.topology.touch_span(point) ^ quadric(point);
        }
        for &point in ahead {
            let neighbor = queue.neighbor(point);
            read ^= self.topology.touch(point) ^ self.topology.touch_span(neighbor) ^ quadric(neighbor);
        }
        for &point in ahead {
            read ^= self.topology.touch(queue.neighbor(point));
            for &[other, _] in self.topology.ring(point) {
                read ^= self.points.touch(other);
            }
        }
        std::hint::black_box(read);
    }

    /// Performs a collapse, and updates the best collapses of the surrounding points.
    fn step(&mut self, queue: &mut Queue, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        let mut changed = std::mem::take(&mut self.changed);
        self.collect(point, &mut changed);
        self.collapse(point, neighbor, moved);
        for &other in &changed {
            // Melax's costs may fall or rise when triangles around a point change.
            if self.watched[other as usize] || self.quadrics.is_none() {
                self.set(queue, other);
            }
        }
        if self.cost == (Cost::Melax { check_normals: true }) || self.tracked_samples.is_some() {
            self.wake(queue, &changed);
        }
        self.changed = changed;
    }

    /// Reconsiders the neighbours of changed points. The normals of changed points are new, and so are the triangles to
    /// which samples may be assigned. A refused collapse of a neighbour may therefore be legal now. For a point whose
    /// own triangles are unchanged, nothing else can make a collapse legal. Its triangles turn as before, and the ends
    /// of an edge can only gain common neighbours.
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

    /// Collects the neighbours of a point, without duplicates.
    fn collect(&self, point: u32, around: &mut Vec<u32>) {
        around.clear();
        let ring = self.topology.ring(point);
        around.extend(ring.iter().map(|[next, _]| *next));
        if self.topology.kind(point) != Kind::Interior {
            let first = |last: &u32| ring.iter().all(|[next, _]| next != last);
            around.extend(ring.iter().map(|[_, last]| *last).filter(first));
        }
    }

    /// Lists in `moved` the vertices of a point that are used by triangles, each with its replacement at the neighbour.
    fn replace(&mut self, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        if let [Some(vertex), Some(target)] = [point, neighbor].map(|point| self.points.only_wedge(point)) {
            moved.push([vertex, target]);
            return;
        }
        self.neighbors.look(&self.topology, &self.points, point, &mut self.marks);
        let Some(to) = self.neighbors.all().iter().find(|other| other.point == neighbor) else { return };
        for wedge in self.neighbors.wedges() {
            let target = match &self.quadrics {
                Some(quadrics) => quadrics.target(&self.points, &self.neighbors, point, to, wedge).0,
                None => self.neighbors.remap(to, wedge).into_iter().next().unwrap_or(wedge.vertex),
            };
            moved.push([wedge.vertex, target]);
        }
    }

    /// Merges a point into its neighbour. All vertices of the point are replaced, even those that no triangle uses any
    /// more.
    fn collapse(&mut self, point: u32, neighbor: u32, moved: &mut Vec<[u32; 2]>) {
        self.listed = None;
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
