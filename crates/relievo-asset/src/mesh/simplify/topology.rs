//! Connectivity of the mesh: the triangles around each point.

mod change;
mod link;

use super::points::Points;

/// A corner of a triangle: its vertex, and the vertex's point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Corner {
    pub vertex: u32,
    pub point: u32,
}

/// A triangle as seen from one of its points: the vertex at this point, and the other two corners in the triangle's
/// order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RingTriangle {
    pub triangle: u32,
    pub vertex: u32,
    pub next: Corner,
    pub last: Corner,
}

/// Largest number of triangles around a point that may collapse.
const MAX_RING: usize = 1024;

/// The kind of surface around a point. It decides whether and where the point may collapse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Triangles surround the point completely.
    Interior,
    /// Triangles form a fan from one border edge to another.
    Border,
    /// The point has no triangles, or they are arranged in another way. The point is never removed.
    Locked,
}

/// How a point's triangles have changed, from the smallest to the largest change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Change {
    None,
    /// A neighbour of the point has collapsed.
    Around,
    /// Another point was merged into the point.
    Merged,
}

/// Location of a point's list of triangles in [`Topology::rings`].
#[derive(Debug, Clone, Copy, Default)]
struct Span {
    start: usize,
    len: u32,
    /// Capacity of the list, in triangles.
    room: u32,
}

impl Span {
    fn range(self) -> std::ops::Range<usize> {
        self.start..self.start + self.len as usize
    }
}

/// Whether the triangles form a closed ring: following them from one to the next visits all of them and returns to the
/// start. If so, no two steps lead to the same neighbour, and no other triangle is around the point.
fn is_round(ring: &[[u32; 2]]) -> bool {
    let Some([first, _]) = ring.first().filter(|_| ring.len() <= MAX_RING) else { return false };
    let mut at = *first;
    for step in 1..=ring.len() {
        let Some([_, last]) = ring.iter().find(|[next, _]| *next == at) else { return false };
        at = *last;
        if at == *first {
            return step == ring.len();
        }
    }
    false
}

/// The triangles of the mesh that have three different points, listed by point. Other triangles count as removed.
///
/// A collapse updates only the lists of its two points. The lists of surrounding points still name the removed point
/// until [`Self::refresh`] updates them. This pays off because most lists change several times before they are read.
pub(crate) struct Topology {
    /// For each point, its triangles: the other two points of each, in the triangle's order.
    rings: Vec<[u32; 2]>,
    /// Triangle number of each entry of `rings`. Empty if triangles are not numbered.
    numbers: Vec<u32>,
    spans: Vec<Span>,
    /// For each point, the point into which it has collapsed, or itself.
    remap: Vec<u32>,
    /// For each point, whether a neighbour has collapsed since the point's last refresh.
    touched: Vec<bool>,
    /// For each point, the largest change since the last [`Self::take_change`].
    changes: Vec<Change>,
    /// Corners of each triangle. Empty if triangles are not numbered.
    corners: Vec<[Corner; 3]>,
    /// Mesh of each triangle. Empty if all triangles belong to one mesh.
    meshes: Vec<u32>,
    kinds: Vec<Kind>,
    triangles: usize,
    /// Temporary list with the triangles of a collapsing point.
    scratch: Vec<([u32; 2], u32)>,
}

