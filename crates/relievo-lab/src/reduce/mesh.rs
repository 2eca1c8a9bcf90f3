//! The connectivity of a mesh that reducers change: the corners of its triangles, and the triangles around its points. A point
//! is what the vertices at one position have in common, and these are its wedges.

use glam::DVec3;
use relievo::ops::mesh::simplify::{Surface, weld};

/// A corner of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Corner {
    pub(super) vertex: u32,
    pub(super) point: u32,
}

/// A triangle seen from one of its points: the vertex there, and the other corners in the triangle's order.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    pub(super) triangle: u32,
    pub(super) vertex: u32,
    pub(super) next: Corner,
    pub(super) last: Corner,
}

impl Ring {
    pub(super) fn has(&self, point: u32) -> bool {
        self.next.point == point || self.last.point == point
    }

    /// The vertex of another point of the triangle.
    pub(super) fn vertex_of(&self, point: u32) -> Option<u32> {
        [self.next, self.last].into_iter().find(|corner| corner.point == point).map(|corner| corner.vertex)
    }
}

/// The triangles around a manifold point, each beginning at the edge at which the one before it ends.
#[derive(Debug, Clone)]
pub(super) struct Fan {
    pub(super) triangles: Vec<Ring>,
    /// Whether the last triangle ends where the first begins; otherwise the point is on a border.
    pub(super) is_closed: bool,
}

/// The triangles that have three different points.
pub(super) struct Mesh {
    corners: Vec<[Corner; 3]>,
    /// For each triangle the one of the input from which it comes, and `None` once it is removed.
    origins: Vec<Option<u32>>,
    around: Vec<Vec<u32>>,
    live: usize,
}

impl Mesh {
    /// The mesh, and the position of each point in the first pose.
    pub(super) fn new(surface: &Surface<'_>) -> (Self, Vec<[f32; 3]>) {
        let points = weld(surface.poses);
        let count = points.iter().max().map_or(0, |last| *last as usize + 1);
        let mut positions = vec![[0.0; 3]; count];
        for (vertex, point) in points.iter().enumerate() {
            positions[*point as usize] = surface.poses[0][vertex];
        }
        let around = vec![Vec::new(); count];
        let mut mesh = Self { corners: Vec::new(), origins: Vec::new(), around, live: 0 };
        for (triangle, vertices) in (0..).zip(surface.indices.chunks_exact(3)) {
            let corners = [vertices[0], vertices[1], vertices[2]]
                .map(|vertex| Corner { vertex, point: points[vertex as usize] });
            let [a, b, c] = corners.map(|corner| corner.point);
            if a != b && b != c && c != a {
                mesh.push(corners, triangle);
            }
        }
        (mesh, positions)
    }

    /// Adds a triangle that comes from one of the input.
    pub(super) fn push(&mut self, corners: [Corner; 3], origin: u32) {
        let triangle = self.corners.len() as u32;
        corners.iter().for_each(|corner| self.around[corner.point as usize].push(triangle));
        self.corners.push(corners);
        self.origins.push(Some(origin));
        self.live += 1;
    }

    /// Removes a triangle, and returns the one of the input from which it came.
    pub(super) fn remove(&mut self, triangle: u32) -> Option<u32> {
        let origin = self.origins[triangle as usize].take()?;
        for corner in self.corners[triangle as usize] {
            self.around[corner.point as usize].retain(|other| *other != triangle);
        }
        self.live -= 1;
        Some(origin)
    }

    /// Makes a triangle's corner at `from` one at another point.
    pub(super) fn turn_over(&mut self, triangle: u32, from: u32, to: Corner) {
        for corner in self.corners[triangle as usize].iter_mut().filter(|corner| corner.point == from) {
            *corner = to;
        }
        self.around[from as usize].retain(|other| *other != triangle);
        self.around[to.point as usize].push(triangle);
    }

    /// Number of triangles.
    pub(super) fn triangles(&self) -> usize {
        self.live
    }

    /// Number of points.
    pub(super) fn points(&self) -> usize {
        self.around.len()
    }

