//! Points: groups of vertices that share one position in every pose.

use glam::DVec3;

use crate::asset::tangents::Adjacency;

/// Vertices grouped into points by their positions in all poses. Points are numbered in the order of their first
/// vertices.
pub(crate) struct Points {
    of: Vec<u32>,
    /// For each point, the range of its vertices in `wedges`.
    ranges: Vec<[u32; 2]>,
    wedges: Vec<u32>,
    poses: usize,
    /// Positions of the points, multiplied by `scale`. All poses of point 0 come first.
    positions: Vec<[f32; 3]>,
    scale: f64,
    /// Largest edge of the bounding box of any pose, multiplied by `scale`.
    extent: f64,
    are_vertices: bool,
    /// Rigid body of each point, or [`NO_BODY`]. Empty if the mesh has no rigid bodies.
    bodies: Vec<u32>,
    /// Chart of each vertex. Its identifier is the first vertex of the same point on this chart. No seam separates
    /// vertices of one chart. Empty if every vertex is its own chart.
    charts: Vec<u32>,
}

/// Marks a vertex or point that belongs to no rigid body.
#[doc(hidden)]
pub const NO_BODY: u32 = u32::MAX;

impl Points {
    pub(crate) fn new(poses: &[Vec<[f32; 3]>]) -> Self {
        let of = weld(poses);
        let count = of.iter().max().map_or(0, |last| *last as usize + 1);
        let Adjacency { offsets, corners: wedges } = Adjacency::new(count, &of);
        let firsts = offsets[..count].iter().map(|start| wedges[*start as usize] as usize);
        let extent = extent(poses);
        let scale = scale(extent);
        let scaled = |position: [f32; 3]| position.map(|x| (f64::from(x) * scale) as f32);
        let positions =
            firsts.flat_map(|vertex| poses.iter().map(move |pose| scaled(pose[vertex]))).collect();
        let ranges = offsets.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        let are_vertices = count == of.len();
        Self {
            of,
            ranges,
            wedges,
            poses: poses.len(),
            positions,
            scale,
            extent: extent * scale,
            are_vertices,
            bodies: Vec::new(),
            charts: Vec::new(),
        }
    }

    /// Adds charts to the points. Two vertices of a point are on one chart if their attributes from index `first` on
    /// are equal. Their other attributes may differ.
    pub(crate) fn on_charts(mut self, attributes: &[f32], stride: usize, first: usize) -> Self {
        // Adding 0 turns −0 into +0.
        let held = |vertex: u32| {
            let own = &attributes[vertex as usize * stride..][..stride];
            own.iter().skip(first).map(|number| (number + 0.0).to_bits())
        };
        let chart = |vertex: u32| {
            let mut wedges = self.wedges(self.of(vertex)).iter().copied();
            wedges.find(|other| held(*other).eq(held(vertex))).unwrap_or(vertex)
        };
        self.charts = (0..self.of.len() as u32).map(chart).collect();
        self
    }

    /// Chart of a vertex. Two vertices of a point have the same chart if no seam is between them.
    #[inline]
    pub(crate) fn chart(&self, vertex: u32) -> u32 {
        self.charts.get(vertex as usize).copied().unwrap_or(vertex)
    }

    /// Whether charts are known, so that several vertices of a point may be on one chart.
    #[inline]
    pub(crate) fn has_charts(&self) -> bool {
        !self.charts.is_empty()
    }

    /// Adds rigid bodies to the points. `bodies` has the body of each vertex, or [`NO_BODY`]. Vertices of one body keep
    /// their distances from each other in every pose.
    pub(crate) fn on_bodies(mut self, bodies: &[u32]) -> Self {
        let of_point = |point: u32| {
            let mut wedges = self.wedges(point).iter().map(|vertex| bodies[*vertex as usize]);
            let first = wedges.next().unwrap_or(NO_BODY);
            if wedges.all(|other| other == first) { first } else { NO_BODY }
        };
        self.bodies = (0..self.len() as u32).map(of_point).collect();
        self
    }

    /// Rigid body of a point, or [`NO_BODY`].
    #[inline]
    pub(crate) fn body(&self, point: u32) -> u32 {
        self.bodies.get(point as usize).copied().unwrap_or(NO_BODY)
    }

    /// Rigid body that all of the points belong to, or [`NO_BODY`] if there is none.
    #[inline]
    pub(crate) fn common_body(&self, points: &[u32]) -> u32 {
        match points {
            [first, others @ ..] if !self.bodies.is_empty() => {
                let body = self.body(*first);
                if others.iter().all(|other| self.body(*other) == body) { body } else { NO_BODY }
            }
            _ => NO_BODY,
        }
    }

    /// Number of leading poses to examine for distances between two bodies. One pose is enough if both are the same body.
    #[inline]
    pub(crate) fn poses_between(&self, body: u32, other: u32) -> usize {
        if body == other && body != NO_BODY { 1 } else { self.poses }
    }

    /// Number of points.
    pub(crate) fn len(&self) -> usize {
        self.ranges.len()
    }

    pub(crate) fn poses(&self) -> usize {
        self.poses
    }

    /// The point that a vertex belongs to.
    pub(crate) fn of(&self, vertex: u32) -> u32 {
        self.of[vertex as usize]
    }

