//! Search for the next collapse: the cheapest collapse of each point, and whether it is legal.

use super::super::bridged::bridged;
use super::super::melax;
use super::super::neighbors::{Neighbor, Neighbors};
use super::super::queue::Best;
use super::super::topology::Kind;
use super::super::turned::deviation;
use super::{Cost, Reducer, Stopped};

/// Weight of the largest squared distance between a point and the planes of its triangles after a collapse. The cost is
/// at least this term, because a mean of squares over many triangles hides a large error at a single spot. Found by
/// trial on twelve meshes, eight of them third-party. With half the weight, the largest errors grow on models of many
/// hard-edged parts.
const DEVIATION: f64 = 1.0 / 8.0;

/// Weight of the same squared distance as [`DEVIATION`], for surfaces with attributes. This term is added to the cost:
/// attribute costs are mostly larger, so the maximum of both would hide a large error at a single spot. Found by trial:
/// a larger weight degrades normals.
const BESIDE_ATTRIBUTES: f64 = 0.4;

/// Weight of the squared distance between the middle of a new edge and the previous triangles. Used only if there are
/// attributes. The larger of this term and the term of [`BESIDE_ATTRIBUTES`] is added to the cost. Found by trial on
/// the twelve meshes of [`DEVIATION`]: with half the weight, the largest errors grow on some of them. Without
/// attributes, this term gains nothing.
const BRIDGED: f64 = 1.6;

/// Largest number of a point's collapses that are tested if distances are limited. The cheapest are tested first. If
/// all of them are refused, the others hardly ever pass. A point such as the pole of a sphere has hundreds of
/// collapses.
const TESTED: usize = 12;

/// A candidate collapse that is not the point's cheapest.
fn second(cost: f32, neighbor: u32) -> Best {
    Best { neighbor, cost, base: cost, is_second: true, is_measured: false }
}

