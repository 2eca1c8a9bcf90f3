//! The connectivity of the mesh: its triangles, and the triangles around each point.

use super::points::Points;

/// A sparse map from indices to numbers that can be cleared in constant time.
pub struct Marks {
    current: u32,
    stamps: Vec<u32>,
    values: Vec<u32>,
}

impl Marks {
    pub fn new(count: usize) -> Self {
        Self { current: 0, stamps: vec![0; count], values: vec![0; count] }
    }

    /// Removes all entries.
    pub fn clear(&mut self) {
        if self.current == u32::MAX {
            self.stamps.fill(0);
            self.current = 0;
        }
        self.current += 1;
    }

    pub fn get(&self, at: u32) -> Option<u32> {
        (self.stamps[at as usize] == self.current).then(|| self.values[at as usize])
    }

    pub fn set(&mut self, at: u32, value: u32) {
        self.stamps[at as usize] = self.current;
        self.values[at as usize] = value;
    }

    /// Marks an index. Returns whether it had no mark.
    pub fn insert(&mut self, at: u32) -> bool {
        let is_new = self.get(at).is_none();
        self.set(at, 0);
        is_new
    }
}

/// A corner of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Corner {
    pub vertex: u32,
    pub point: u32,
}

/// A triangle seen from one of its points: the vertex there, and the other two corners in the triangle's order.
#[derive(Debug, Clone, Copy)]
pub struct RingTriangle {
    pub triangle: u32,
    pub vertex: u32,
    pub next: Corner,
    pub last: Corner,
}

/// The kind of a point's neighbourhood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Triangles surround the point.
    Interior,
    /// Triangles form a fan from one border edge to another.
    Border,
    /// The point has no triangle, or any other neighbourhood: it is never removed.
    Locked,
}

/// The triangles that have three different points. All others count as removed.
pub struct Topology {
    corners: Vec<[Corner; 3]>,
    around: Vec<Vec<u32>>,
    kinds: Vec<Kind>,
    triangles: usize,
}

impl Topology {
    pub fn new(points: &Points, indices: &[u32]) -> Self {
        let corners: Vec<[Corner; 3]> = (indices.chunks_exact(3))
            .map(|triangle| [triangle[0], triangle[1], triangle[2]])
            .map(|triangle| triangle.map(|vertex| Corner { vertex, point: points.of(vertex) }))
            .collect();
        let has_area = |corners: &[Corner; 3]| {
            let [a, b, c] = corners.map(|corner| corner.point);
            a != b && b != c && c != a
        };
        let mut counts = vec![0; points.len()];
        let all = (0_u32..).zip(&corners).filter(|(_, corners)| has_area(corners));
        all.clone().flat_map(|(_, corners)| corners).for_each(|corner| counts[corner.point as usize] += 1);
        let mut around: Vec<Vec<u32>> = counts.iter().map(|count| Vec::with_capacity(*count)).collect();
        let mut triangles = 0;
        for (triangle, corners) in all {
            corners.iter().for_each(|corner| around[corner.point as usize].push(triangle));
            triangles += 1;
        }
        let mut topology = Self { corners, around, kinds: Vec::new(), triangles };
        let mut follows = Marks::new(points.len());
        let mut leads = Marks::new(points.len());
        topology.kinds =
            (0..points.len() as u32).map(|point| topology.kind_of(point, &mut follows, &mut leads)).collect();
        topology
    }

    /// The kind of a point. It is manifold if each neighbour begins at most one of its triangles and ends at
    /// most one, and if following the triangles from one to the next visits all of them.
    fn kind_of(&self, point: u32, follows: &mut Marks, leads: &mut Marks) -> Kind {
        let Some(some) = self.one_ring(point).next() else { return Kind::Locked };
        follows.clear();
        leads.clear();
        for ring in self.one_ring(point) {
            let is_new = follows.get(ring.next.point).is_none() && leads.get(ring.last.point).is_none();
            if !is_new {
                return Kind::Locked;
            }
            follows.set(ring.next.point, ring.last.point);
            leads.set(ring.last.point, ring.next.point);
        }
        let border = self.one_ring(point).map(|ring| ring.next.point).find(|next| leads.get(*next).is_none());
        let first = border.unwrap_or(some.next.point);
        let (mut at, mut passed) = (first, 0);
        while let Some(next) = follows.get(at) {
            (at, passed) = (next, passed + 1);
            if at == first {
                break;
            }
        }
        match border {
            _ if passed < self.around(point).len() => Kind::Locked,
            None => Kind::Interior,
            Some(_) => Kind::Border,
        }
    }