    /// Vertices of a point, in ascending order.
    pub(crate) fn wedges(&self, point: u32) -> &[u32] {
        let [start, end] = self.ranges[point as usize];
        &self.wedges[start as usize..end as usize]
    }

    /// Power-of-two factor from the mesh's units to scaled units, in which the mesh has a size between 1 and 2.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Largest edge of the bounding box of any pose, in scaled units: between 1 and 2, or 0.
    pub(crate) fn extent(&self) -> f64 {
        self.extent
    }

    /// Reads the position of a point to prefetch it. The returned number only prevents the compiler from dropping the
    /// read.
    #[inline]
    pub(crate) fn touch(&self, point: u32) -> u32 {
        self.positions[point as usize * self.poses][0].to_bits()
    }

    /// Whether every vertex has its own position. If so, the mesh has no seams.
    pub(crate) fn are_vertices(&self) -> bool {
        self.are_vertices
    }

    /// The only vertex of a point; `None` if the point has several vertices.
    #[inline]
    pub(crate) fn only_wedge(&self, point: u32) -> Option<u32> {
        if self.are_vertices {
            return Some(point);
        }
        let [start, end] = self.ranges[point as usize];
        (end == start + 1).then(|| self.wedges[start as usize])
    }

    /// Position of a point in a pose, in scaled units.
    #[inline]
    pub(crate) fn position(&self, point: u32, pose: usize) -> DVec3 {
        let [x, y, z] = self.positions[point as usize * self.poses + pose];
        DVec3::new(f64::from(x), f64::from(y), f64::from(z))
    }

    /// For each vertex, the index of its point.
    pub(crate) fn into_of(self) -> Vec<u32> {
        self.of
    }
}

/// For each vertex, the index of its point.
fn weld(poses: &[Vec<[f32; 3]>]) -> Vec<u32> {
    // Adding 0 turns −0 into +0.
    let bits = |pose: &[[f32; 3]], vertex: usize| pose[vertex].map(|x| (x + 0.0).to_bits());
    let same = |a: usize, b: usize| poses.iter().all(|pose| bits(pose, a) == bits(pose, b));
    let vertices = poses[0].len();
    // Hash table with open addressing: each slot has the first vertex at a position. At most half of the slots are
    // occupied.
    let slots = (2 * vertices).next_power_of_two();
    let mut firsts = vec![u32::MAX; slots];
    let mut of = Vec::with_capacity(vertices);
    let mut count = 0;
    for vertex in 0..vertices {
        let mut slot = hash(bits(&poses[0], vertex)) as usize & (slots - 1);
        while firsts[slot] != u32::MAX && !same(firsts[slot] as usize, vertex) {
            slot = (slot + 1) & (slots - 1);
        }
        if firsts[slot] == u32::MAX {
            firsts[slot] = vertex as u32;
            of.push(count);
            count += 1;
        } else {
            of.push(of[firsts[slot] as usize]);
        }
    }
    of
}

/// Hashes a position for the hash table (multipliers and shifts of MurmurHash2, Austin Appleby, public domain).
fn hash(words: [u32; 3]) -> u32 {
    const MIX: u32 = 0x5bd1_e995;
    let mixed = words.iter().fold(0_u32, |hash, word| {
        let word = word.wrapping_mul(MIX);
        hash.wrapping_mul(MIX) ^ (word ^ (word >> 24)).wrapping_mul(MIX)
    });
    let mixed = (mixed ^ (mixed >> 13)).wrapping_mul(MIX);
    mixed ^ (mixed >> 15)
}

/// Largest edge of the bounding box of any pose, in the mesh's units.
fn extent(poses: &[Vec<[f32; 3]>]) -> f64 {
    let mut largest = 0.0_f64;
    for pose in poses {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for position in pose {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis]);
                high[axis] = high[axis].max(position[axis]);
            }
        }
        let edges = (0..3).map(|axis| f64::from(high[axis]) - f64::from(low[axis]));
        largest = edges.fold(largest, f64::max);
    }
    largest
}

/// Power of two that scales a length to between 1 and 2. Multiplying by it causes no rounding.
fn scale(largest: f64) -> f64 {
    if largest <= 0.0 {
        return 1.0;
    }
    // With e as its exponent bits, `largest` is between 2^(e − 1023) and twice this value. The result is 2^(1023 − e).
    // It does not overflow, because lengths in f32 never reach the ends of f64's range.
    f64::from_bits((2046 - ((largest.to_bits() >> 52) & 0x7ff)) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wedges_are_at_one_position_in_every_pose() {
        let rest = vec![[0.0; 3], [1.0; 3], [-0.0; 3], [0.0; 3], [1.0; 3], [0.0; 3], [0.0; 3]];
        let mut posed = rest.clone();
        posed[3] = [2.0; 3];
        posed[5] = [2.0; 3];
        posed[6] = [3.0; 3];
        let points = Points::new(&[rest, posed]);
        assert_eq!(points.len(), 4);
        assert_eq!([0, 1, 2, 3].map(|point| points.wedges(point)), [&[0, 2][..], &[1, 4], &[3, 5], &[6]]);
        assert_eq!([0, 1].map(|pose| points.position(2, pose)), [DVec3::ZERO, DVec3::splat(1.0)]);
        assert_eq!(points.scale(), 0.5);
        assert_eq!(points.into_of(), [0, 1, 0, 2, 1, 2, 3]);
    }
}
