//! Parts: sets of points that are connected by triangles. A part vanishes as a whole if its distance to the other parts
//! costs less than the next collapse.

mod tree;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::points::Points;
use super::topology::Topology;
use crate::mesh::nearest::precise_nearest_on_triangle;
use tree::Tree;

/// Weight of the squared distance between a part and the other parts. The square root of the cost is thus half of the
/// distance. A part vanishes slightly before collapses that move the surface by the part's distance.
const FACTOR: f64 = 0.25;

/// A part is first measured when the next collapse costs this fraction of the part's radius. By this time, most of its
/// own collapses have been made, and its few remaining triangles are measured quickly.
const FIRST: f64 = 0.25;

/// A set of points that are connected by triangles.
struct Part {
    /// The part's points. Points that have collapsed are dropped at each update.
    points: Vec<u32>,
    /// Points of vanished parts for which this part was the nearest.
    heritage: Vec<u32>,
    /// Bounding box of all points of the part, for each pose.
    boxes: Vec<[DVec3; 2]>,
    /// Value of [`Parts::round`] at the last update of `points`.
    updated: u64,
}

/// All parts of a mesh, and the search for the next part to vanish.
#[derive(Default)]
pub(crate) struct Parts {
    all: Vec<Part>,
    /// One bounding volume tree per pose.
    trees: Vec<Tree>,
    /// Queue of parts. Each entry has a lower bound on the part's cost (as bits), and the part.
    waiting: BinaryHeap<Reverse<(u32, u32)>>,
    /// Number of parts measured so far.
    round: u64,
    /// Pairs: a point of the measured part, and another part. The other part is the one nearest to the point, or near
    /// enough to end the search.
    heirs: Vec<[u32; 2]>,
    /// Stack of tree nodes that a search has not visited yet, each with its squared distance.
    open: Vec<(f64, u32)>,
}

impl Parts {
    pub(crate) fn new(points: &Points, topology: &Topology) -> Self {
        let all = connected(points.len(), topology);
        if all.len() < 2 {
            return Self::default();
        }
        let part =
            |of: Vec<u32>| Part { boxes: boxes(points, &of), points: of, heritage: Vec::new(), updated: 0 };
        let all: Vec<Part> = all.into_iter().map(part).collect();
        let radius = |part: &Part| {
            part.boxes.iter().map(|[low, high]| (*high - *low).length() * 0.5).fold(0.0, f64::max)
        };
        let first = |part: &Part| (radius(part) * FIRST).powi(2) as f32;
        let waiting = (0..).zip(&all).map(|(at, part)| Reverse((first(part).to_bits(), at))).collect();
        let in_pose = |pose: usize| all.iter().map(|part| part.boxes[pose]).collect::<Vec<_>>();
        let trees = (0..points.poses()).map(|pose| Tree::new(&in_pose(pose))).collect();
        Self { trees, all, waiting, round: 0, heirs: Vec::new(), open: Vec::new() }
    }

    /// Takes the part that vanishes at the smallest cost, if this cost is at most `most`. Returns the part's remaining
    /// points and the cost. `more` returns the additional cost of losing a part, which does not depend on its distance
    /// to other parts.
    pub(crate) fn take(
        &mut self,
        points: &Points,
        topology: &mut Topology,
        more: impl Fn(&[u32]) -> f64,
        most: f32,
    ) -> Option<(Vec<u32>, f32)> {
        loop {
            let Reverse((bits, part)) = *self.waiting.peek()?;
            let queued = f32::from_bits(bits);
            if queued > most {
                return None;
            }
            self.waiting.pop();
            self.round += 1;
            self.update(topology, part);
            let own = std::mem::take(&mut self.all[part as usize].points);
            let heritage = std::mem::take(&mut self.all[part as usize].heritage);
            let more = more(&own);
            // Square of twice the distance at which the cost is `most`. The search ends beyond this distance. The part
            // is queued with a cost far above `most`, so it is not measured again soon.
            let enough = (f64::from(most) - more).max(0.0) * 4.0 / FACTOR;
            let cost = (self.distance(points, topology, [&own, &heritage], enough) * FACTOR + more) as f32;
            let cost = queued.max(cost);
            let is_first = self.waiting.peek().is_none_or(|Reverse((next, _))| cost.to_bits() <= *next);
            if cost <= most && (is_first || cost == queued) && cost < f32::INFINITY {
                for tree in &mut self.trees {
                    tree.remove(part);
                }
                for [point, heir] in self.heirs.drain(..) {
                    self.all[heir as usize].heritage.push(point);
                }
                return Some((own, cost));
            }
            self.all[part as usize].points = own;
            self.all[part as usize].heritage = heritage;
            if cost < f32::INFINITY {
                self.waiting.push(Reverse((cost.to_bits(), part)));
            }
        }
    }