    /// The triangles, each with the one of the input from which it comes.
    pub(super) fn all(&self) -> impl Iterator<Item = (&[Corner; 3], u32)> + '_ {
        self.corners.iter().zip(&self.origins).filter_map(|(corners, origin)| Some((corners, (*origin)?)))
    }

    /// The triangle of the input from which a triangle comes; `None` if it is removed.
    pub(super) fn origin(&self, triangle: u32) -> Option<u32> {
        self.origins[triangle as usize]
    }

    pub(super) fn ring(&self, point: u32) -> impl Iterator<Item = Ring> + '_ {
        self.around[point as usize].iter().map(move |&triangle| {
            let [a, b, c] = self.corners[triangle as usize];
            let [own, next, last] = match point {
                _ if a.point == point => [a, b, c],
                _ if b.point == point => [b, c, a],
                _ => [c, a, b],
            };
            Ring { triangle, vertex: own.vertex, next, last }
        })
    }

    /// The points that share an edge with a point, ascending.
    pub(super) fn neighbors(&self, point: u32) -> Vec<u32> {
        unique(self.ring(point).flat_map(|ring| [ring.next.point, ring.last.point]))
    }

    /// The wedges of a point that triangles use, ascending.
    pub(super) fn wedges(&self, point: u32) -> Vec<u32> {
        unique(self.ring(point).map(|ring| ring.vertex))
    }

    /// The triangles around a point in order. `None` if it has none, or if it is not manifold: three triangles meet at one of
    /// its edges, two of them turn against each other, or there are several fans.
    pub(super) fn fan(&self, point: u32) -> Option<Fan> {
        let mut rings: Vec<Ring> = self.ring(point).collect();
        rings.sort_unstable_by_key(|ring| ring.next.point);
        let mut ends: Vec<u32> = rings.iter().map(|ring| ring.last.point).collect();
        ends.sort_unstable();
        let is_twice = rings.windows(2).any(|two| two[0].next.point == two[1].next.point)
            || ends.windows(2).any(|two| two[0] == two[1]);
        if is_twice {
            return None;
        }
        let first = rings.iter().find(|ring| ends.binary_search(&ring.next.point).is_err());
        let is_closed = first.is_none();
        let mut at = *first.or(rings.first())?;
        let mut triangles = vec![at];
        while let Ok(next) = rings.binary_search_by_key(&at.last.point, |ring| ring.next.point) {
            at = rings[next];
            if triangles.len() == rings.len() || at.triangle == triangles[0].triangle {
                break;
            }
            triangles.push(at);
        }
        (triangles.len() == rings.len()).then_some(Fan { triangles, is_closed })
    }

    /// The link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999) for an edge between manifold points of which `borders`
    /// says whether they are on a border: contracting it keeps the topology.
    pub(super) fn keeps_topology(&self, [a, b]: [u32; 2], borders: [bool; 2]) -> bool {
        let across: Vec<u32> = (self.ring(a).filter(|ring| ring.has(b)))
            .map(|ring| if ring.next.point == b { ring.last.point } else { ring.next.point })
            .collect();
        let [around_a, around_b] = [a, b].map(|point| self.neighbors(point));
        let common = around_a.iter().filter(|point| around_b.binary_search(point).is_ok()).count();
        if common != across.len() || (borders == [true; 2] && across.len() != 1) {
            return false;
        }
        let is_across = |ring: Ring| across.contains(&ring.next.point) && across.contains(&ring.last.point);
        let is_alone = across.len() == 1 && [a, b].iter().all(|at| self.around[*at as usize].len() == 1);
        let is_filled = self.ring(a).any(is_across) && self.ring(b).any(is_across);
        !is_alone && !is_filled
    }
}

/// Each value once, ascending.
pub(super) fn unique<T: Ord>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut all: Vec<T> = values.into_iter().collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The squared sine of the angle between two edges up to which a triangle counts as having no area. Coordinates are rounded to
/// 2⁻²⁴ of their size, so that smaller angles are noise.
const NO_AREA: f64 = 1e-12;

/// The normal of a triangle, as long as twice its area; `None` if it has none.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let (first, second) = (b - a, c - a);
    let normal = first.cross(second);
    let least = NO_AREA * first.length_squared() * second.length_squared();
    (normal.length_squared() > least).then_some(normal)
}

/// A frame in which a mesh has about unit size, around the origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    center: DVec3,
    /// A power of two, so that nothing is rounded by it.
    scale: f64,
}

impl Frame {
    pub(super) fn around(positions: &[[f32; 3]]) -> Self {
        let all = || positions.iter().map(|position| glam::Vec3::from(*position).as_dvec3());
        let low = all().fold(DVec3::INFINITY, DVec3::min);
        let high = all().fold(DVec3::NEG_INFINITY, DVec3::max);
        let size = (high - low).max_element();
        let is_sized = size > 0.0 && size.is_finite();
        let exponent = if is_sized { ((size.to_bits() >> 52) as i32) - 1023 } else { 0 };
        let scale = f64::from_bits(((1023 - exponent) as u64) << 52);
        let center = if is_sized { (low + high) * 0.5 } else { DVec3::ZERO };
        Self { center, scale }
    }

    pub(super) fn of(&self, position: [f32; 3]) -> DVec3 {
        (glam::Vec3::from(position).as_dvec3() - self.center) * self.scale
    }

    /// The position of a place in the model's units, rounded.
    pub(super) fn position(&self, place: DVec3) -> [f32; 3] {
        (place / self.scale + self.center).as_vec3().to_array()
    }

    /// A distance in the model's units.
    pub(super) fn distance(&self, distance: f64) -> f32 {
        (distance / self.scale) as f32
    }
}
