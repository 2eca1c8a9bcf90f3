//! The link condition: whether a collapse keeps the topology.

use super::{Kind, Topology};

impl Topology {
    /// Whether a collapse keeps the topology (the link condition). Every common neighbour of the two points must lie on
    /// a triangle that both points share. Two common neighbours must not form a triangle with the first point and
    /// another triangle with the second.
    pub(crate) fn keeps_topology(&self, point: u32, neighbor: u32) -> bool {
        let (ring, far) = (self.ring(point), self.ring(neighbor));
        if [point, neighbor].iter().all(|point| self.kind(*point) == Kind::Interior) {
            return is_link_of_edge(ring, far);
        }
        let mut across = [u32::MAX; 2];
        let mut shared = 0;
        for &[next, last] in far {
            if next != point && last != point {
                continue;
            }
            let other = if next == point { last } else { next };
            if shared == 2 || across[0] == other {
                return false;
            }
            across[shared] = other;
            shared += 1;
        }
        let is_across = |other: u32| other == across[0] || other == across[1];
        let both_across =
            |ring: &[[u32; 2]]| ring.iter().any(|[next, last]| is_across(*next) && is_across(*last));
        if shared == 1 && ring.len() == 1 && far.len() == 1
            || shared == 2 && both_across(ring) && both_across(far)
        {
            return false;
        }
        let [is_inside, far_is_inside] = [point, neighbor].map(|point| self.kind(point) == Kind::Interior);
        let is_common = |other: u32| {
            other != neighbor
                && !is_across(other)
                && far.iter().any(|[next, last]| *next == other || !far_is_inside && *last == other)
        };
        // Around an interior point, each neighbour is `next` exactly once.
        !ring.iter().any(|[next, last]| is_common(*next) || !is_inside && is_common(*last))
    }
}

impl Topology {
    /// Whether every mesh that has a triangle at a point around a collapse still has one at this point afterwards.
    pub(crate) fn keeps_meshes(&mut self, point: u32, neighbor: u32) -> bool {
        if self.meshes.is_empty() {
            return true;
        }
        let vanishing: Vec<(u32, u32)> = (self.ring(point).iter().zip(self.around(point)))
            .filter(|([next, last], _)| *next == neighbor || *last == neighbor)
            .map(|([next, last], number)| (*number, if *next == neighbor { *last } else { *next }))
            .collect();
        vanishing.iter().for_each(|(_, other)| self.refresh(*other));
        let meets = |at: u32, mesh: Option<u32>| {
            let stays = |number: &&u32| vanishing.iter().all(|(vanished, _)| vanished != *number);
            self.around(at).iter().filter(stays).any(|number| self.mesh(*number) == mesh)
        };
        vanishing.iter().all(|(number, other)| {
            let mesh = self.mesh(*number);
            meets(*other, mesh) && (meets(point, mesh) || meets(neighbor, mesh))
        })
    }
}

/// As [`Topology::keeps_topology`], but for two interior points, around which each neighbour is `next` exactly once.
/// The points must have exactly two common neighbours, and must not form a tetrahedron with them.
fn is_link_of_edge(ring: &[[u32; 2]], far: &[[u32; 2]]) -> bool {
    let mut common = 0;
    for [next, _] in ring {
        common += far.iter().map(|[other, _]| u32::from(other == next)).sum::<u32>();
    }
    common == 2 && ring.len().max(far.len()) > 3
}