    /// Squared distance from the points `own` to the nearest remaining part: the largest over all points and poses.
    /// Infinite if no part remains. If the result exceeds `enough`, it may be smaller than the true value.
    fn distance(&mut self, points: &Points, topology: &mut Topology, own: [&[u32]; 2], enough: f64) -> f64 {
        let mut worst = 0.0_f64;
        for pose in 0..points.poses() {
            let mut hint = None;
            self.heirs.clear();
            for &point in own.into_iter().flatten() {
                let from = points.position(point, pose);
                let known = hint.map_or(f64::INFINITY, |part| {
                    self.nearest_in(points, topology, part, pose, from, f64::INFINITY)
                });
                // If this point is nearer to the other parts than an earlier point, it does not change the maximum.
                if known > worst {
                    let (nearest, part) = self.nearest(points, topology, pose, from, known, hint);
                    (worst, hint) = (worst.max(nearest), part);
                }
                if worst > enough {
                    return worst;
                }
                self.heirs.extend(hint.map(|heir| [point, heir]));
            }
        }
        worst
    }

    /// Squared distance from `from` to the nearest triangle of any remaining part, and the index of this part. `best`
    /// and `of` are the same two values for a part that is already measured, or infinity and `None`.
    fn nearest(
        &mut self,
        points: &Points,
        topology: &mut Topology,
        pose: usize,
        from: DVec3,
        mut best: f64,
        mut of: Option<u32>,
    ) -> (f64, Option<u32>) {
        let mut open = std::mem::take(&mut self.open);
        self.trees[pose].start(from, &mut open);
        while let Some(part) = self.trees[pose].next(from, best, &mut open) {
            let found = self.nearest_in(points, topology, part, pose, from, best);
            if found < best {
                (best, of) = (found, Some(part));
            }
        }
        self.open = open;
        (best, of)
    }

    /// Squared distance from `from` to a part, or `best` if `best` is smaller.
    fn nearest_in(
        &mut self,
        points: &Points,
        topology: &mut Topology,
        part: u32,
        pose: usize,
        from: DVec3,
        best: f64,
    ) -> f64 {
        let [low, high] = self.all[part as usize].boxes[pose];
        if from.clamp(low, high).distance_squared(from) >= best {
            return best;
        }
        self.update(topology, part);
        let mut nearest = best;
        for &point in &self.all[part as usize].points {
            for &[next, last] in topology.ring(point) {
                if point < next && point < last {
                    let corners = [point, next, last].map(|point| points.position(point, pose));
                    // Most triangles have a bounding box that is farther away than the nearest triangle so far.
                    if around(corners, from) < nearest {
                        let on = precise_nearest_on_triangle(from, corners);
                        nearest = nearest.min(on.distance_squared(from));
                    }
                }
            }
        }
        nearest
    }

    /// Drops the collapsed points of a part, and refreshes the remaining points. Done once per round.
    fn update(&mut self, topology: &mut Topology, part: u32) {
        let Part { points, updated, .. } = &mut self.all[part as usize];
        if std::mem::replace(updated, self.round) != self.round {
            points.retain(|point| !topology.is_gone(*point));
            points.iter().for_each(|point| topology.refresh(*point));
        }
    }
}

/// The points of each part, for all parts that have triangles.
fn connected(count: usize, topology: &Topology) -> Vec<Vec<u32>> {
    let mut is_known = vec![false; count];
    let mut parts = Vec::new();
    for first in 0..count as u32 {
        if is_known[first as usize] || topology.ring(first).is_empty() {
            continue;
        }
        is_known[first as usize] = true;
        let (mut part, mut at) = (vec![first], 0);
        while let Some(point) = part.get(at) {
            // Each triangle lists its points in a cycle, so following `next` alone reaches all of its points.
            for &[next, _] in topology.ring(*point) {
                if !std::mem::replace(&mut is_known[next as usize], true) {
                    part.push(next);
                }
            }
            at += 1;
        }
        parts.push(part);
    }
    parts
}

/// Squared distance from `from` to the bounding box of a triangle.
#[inline]
fn around([a, b, c]: [DVec3; 3], from: DVec3) -> f64 {
    from.clamp(a.min(b).min(c), a.max(b).max(c)).distance_squared(from)
}

/// Bounding box of a part's points, for each pose.
fn boxes(points: &Points, part: &[u32]) -> Vec<[DVec3; 2]> {
    let in_pose = |pose: usize| {
        let positions = || part.iter().map(|point| points.position(*point, pose));
        [positions().fold(DVec3::INFINITY, DVec3::min), positions().fold(DVec3::NEG_INFINITY, DVec3::max)]
    };
    (0..points.poses()).map(in_pose).collect()
}