impl Reducer<'_> {
    /// Cheapest collapse of a point, legal or not. Among equal costs, the collapse into the neighbour with the lower
    /// index.
    pub(super) fn find(&mut self, point: u32) -> Option<Best> {
        if self.topology.kind(point) == Kind::Locked {
            return None;
        }
        self.find_plain(point).or_else(|| self.find_any(point))
    }

    /// Fast version of [`Self::find`]. `None` if the point is on a border, or if the point or a neighbour has several
    /// vertices.
    fn find_plain(&self, point: u32) -> Option<Best> {
        let quadrics = self.quadrics.as_ref().filter(|_| self.topology.kind(point) == Kind::Interior)?;
        let vertex = self.points.only_wedge(point)?;
        let (cost, neighbor) = quadrics.cheapest(&self.points, [point, vertex], self.topology.ring(point))?;
        Some(Best { neighbor, cost, base: cost, is_second: false, is_measured: false })
    }

    /// Collects the neighbours of a point, and prepares the costs of collapsing into them.
    fn look(&mut self, point: u32) {
        self.neighbors.look(&self.topology, &self.points, point, &mut self.marks);
        if let Some(quadrics) = &mut self.quadrics {
            quadrics.join(&self.points, &self.neighbors);
        }
    }

    fn find_any(&mut self, point: u32) -> Option<Best> {
        self.look(point);
        let mut best: Option<(f32, u32)> = None;
        for neighbor in self.neighbors.all() {
            let most = best.map_or(f32::INFINITY, |(cost, _)| cost);
            let cost = self.cost(point, neighbor, most);
            if best.is_none_or(|best| (cost.to_bits(), neighbor.point) < (best.0.to_bits(), best.1)) {
                best = Some((cost, neighbor.point));
            }
        }
        best.map(|(cost, neighbor)| Best { neighbor, cost, base: cost, is_second: false, is_measured: false })
    }

    /// Lists the costs of all collapses of a point in `costs`, in ascending order.
    fn list(&mut self, point: u32) {
        if self.listed == Some(point) {
            return;
        }
        self.look(point);
        let mut costs = std::mem::take(&mut self.costs);
        costs.clear();
        let all = self.neighbors.all().iter();
        let cost = |neighbor| self.cost(point, neighbor, f32::INFINITY).to_bits();
        costs.extend(all.map(|neighbor| (cost(neighbor), neighbor.point)));
        costs.sort_unstable();
        (self.costs, self.listed) = (costs, Some(point));
    }

    /// Most frequent reason why the remaining points cannot collapse; [`Stopped::Topology`] if no points remain.
    pub(super) fn hindrance(&mut self) -> Stopped {
        const REASONS: [Stopped; 5] =
            [Stopped::Topology, Stopped::Seams, Stopped::Borders, Stopped::Flips, Stopped::Distance];
        let mut counts = [0_usize; Stopped::Distance as usize + 1];
        for point in 0..self.points.len() as u32 {
            self.topology.refresh(point);
            if !self.topology.ring(point).is_empty() {
                counts[self.hindrance_of(point) as usize] += 1;
            }
        }
        // Among equally frequent reasons, the first in `REASONS` is taken.
        let mut most = Stopped::Topology;
        for reason in REASONS {
            if counts[reason as usize] > counts[most as usize] {
                most = reason;
            }
        }
        most
    }

    /// Reason why the cheapest collapse of a point is illegal.
    fn hindrance_of(&mut self, point: u32) -> Stopped {
        if self.topology.kind(point) == Kind::Locked {
            return Stopped::Topology;
        }
        let Some(best) = self.find_any(point) else {
            return if self.neighbors.is_split() { Stopped::Seams } else { Stopped::Borders };
        };
        self.topology.refresh(best.neighbor);
        if !self.topology.keeps_topology(point, best.neighbor) {
            Stopped::Topology
        } else if self.measure(point, best).is_none() {
            Stopped::Flips
        } else {
            Stopped::Distance
        }
    }

    /// Cheapest currently legal collapse of a point. If distances are limited, testing a collapse takes longer than
    /// computing its cost. Costs are therefore listed once, and the collapses are tested in ascending order of cost.
    pub(super) fn find_legal(&mut self, point: u32) -> Option<Best> {
        if self.tracked_samples.is_none() {
            return self.find_turning_none(point);
        }
        self.list(point);
        let costs = std::mem::take(&mut self.costs);
        let mut best: Option<Best> = None;
        for &(cost, neighbor) in costs.iter().take(TESTED) {
            let candidate = second(f32::from_bits(cost), neighbor);
            if best.is_some_and(|best| best.cost <= candidate.cost) {
                break;
            }
            if let Some(checked) = self.check(point, candidate)
                && best.is_none_or(|best| checked.cost < best.cost)
            {
                best = Some(checked);
            }
        }
        self.costs = costs;
        best
    }

    /// As [`Self::find_legal`], for unlimited distances. Here, computing the cost of a collapse takes longer than
    /// testing it. Costs are therefore computed only for collapses that pass the tests.
    fn find_turning_none(&mut self, point: u32) -> Option<Best> {
        self.look(point);
        let neighbors = std::mem::take(&mut self.neighbors);
        let (mut best, mut first): (Option<Best>, usize) = (None, 0);
        for neighbor in neighbors.all() {
            let both = [point, neighbor.point];
            // Every neighbour is refreshed, even if it fails the next test. The time of a refresh affects the order of
            // a point's triangles, and thereby the order of equal costs.
            self.topology.refresh(neighbor.point);
            let Some(deviation) = deviation(&self.topology, &self.points, both, &mut first) else { continue };
            if !self.is_allowed(point, neighbor.point) {
                continue;
            }
            let most = best.map_or(f32::INFINITY, |best| best.cost);
            let cost = self.cost_of(&neighbors, point, neighbor, most);
            let checked = self.with_deviation(point, second(cost, neighbor.point), deviation, most);
            let order = |best: &Best| (best.cost.to_bits(), best.base.to_bits(), best.neighbor);
            if best.is_none_or(|best| order(&checked) < order(&best)) {
                best = Some(checked);
            }
        }
        self.neighbors = neighbors;
        best
    }

    /// Cost of a collapse into one of the neighbours in `self.neighbors`. If the cost exceeds `most`, a partial cost
    /// above `most` may be returned.
    fn cost(&self, point: u32, neighbor: &Neighbor, most: f32) -> f32 {
        self.cost_of(&self.neighbors, point, neighbor, most)
    }

    /// As [`Self::cost`], but for the given neighbours.
    fn cost_of(&self, neighbors: &Neighbors, point: u32, neighbor: &Neighbor, most: f32) -> f32 {
        let both = [point, neighbor.point];
        let cost = match &self.quadrics {
            Some(quadrics) => {
                let shape = quadrics.shape_cost(&self.points, both);
                // Slightly more than any value that rounds to `most`.
                let most = 1.000_001 * f64::from(most) - shape;
                shape + quadrics.attribute_cost(&self.points, neighbors, point, neighbor, most)
            }
            None => melax::cost(&self.topology, &self.points, both),
        };
        cost as f32
    }

    /// The collapse with its complete cost; `None` if it is illegal.
    pub(super) fn check(&mut self, point: u32, best: Best) -> Option<Best> {
        if self.is_allowed(point, best.neighbor) { self.measure(point, best) } else { None }
    }

    /// Whether a collapse meets three conditions. The topology is kept. Every mesh still has a triangle at each point
    /// where it had one. All samples stay within the distance limit. For [`Cost::Melax`] with `check_normals`, the
    /// normals must also be similar.
    pub(super) fn is_allowed(&mut self, point: u32, neighbor: u32) -> bool {
        self.topology.refresh(neighbor);
        let differ = match self.cost {
            Cost::Melax { check_normals: true } => {
                melax::differ(&self.topology, &self.points, [point, neighbor])
            }
            Cost::Melax { check_normals: false } | Cost::Quadric => false,
        };
        !differ
            && self.topology.keeps_topology(point, neighbor)
            && self.topology.keeps_meshes(point, neighbor)
            && self.tracked_samples.as_mut().is_none_or(|tracked_samples| {
                tracked_samples.keeps_near(&self.topology, &self.points, point, neighbor)
            })
    }

    /// The collapse with its complete cost. The cost includes the point's distance from the planes of its triangles.
    /// With attributes, it also includes the distance of new edges from the previous triangles. `None` if the collapse
    /// turns a triangle too far.
    pub(super) fn measure(&self, point: u32, best: Best) -> Option<Best> {
        deviation(&self.topology, &self.points, [point, best.neighbor], &mut 0)
            .map(|deviation| self.with_deviation(point, best, deviation, f32::INFINITY))
    }

    /// The collapse with its complete cost. `deviation` is the squared distance of the point from the planes of its
    /// triangles. If the cost exceeds `most`, a partial cost above `most` may be returned.
    fn with_deviation(&self, point: u32, best: Best, deviation: f64, most: f32) -> Best {
        let cost = |more: f64| best.base + more as f32;
        let cost = match &self.quadrics {
            None => cost(0.0),
            Some(quadrics) if quadrics.has_attributes() => match cost(BESIDE_ATTRIBUTES * deviation) {
                part if part > most => part,
                _ => {
                    let (both, least) = ([point, best.neighbor], BESIDE_ATTRIBUTES / BRIDGED * deviation);
                    cost(BRIDGED * bridged(&self.topology, &self.points, both, least))
                }
            },
            Some(_) => cost((DEVIATION * deviation - f64::from(best.base)).max(0.0)),
        };
        Best { cost, is_measured: true, ..best }
    }
}
