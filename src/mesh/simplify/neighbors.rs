//! What a point may become, and which vertex each of its wedges becomes then.

use super::topology::{Kind, Marks, Topology};

/// The vertices that something may become: none, one, or one of two.
#[derive(Debug, Clone, Copy, Default)]
pub struct Heirs {
    vertices: [u32; 2],
    count: usize,
}

impl Heirs {
    fn add(&mut self, vertex: u32) {
        let is_known = self.vertices[..self.count].contains(&vertex);
        if !is_known && self.count < 2 {
            self.vertices[self.count] = vertex;
            self.count += 1;
            self.vertices[..self.count].sort_unstable();
        }
    }
}

impl IntoIterator for Heirs {
    type Item = u32;
    type IntoIter = std::iter::Take<std::array::IntoIter<u32, 2>>;

    /// Ascending.
    fn into_iter(self) -> Self::IntoIter {
        self.vertices.into_iter().take(self.count)
    }
}

/// A neighbour, with the triangles that lie between.
#[derive(Debug, Clone, Copy)]
pub struct Neighbor {
    pub point: u32,
    /// How many triangles there are; of two at most, the point's vertex and the neighbour's.
    triangles: u32,
    meets: [[u32; 2]; 2],
}

/// One of a point's vertices that has triangles.
#[derive(Debug, Clone, Copy)]
pub struct Wedge {
    pub vertex: u32,
    /// The same for wedges that lie beside each other, split here alone.
    sheet: u32,
}

/// What surrounds a point.
#[derive(Default)]
pub struct Neighbors {
    all: Vec<Neighbor>,
    wedges: Vec<Wedge>,
}

impl Neighbors {
    /// Looks around a point that is not locked.
    pub fn look(&mut self, topology: &Topology, point: u32, marks: &mut [Marks; 2]) {
        self.all.clear();
        self.wedges.clear();
        let [points, vertices] = marks;
        points.clear();
        for spoke in topology.spokes(point) {
            for other in [spoke.next, spoke.last] {
                let at = points.get(other.point).unwrap_or_else(|| {
                    points.set(other.point, self.all.len() as u32);
                    self.all.push(Neighbor { point: other.point, triangles: 0, meets: [[0; 2]; 2] });
                    self.all.len() as u32 - 1
                });
                let neighbor = &mut self.all[at as usize];
                neighbor.meets[(neighbor.triangles as usize).min(1)] = [spoke.vertex, other.vertex];
                neighbor.triangles += 1;
            }
            if self.wedges.first().is_none_or(|first| first.vertex != spoke.vertex) {
                self.wedges.push(Wedge { vertex: spoke.vertex, sheet: 0 });
            }
        }
        if self.wedges.len() > 1 {
            self.find_sheets(topology, point, vertices);
        }
        self.keep_allowed(topology, point);
    }

    /// Each wedge once, and those in one sheet whose triangles meet in an edge with one vertex at its far end.
    fn find_sheets(&mut self, topology: &Topology, point: u32, vertices: &mut Marks) {
        self.wedges.clear();
        vertices.clear();
        for spoke in topology.spokes(point) {
            if vertices.get(spoke.vertex).is_none() {
                let count = self.wedges.len() as u32;
                vertices.set(spoke.vertex, count);
                self.wedges.push(Wedge { vertex: spoke.vertex, sheet: count });
            }
            vertices.set(spoke.last.vertex, vertices.get(spoke.vertex).unwrap_or_default());
        }
        for spoke in topology.spokes(point) {
            let (own, beside) = (vertices.get(spoke.vertex), vertices.get(spoke.next.vertex));
            if let (Some(own), Some(beside)) = (own, beside) {
                let [own, beside] = [own, beside].map(|wedge| self.wedges[wedge as usize].sheet);
                if own != beside {
                    (self.wedges.iter_mut().filter(|wedge| wedge.sheet == own))
                        .for_each(|wedge| wedge.sheet = beside);
                }
            }
        }
    }

    /// Of a border, along it alone; and all wedges need heirs.
    fn keep_allowed(&mut self, topology: &Topology, point: u32) {
        let mut all = std::mem::take(&mut self.all);
        all.retain(|neighbor| {
            let is_along = match topology.kind(point) {
                Kind::Interior => neighbor.triangles == 2,
                Kind::Border => neighbor.triangles == 1 && topology.kind(neighbor.point) == Kind::Border,
                Kind::Locked => false,
            };
            is_along && self.wedges.iter().all(|wedge| self.heirs(neighbor, wedge).count > 0)
        });
        self.all = all;
    }

    pub fn all(&self) -> &[Neighbor] {
        &self.all
    }

    pub fn wedges(&self) -> &[Wedge] {
        &self.wedges
    }

    /// What a wedge may become: what it shares an edge with, or else what others of its sheet do.
    pub fn heirs(&self, neighbor: &Neighbor, wedge: &Wedge) -> Heirs {
        let meets = &neighbor.meets[..neighbor.triangles.min(2) as usize];
        let mut heirs = Heirs::default();
        for [own, other] in meets {
            if *own == wedge.vertex {
                heirs.add(*other);
            }
        }
        if heirs.count == 0 {
            for [own, other] in meets {
                let beside = self.wedges.iter().find(|wedge| wedge.vertex == *own);
                if beside.is_some_and(|beside| beside.sheet == wedge.sheet) {
                    heirs.add(*other);
                }
            }
        }
        heirs
    }
}