impl Topology {
    /// Builds the connectivity of triangles. `meshes` has the mesh of each triangle; empty if all triangles belong to
    /// one mesh. Triangles are numbered if `is_numbered` is set, if there are meshes, or if several vertices share a
    /// position.
    pub(crate) fn new(points: &Points, indices: &[u32], meshes: &[u32], is_numbered: bool) -> Self {
        let is_numbered = is_numbered || !meshes.is_empty() || !points.are_vertices();
        let triangle =
            |corners: &[u32]| [points.of(corners[0]), points.of(corners[1]), points.of(corners[2])];
        let has_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        let mut spans = vec![Span::default(); points.len()];
        for [a, b, c] in indices.chunks_exact(3).map(triangle).filter(has_area) {
            spans[a as usize].room += 1;
            spans[b as usize].room += 1;
            spans[c as usize].room += 1;
        }
        let mut entries = 0;
        for span in &mut spans {
            span.start = entries;
            entries += span.room as usize;
        }
        let mut rings = vec![[0; 2]; entries];
        let mut numbers = vec![0; if is_numbered { entries } else { 0 }];
        for (number, of) in (0_u32..).zip(indices.chunks_exact(3).map(triangle)) {
            let [a, b, c] = of;
            let all = [(a, [b, c]), (b, [c, a]), (c, [a, b])];
            if !has_area(&of) {
                continue;
            }
            for (point, others) in all {
                let span = &mut spans[point as usize];
                let at = span.start + span.len as usize;
                span.len += 1;
                rings[at] = others;
                if is_numbered {
                    numbers[at] = number;
                }
            }
        }
        let corner = |vertex: u32| Corner { vertex, point: points.of(vertex) };
        let all = indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|at| corner(corners[at])));
        let corners = if is_numbered { all.collect() } else { Vec::new() };
        let (meshes, kinds, scratch) = (meshes.to_vec(), Vec::new(), Vec::new());
        let (remap, changes) = ((0..points.len() as u32).collect(), vec![Change::None; points.len()]);
        let (touched, triangles) = (vec![false; points.len()], entries / 3);
        let mut topology = Self {
            rings,
            numbers,
            spans,
            remap,
            touched,
            changes,
            corners,
            meshes,
            kinds,
            triangles,
            scratch,
        };
        topology.kinds = (0..points.len() as u32).map(|point| topology.kind_of(point)).collect();
        topology
    }

    /// The kind of a point. A point is manifold under two conditions. First, each neighbour is `next` in at most one
    /// triangle and `last` in at most one. Second, following the triangles from one to the next visits all of them.
    fn kind_of(&self, point: u32) -> Kind {
        let ring = self.ring(point);
        if is_round(ring) {
            return Kind::Interior;
        }
        // Points with very many triangles are locked, because other code searches their lists linearly.
        let Some(some) = ring.first().filter(|_| ring.len() <= MAX_RING) else { return Kind::Locked };
        let is_unique = |at: usize| {
            let [next, last] = ring[at];
            ring[..at].iter().all(|other| other[0] != next && other[1] != last)
        };
        if !(1..ring.len()).all(is_unique) {
            return Kind::Locked;
        }
        let border =
            ring.iter().map(|[next, _]| *next).find(|next| ring.iter().all(|other| other[1] != *next));
        let first = border.unwrap_or(some[0]);
        let (mut at, mut passed) = (first, 0);
        while let Some([_, last]) = ring.iter().find(|[next, _]| *next == at) {
            (at, passed) = (*last, passed + 1);
            if at == first {
                break;
            }
        }
        match border {
            _ if passed < ring.len() => Kind::Locked,
            None => Kind::Interior,
            Some(_) => Kind::Border,
        }
    }

    /// Number of remaining triangles.
    pub(crate) fn triangles(&self) -> usize {
        self.triangles
    }

    #[inline]
    pub(crate) fn kind(&self, point: u32) -> Kind {
        self.kinds[point as usize]
    }

    /// Returns the change of a point since the last call, and resets it.
    #[inline]
    pub(crate) fn take_change(&mut self, point: u32) -> Change {
        std::mem::replace(&mut self.changes[point as usize], Change::None)
    }

    /// Whether a point has collapsed into another point.
    #[inline]
    pub(crate) fn is_gone(&self, point: u32) -> bool {
        self.remap[point as usize] != point
    }

    /// Triangles of a point: the other two points of each, in the triangle's order.
    #[inline]
    pub(crate) fn ring(&self, point: u32) -> &[[u32; 2]] {
        &self.rings[self.spans[point as usize].range()]
    }

    /// Number of leading poses to examine for a collapse of the first point into the second: one if all triangles
    /// around the first point belong to one rigid body, otherwise all poses.
    #[inline]
    pub(crate) fn poses_around(&self, points: &Points, both: [u32; 2]) -> usize {
        let body = points.common_body(&both);
        let is_rigid = self.ring(both[0]).iter().all(|others| points.common_body(others) == body);
        if is_rigid { points.poses_between(body, body) } else { points.poses() }
    }

    /// The two neighbours of a border point along the border; `None` for other points.
    pub(crate) fn along_border(&self, point: u32) -> Option<[u32; 2]> {
        if self.kind(point) != Kind::Border {
            return None;
        }
        let ring = self.ring(point);
        let [first, _] = ring.iter().find(|[next, _]| ring.iter().all(|[_, last]| last != next))?;
        let [_, last] = ring.iter().find(|[_, last]| ring.iter().all(|[next, _]| next != last))?;
        Some([*first, *last])
    }

    /// Indices of the triangles around a point; empty if triangles are not numbered.
    pub(crate) fn around(&self, point: u32) -> &[u32] {
        self.numbers.get(self.spans[point as usize].range()).unwrap_or_default()
    }

    /// Mesh of a triangle; `None` if all triangles belong to one mesh.
    #[inline]
    pub(crate) fn mesh(&self, triangle: u32) -> Option<u32> {
        self.meshes.get(triangle as usize).copied()
    }

    /// Reads the location of a point's triangles to prefetch it. The returned number only prevents the compiler from
    /// dropping the read.
    #[inline]
    pub(crate) fn touch_span(&self, point: u32) -> u32 {
        self.spans[point as usize].len
    }

    /// Reads the triangles of a point to prefetch them. The returned number only prevents the compiler from dropping
    /// the reads.
    #[inline]
    pub(crate) fn touch(&self, point: u32) -> u32 {
        let span = self.spans[point as usize];
        let first = self.rings.get(span.start).map_or(0, |others| others[0]);
        let last = self.rings.get(span.start + span.len as usize).map_or(0, |others| others[1]);
        first ^ last
    }

    /// Triangles of a point with their corners. If triangles are not numbered, each corner's vertex is its point.
    pub(crate) fn one_ring(&self, point: u32) -> impl Iterator<Item = RingTriangle> + '_ {
        let numbers = self.around(point);
        self.ring(point).iter().enumerate().map(move |(at, others)| {
            let Some(&triangle) = numbers.get(at) else {
                let [next, last] = others.map(|point| Corner { vertex: point, point });
                return RingTriangle { triangle: 0, vertex: point, next, last };
            };
            let [a, b, c] = self.corners[triangle as usize];
            let [own, next, last] = match point {
                _ if a.point == point => [a, b, c],
                _ if b.point == point => [b, c, a],
                _ => [c, a, b],
            };
            RingTriangle { triangle, vertex: own.vertex, next, last }
        })
    }
}
