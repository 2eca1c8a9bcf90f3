//! How a pair of points would be contracted: which of them stays, where it goes, and what becomes of wedges.

use crate::reduce::contract::{Contraction, Pairs};
use crate::reduce::mesh::unique;

/// A contraction.
#[derive(Debug, Clone)]
pub(in crate::reduce) struct Plan {
    pub(super) gone: u32,
    pub(super) keep: u32,
    /// Where the point that is kept goes, in the model's units.
    pub(super) position: [f32; 3],
    /// The mean squared distance of this place from the planes of both points.
    pub(super) cost: f64,
    /// Wedges of the point that is gone, each with the one that takes its place. Others become wedges of the kept point.
    pub(super) vertices: Vec<[u32; 2]>,
    /// How far the attributes of kept wedges move towards those that are gone, from 0 to 1.
    pub(super) fraction: f32,
}

impl Contraction {
    /// The contraction of a pair, in ascending order; `None` if nothing permits it.
    pub(super) fn plan(&self, pair: [u32; 2]) -> Option<Plan> {
        match self.pairs {
            Pairs::Edges => self.edge(pair),
            Pairs::Near(_) => {
                let [keep, gone] = pair;
                let vertices = self.matches(gone, keep);
                Some(self.best([gone, keep], vertices))
            }
        }
    }

    /// An edge is contracted to the best place where both of its points may leave their places with all their wedges, and
    /// otherwise to that of the point that may not.
    fn edge(&self, [a, b]: [u32; 2]) -> Option<Plan> {
        let [from_a, from_b] = [self.leaves(a, b), self.leaves(b, a)];
        if let (Some(from_a), Some(from_b)) = (&from_a, &from_b) {
            let are_matched = from_a.len() == from_b.len()
                && from_a.iter().all(|[own, other]| from_b.contains(&[*other, *own]));
            if are_matched {
                return Some(self.best([b, a], from_b.clone()));
            }
        }
        let onto = |gone, keep, vertices: Option<Vec<[u32; 2]>>| {
            let position = self.positions[keep as usize];
            Some(self.to([gone, keep], position, 0.0, vertices?))
        };
        let both = [onto(a, b, from_a), onto(b, a, from_b)].into_iter().flatten();
        both.min_by(|one, other| one.cost.total_cmp(&other.cost))
    }

    /// The wedges of `other` that can take the place of a point's own. `None` if the point must stay: it is not manifold, it
    /// is on a border and the edge is not, or it has a wedge that the edge does not meet.
    fn leaves(&self, point: u32, other: u32) -> Option<Vec<[u32; 2]>> {
        let fan = self.solid.mesh.fan(point)?;
        self.solid.mesh.fan(other)?;
        let shared = fan.triangles.iter().filter(|ring| ring.has(other));
        if shared.clone().count() != if fan.is_closed { 2 } else { 1 } {
            return None;
        }
        let of_wedge = |wedge: u32| {
            let met = shared.clone().filter(|ring| ring.vertex == wedge);
            Some([wedge, met.filter_map(|ring| ring.vertex_of(other)).min()?])
        };
        self.solid.mesh.wedges(point).into_iter().map(of_wedge).collect()
    }

    /// The wedges of two points that belong to the same side of an edge between them, one by one.
    fn matches(&self, gone: u32, keep: u32) -> Vec<[u32; 2]> {
        let shared = self.solid.mesh.ring(gone).filter(|ring| ring.has(keep));
        let met = unique(shared.filter_map(|ring| Some([ring.vertex, ring.vertex_of(keep)?])));
        let is_alone = |[from, to]: &[u32; 2]| {
            met.iter().filter(|other| other[0] == *from || other[1] == *to).count() == 1
        };
        met.iter().filter(|meet| is_alone(meet)).copied().collect()
    }

    /// Contracts to the place with the smallest cost.
    fn best(&self, [gone, keep]: [u32; 2], vertices: Vec<[u32; 2]>) -> Plan {
        let [from, to] = [keep, gone].map(|point| self.solid.places[point as usize]);
        let quadric = self.quadrics[gone as usize].sum(&self.quadrics[keep as usize]);
        let middle = (from + to) * 0.5;
        let best = quadric.minimum(middle);
        // Planes that are almost parallel meet far away.
        let place = if best.distance(middle) <= from.distance(to) { best } else { middle };
        let along = (to - from).dot(place - from) / from.distance_squared(to).max(f64::MIN_POSITIVE);
        let fraction = along.clamp(0.0, 1.0) as f32;
        self.to([gone, keep], self.solid.frame.position(place), fraction, vertices)
    }

    fn to(&self, [gone, keep]: [u32; 2], position: [f32; 3], fraction: f32, vertices: Vec<[u32; 2]>) -> Plan {
        let quadric = self.quadrics[gone as usize].sum(&self.quadrics[keep as usize]);
        let cost = quadric.mean_at(self.solid.frame.of(position));
        Plan { gone, keep, position, cost, vertices, fraction }
    }
}
