//! The search for the next collapse: the cheapest of each point, and whether it is legal.

use super::super::melax;
use super::super::neighbors::Neighbor;
use super::super::queue::Best;
use super::super::topology::Kind;
use super::super::turned::turns_any;
use super::{Cost, Reducer};

impl Reducer<'_> {
    /// The cheaper of `best` and the collapse into `neighbor`.
    pub(super) fn nearer(&self, point: u32, neighbor: u32, best: Best) -> Option<Best> {
        let is_lower = neighbor < best.neighbor;
        let most = if is_lower { best.cost.next_up() } else { best.cost };
        let cost = self.quadrics.as_ref()?.shape_cost(&self.points, [point, neighbor], most);
        Some(cost.map_or(best, |cost| Best { neighbor, cost, is_second: false }))
    }

    /// The cheapest collapse of a point, legal or not; of equal ones, that into the lower neighbour.
    pub(super) fn find(&mut self, point: u32) -> Option<Best> {
        if self.topology.kind(point) == Kind::Locked {
            return None;
        }
        self.neighbors.look(&self.topology, point, &mut self.marks);
        let mut best: Option<Best> = None;
        for neighbor in self.neighbors.all() {
            let most = best.map_or(f64::INFINITY, |best| best.cost);
            let is_lower = best.is_some_and(|best| neighbor.point < best.neighbor);
            // The next larger number, so that an equal cost is found too.
            let Some(cost) = self.cost(point, neighbor, if is_lower { most.next_up() } else { most }) else {
                continue;
            };
            best = Some(Best { neighbor: neighbor.point, cost, is_second: false });
        }
        best
    }

    /// The cheapest collapse of a point that is legal at the moment.
    pub(super) fn find_legal(&mut self, point: u32) -> Option<Best> {
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

    /// The cost of a collapse into one of the neighbours that were collected last; `None` if it is not below
    /// `most`.
    fn cost(&self, point: u32, neighbor: &Neighbor, most: f64) -> Option<f64> {
        match &self.quadrics {
            Some(quadrics) => {
                let shape = quadrics.shape_cost(&self.points, [point, neighbor.point], most)?;
                let all = shape + quadrics.attribute_cost(&self.points, &self.neighbors, point, neighbor);
                (all < most).then_some(all)
            }
            None => melax::cost(&self.topology, &self.points, [point, neighbor.point], most),
        }
    }

    /// Whether a collapse keeps the topology, the orientation of triangles and, where they are limited, the distances
    /// of samples; and where the cost is that of Melax with normals, whether normals stay alike.
    pub(super) fn is_legal(&mut self, point: u32, neighbor: u32) -> bool {
        let differ = match self.cost {
            Cost::Melax { check_normals: true } => {
                melax::differ(&self.topology, &self.points, [point, neighbor])
            }
            Cost::Melax { check_normals: false } | Cost::Quadric => false,
        };
        !differ
            && self.topology.keeps_topology(point, neighbor, &mut self.marks[0])
            && !turns_any(&self.topology, &self.points, point, neighbor)
            && self.tracked_samples.as_mut().is_none_or(|tracked_samples| {
                tracked_samples.keeps_near(&self.topology, &self.points, point, neighbor)
            })
    }
}
