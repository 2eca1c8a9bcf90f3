//! The neighbours into which a point may collapse, and the vertex that replaces each of the point's wedges.

use super::marks::Marks;
use super::points::Points;
use super::topology::{Kind, Topology};

/// The vertices that may replace a wedge: none, one or two.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Remap {
    vertices: [u32; 2],
    count: usize,
}

impl Remap {
    fn add(&mut self, vertex: u32) {
        let is_known = self.vertices[..self.count].contains(&vertex);
        if !is_known && self.count < 2 {
            self.vertices[self.count] = vertex;
            self.count += 1;
            self.vertices[..self.count].sort_unstable();
        }
    }
}

impl IntoIterator for Remap {
    type Item = u32;
    type IntoIter = std::iter::Take<std::array::IntoIter<u32, 2>>;

    /// Iterates over the vertices in ascending order.
    fn into_iter(self) -> Self::IntoIter {
        self.vertices.into_iter().take(self.count)
    }
}

/// A neighbour of a point, with the triangles at the edge between both.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Neighbor {
    pub point: u32,
    /// Number of triangles at the edge between point and neighbour.
    triangles: u32,
    meets: [Meet; 2],
}

impl Neighbor {
    fn meets(&self) -> &[Meet] {
        &self.meets[..self.triangles.min(2) as usize]
    }

    /// The neighbour's vertex at the edge; `None` if the triangles at the edge use different vertices.
    pub(crate) fn only_target(&self) -> Option<u32> {
        let first = self.meets[0].other;
        self.meets().iter().all(|meet| meet.other == first).then_some(first)
    }
}

/// The vertices of one triangle at a point and at its neighbour.
#[derive(Debug, Clone, Copy, Default)]
struct Meet {
    own: Wedge,
    other: u32,
}

/// A vertex of a point, used by at least one triangle.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Wedge {
    pub vertex: u32,
    /// Index of the wedge's sheet. A sheet is a set of adjacent wedges. The edges between them are split at this point,
    /// but not at their far ends.
    sheet: u32,
}

/// The neighbours and wedges of one point.
#[derive(Default)]
pub(crate) struct Neighbors {
    all: Vec<Neighbor>,
    wedges: Vec<Wedge>,
    sheets: usize,
    /// Pairs: a neighbour, and one of its vertices. Lists all vertices that triangles use. Empty unless seams may be
    /// crossed.
    beyond: Vec<[u32; 2]>,
}

impl Neighbors {
    /// Collects the neighbours and wedges of a point. The point must not be locked.
    pub(crate) fn look(
        &mut self,
        topology: &Topology,
        points_of: &Points,
        point: u32,
        marks: &mut [Marks; 2],
    ) {
        self.all.clear();
        self.wedges.clear();
        let [points, vertices] = marks;
        points.clear();
        let mut is_split = false;
        for ring in topology.one_ring(point) {
            let own = Wedge { vertex: ring.vertex, sheet: 0 };
            is_split |= self.wedges.first().is_some_and(|first| first.vertex != own.vertex);
            if self.wedges.is_empty() {
                self.wedges.push(own);
            }
            for other in [ring.next, ring.last] {
                let at = points.get(other.point).unwrap_or_else(|| {
                    points.set(other.point, self.all.len() as u32);
                    self.all.push(Neighbor { point: other.point, triangles: 0, meets: Default::default() });
                    self.all.len() as u32 - 1
                });
                let neighbor = &mut self.all[at as usize];
                neighbor.meets[(neighbor.triangles as usize).min(1)] = Meet { own, other: other.vertex };
                neighbor.triangles += 1;
            }
        }
        self.sheets = 1;
        if is_split {
            self.find_sheets(topology, points_of, point, vertices);
        }
        self.keep_allowed(topology, point);
        self.beyond.clear();
        if points_of.has_charts() {
            vertices.clear();
            for neighbor in &self.all {
                let used = topology.one_ring(neighbor.point).map(|ring| ring.vertex);
                let first = used.filter(|vertex| vertices.insert(*vertex));
                self.beyond.extend(first.map(|vertex| [neighbor.point, vertex]));
            }
            self.beyond.sort_unstable();
        }
    }