    /// Number of remaining triangles.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    pub fn kind(&self, point: u32) -> Kind {
        self.kinds[point as usize]
    }

    pub fn corners(&self, triangle: u32) -> &[Corner; 3] {
        &self.corners[triangle as usize]
    }

    /// The triangles of a point.
    pub fn around(&self, point: u32) -> &[u32] {
        &self.around[point as usize]
    }

    pub fn one_ring(&self, point: u32) -> impl Iterator<Item = RingTriangle> + '_ {
        self.around(point).iter().map(move |&triangle| {
            let [a, b, c] = self.corners[triangle as usize];
            let [own, next, last] = match point {
                _ if a.point == point => [a, b, c],
                _ if b.point == point => [b, c, a],
                _ => [c, a, b],
            };
            RingTriangle { triangle, vertex: own.vertex, next, last }
        })
    }

    /// Whether a collapse keeps the topology (the link condition): every common neighbour of the two points
    /// lies across a triangle that both share, and no two of these common neighbours share a triangle with each
    /// of the two points.
    pub fn keeps_topology(&self, point: u32, neighbor: u32, marks: &mut Marks) -> bool {
        marks.clear();
        let mut across = [u32::MAX; 2];
        let mut shared = 0;
        for ring in self.one_ring(neighbor) {
            marks.insert(ring.next.point);
            marks.insert(ring.last.point);
            let has_point = [ring.next.point, ring.last.point].iter().position(|other| *other == point);
            if let Some(at) = has_point {
                let other = [ring.last.point, ring.next.point][at];
                if shared == 2 || across[..shared].contains(&other) {
                    return false;
                }
                across[shared] = other;
                shared += 1;
            }
        }
        let both_across =
            |ring: RingTriangle| across.contains(&ring.next.point) && across.contains(&ring.last.point);
        if shared == 1 && self.around(point).len() == 1 && self.around(neighbor).len() == 1
            || shared == 2
                && self.one_ring(point).any(both_across)
                && self.one_ring(neighbor).any(both_across)
        {
            return false;
        }
        // Counts each common neighbour once; those across a shared triangle are known to be different.
        let mut common = 0;
        for ring in self.one_ring(point) {
            for other in [ring.next.point, ring.last.point] {
                if marks.get(other) == Some(0) {
                    marks.set(other, 1);
                    common += 1;
                }
            }
        }
        common == shared
    }

    /// Merges a point into its neighbour; `moved` has the replacement of each of its vertices.
    pub fn collapse(&mut self, point: u32, neighbor: u32, moved: &[[u32; 2]]) {
        for triangle in std::mem::take(&mut self.around[point as usize]) {
            let corners = &mut self.corners[triangle as usize];
            if corners.iter().any(|corner| corner.point == neighbor) {
                for other in corners.map(|corner| corner.point) {
                    let around = &mut self.around[other as usize];
                    if let Some(at) = around.iter().position(|of| *of == triangle) {
                        around.swap_remove(at);
                    }
                }
                self.triangles -= 1;
                continue;
            }
            for corner in corners.iter_mut().filter(|corner| corner.point == point) {
                let to = moved.iter().find(|[from, _]| *from == corner.vertex);
                *corner = Corner { vertex: to.map_or(corner.vertex, |[_, to]| *to), point: neighbor };
            }
            self.around[neighbor as usize].push(triangle);
        }
        self.kinds[point as usize] = Kind::Locked;
    }
}
