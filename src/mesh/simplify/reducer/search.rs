//! The search for the next collapse: the cheapest of each point, and whether it is legal.

use super::super::melax;
use super::super::neighbors::Neighbor;
use super::super::queue::Best;
use super::super::topology::Kind;
use super::super::turned::deviation;
use super::{Cost, Reducer};

/// How much the square of the distance counts by which a collapse leaves the point off the planes of its triangles, beside
/// the mean of squares, which hides a single spot among many triangles. Found by trial: with half of it the largest errors
/// grow on terrain and on closed shapes, with twice of it the mean ones.
const DEVIATION: f64 = 1.0 / 16.0;

/// As [`DEVIATION`], where attributes count too, and added to their cost: theirs is mostly larger, so that a maximum would
/// not see a spot that is off. Found by trial: with more of it normals suffer.
const BESIDE_ATTRIBUTES: f64 = 0.4;

impl Reducer<'_> {
    /// The cheapest collapse of a point, legal or not; of equal ones, that into the lower neighbour.
    pub(super) fn find(&mut self, point: u32) -> Option<Best> {
        if self.topology.kind(point) == Kind::Locked {
            return None;
        }
        self.find_plain(point).or_else(|| self.find_any(point))
    }

    /// As [`Self::find`], for points all of whose collapses are plain.
    fn find_plain(&self, point: u32) -> Option<Best> {
        let quadrics = self.quadrics.as_ref().filter(|_| self.topology.kind(point) == Kind::Interior)?;
        let vertex = self.points.only_wedge(point)?;
        let (cost, neighbor) = quadrics.cheapest(&self.points, [point, vertex], self.topology.ring(point))?;
        Some(Best { neighbor, cost, base: cost, is_second: false, is_measured: false })
    }

    fn find_any(&mut self, point: u32) -> Option<Best> {
        self.neighbors.look(&self.topology, point, &mut self.marks);
        let costs = self.neighbors.all().iter().map(|neighbor| (self.cost(point, neighbor), neighbor.point));
        let (cost, neighbor) = costs.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        Some(Best { neighbor, cost, base: cost, is_second: false, is_measured: false })
    }

    /// The cheapest collapse of a point that is legal at the moment.
    pub(super) fn find_legal(&mut self, point: u32) -> Option<Best> {
        self.neighbors.look(&self.topology, point, &mut self.marks);
        let costs = self.neighbors.all().iter();
        let mut all: Vec<(u32, u32)> =
            costs.map(|neighbor| (self.cost(point, neighbor).to_bits(), neighbor.point)).collect();
        all.sort_unstable();
        let mut best: Option<Best> = None;
        for (cost, neighbor) in all {
            let cost = f32::from_bits(cost);
            let candidate = Best { neighbor, cost, base: cost, is_second: true, is_measured: false };
            if best.is_some_and(|best| best.cost <= candidate.cost) {
                break;
            }
            if let Some(checked) = self.check(point, candidate)
                && best.is_none_or(|best| checked.cost < best.cost)
            {
                best = Some(checked);
            }
        }
        best
    }

    /// The cost of a collapse into one of the neighbours that were collected last.
    fn cost(&self, point: u32, neighbor: &Neighbor) -> f32 {
        let both = [point, neighbor.point];
        let cost = match &self.quadrics {
            Some(quadrics) => {
                let attributes = quadrics.attribute_cost(&self.points, &self.neighbors, point, neighbor);
                quadrics.shape_cost(&self.points, both) + attributes
            }
            None => melax::cost(&self.topology, &self.points, both),
        };
        cost as f32
    }

    /// A collapse with its whole cost, if it is legal.
    pub(super) fn check(&mut self, point: u32, best: Best) -> Option<Best> {
        if self.is_allowed(point, best.neighbor) { self.measure(point, best) } else { None }
    }

    /// Whether a collapse keeps the topology and, where they are limited, the distances of samples; and where the cost is
    /// that of Melax with normals, whether normals stay alike.
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
            && self.tracked_samples.as_mut().is_none_or(|tracked_samples| {
                tracked_samples.keeps_near(&self.topology, &self.points, point, neighbor)
            })
    }

    /// A collapse with its whole cost, which counts how far the point would be off the planes of its triangles. `None` if
    /// it turns a triangle.
    pub(super) fn measure(&self, point: u32, best: Best) -> Option<Best> {
        let deviation = deviation(&self.topology, &self.points, point, best.neighbor)?;
        let more = match &self.quadrics {
            None => 0.0,
            Some(quadrics) if quadrics.has_attributes() => BESIDE_ATTRIBUTES * deviation,
            Some(_) => (DEVIATION * deviation - f64::from(best.base)).max(0.0),
        };
        Some(Best { cost: best.base + more as f32, is_measured: true, ..best })
    }
}