    /// Lists each wedge once, with its sheet. Two wedges are in one sheet if two of their triangles share an edge, and
    /// use the same vertex at its far end.
    fn find_sheets(&mut self, topology: &Topology, points: &Points, point: u32, vertices: &mut Marks) {
        self.wedges.clear();
        vertices.clear();
        for ring in topology.one_ring(point) {
            let own = vertices.get(ring.vertex).unwrap_or_else(|| {
                let sheet = self.wedges.len() as u32;
                self.wedges.push(Wedge { vertex: ring.vertex, sheet });
                vertices.set(ring.vertex, sheet);
                sheet
            });
            vertices.set(ring.last.vertex, own);
        }
        for at in 0..self.wedges.len() {
            let chart = points.chart(self.wedges[at].vertex);
            let first = self.wedges[..at].iter().find(|other| points.chart(other.vertex) == chart);
            if let Some(sheet) = first.map(|first| first.sheet) {
                self.wedges[at].sheet = sheet;
            }
        }
        let of_own = |(at, wedge): (usize, &Wedge)| wedge.sheet as usize == at;
        self.sheets = self.wedges.iter().enumerate().filter(|all| of_own(*all)).count();
        let wedge = |vertex| vertices.get(vertex).map(|at| at as usize);
        for ring in topology.one_ring(point) {
            let (Some(own), Some(beside)) = (wedge(ring.vertex), wedge(ring.next.vertex)) else { continue };
            let [own, beside] = [own, beside].map(|at| self.wedges[at].sheet);
            if own != beside {
                let joined = self.wedges.iter_mut().filter(|wedge| wedge.sheet == own);
                joined.for_each(|wedge| wedge.sheet = beside);
                self.sheets -= 1;
            }
        }
        for meet in self.all.iter_mut().flat_map(|neighbor| &mut neighbor.meets) {
            meet.own.sheet = wedge(meet.own.vertex).map_or(0, |at| self.wedges[at].sheet);
        }
    }

    /// Removes neighbours into which the point may not collapse. A border point may move only along the border. The
    /// neighbour must share an edge with every sheet of the point.
    fn keep_allowed(&mut self, topology: &Topology, point: u32) {
        let sheets = self.sheets;
        self.all.retain(|neighbor| {
            let is_along = match topology.kind(point) {
                Kind::Interior => neighbor.triangles == 2,
                Kind::Border => neighbor.triangles == 1 && topology.kind(neighbor.point) == Kind::Border,
                Kind::Locked => false,
            };
            let first = neighbor.meets[0].own.sheet;
            let are_two = neighbor.meets().iter().any(|meet| meet.own.sheet != first);
            is_along && sheets == if are_two { 2 } else { 1 }
        });
    }

    pub(crate) fn all(&self) -> &[Neighbor] {
        &self.all
    }

    /// Whether several sheets meet at the point.
    pub(crate) fn is_split(&self) -> bool {
        self.sheets > 1
    }

    pub(crate) fn wedges(&self) -> &[Wedge] {
        &self.wedges
    }

    /// The vertices of a neighbour that are on the same chart as its vertex `target`, in ascending order. Empty unless
    /// seams may be crossed.
    pub(crate) fn beyond<'a>(
        &'a self,
        points: &'a Points,
        neighbor: &Neighbor,
        target: u32,
    ) -> impl Iterator<Item = u32> + 'a {
        let from = self.beyond.partition_point(|[point, _]| *point < neighbor.point);
        let to = from + self.beyond[from..].partition_point(|[point, _]| *point == neighbor.point);
        let all = self.beyond[from..to].iter().map(|[_, vertex]| *vertex);
        all.filter(move |vertex| points.chart(*vertex) == points.chart(target))
    }

    /// The vertices that may replace a wedge: the neighbour's vertices with which the wedge shares an edge. If there
    /// are none, the vertices that share an edge with another wedge of the same sheet.
    pub(crate) fn remap(&self, neighbor: &Neighbor, wedge: &Wedge) -> Remap {
        let mut remap = Remap::default();
        let own = neighbor.meets().iter().filter(|meet| meet.own.vertex == wedge.vertex);
        own.for_each(|meet| remap.add(meet.other));
        if remap.count == 0 {
            let beside = neighbor.meets().iter().filter(|meet| meet.own.sheet == wedge.sheet);
            beside.for_each(|meet| remap.add(meet.other));
        }
        remap
    }
}
