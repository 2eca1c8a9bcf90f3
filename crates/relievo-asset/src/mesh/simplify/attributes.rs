//! Cost of attribute changes (Hoppe, "New Quadric Metric for Simplifying Meshes with Appearance Attributes",
//! Visualization 1999). On each triangle, an attribute is a linear function of position.
//!
//! Weights are areas. The sums for attributes are not divided by their weights, unlike the sums for positions: a wrong
//! normal disturbs more if it shades a larger area (as in meshoptimizer). A mean would count an error on the smallest
//! triangle as much as one on the largest.
//!
//! Sums are in f32, which halves the memory traffic. For attributes that are linear over a flat surface, the cost is
//! therefore not exactly 0. The reference for this error is the cost of the same attribute change without a change of
//! position. The square root of the error can be 3 · 10⁻⁴ of the square root of the reference.

use glam::{DVec3, Vec3, Vec4};

use super::Surface;
use super::points::Points;
use super::quadric::Quadric;
use super::turned::normal;

/// Number of vectors at the start of a record. One vector per attribute follows.
const HEAD: usize = 3;

/// Attribute error of each vertex: the sum over triangles and attributes of weight × (g·d + k − s)². Here g is the
/// gradient of the attribute, and k its accumulated constant difference. A replacement differs from the vertex by d in
/// position and by s in the attribute.
pub(crate) struct Attributes<'a> {
    values: &'a [f32],
    stride: usize,
    /// One record per vertex. Its first three vectors hold the quadric dᵀ A d + 2 b·d + c of all terms without s: (A's
    /// xx, xy, xz, yy), (yz, zz, c, sum of weights) and (b, 0). One vector per attribute follows, with the weighted
    /// sums of g (x, y, z) and k (w).
    records: Vec<Vec4>,
}

/// The attribute error of one vertex, from which the cost of replacing the vertex is computed.
pub(crate) struct Own<'a> {
    head: [Vec4; HEAD],
    sums: &'a [Vec4],
    values: &'a [f32],
}

/// Summed attribute errors of several vertices at one position.
#[derive(Default)]
pub(crate) struct Joint<'a> {
    record: Vec<Vec4>,
    values: &'a [f32],
}

impl<'a> Own<'a> {
    #[inline]
    fn new(record: &'a [Vec4], values: &'a [f32]) -> Self {
        let (head, sums) = record.split_at(HEAD);
        Self { head: [head[0], head[1], head[2]], sums, values }
    }

    /// Sum of two quadrics. The first is a point's quadric `shape`, divided by its weight. The second is the part of
    /// the attribute error that does not depend on the replacement's attributes.
    #[inline]
    pub(crate) fn with(&self, shape: &Quadric) -> Quadric {
        let [first, second, b] = self.head.map(|four| four.as_dvec4());
        let a = [first.x, first.y, first.z, first.w, second.x, second.y];
        shape.mean_plus(a, b.truncate(), second.z)
    }

    /// The part of the cost that depends on the replacement's attributes `values`. The replacement is at the offset `d`.
    #[inline]
    pub(crate) fn change(&self, values: &[f32], d: Vec3) -> f32 {
        let (mut sum, mut squares) = (Vec4::ZERO, 0.0);
        if let ([to_x, to_y, to_z], [x, y, z], [a, b, c]) = (values, self.values, self.sums) {
            // Special case of three attributes, such as a normal.
            let [x, y, z] = [to_x - x, to_y - y, to_z - z];
            sum = *a * x + *b * y + *c * z;
            squares = x * x + y * y + z * z;
        } else {
            for ((to, from), more) in values.iter().zip(self.values).zip(self.sums) {
                let s = to - from;
                sum += *more * s;
                squares += s * s;
            }
        }
        squares * self.head[1].w - 2.0 * at(sum, d)
    }

    /// Half the gradient of a part of the cost, at the offset `d`. This part does not depend on the replacement's
    /// attributes.
    #[inline]
    fn slope(&self, d: Vec3) -> Vec3 {
        let [first, second, b] = self.head;
        let [x, y, z] = [
            first.x * d.x + first.y * d.y + first.z * d.z,
            first.y * d.x + first.w * d.y + second.x * d.z,
            first.z * d.x + second.x * d.y + second.y * d.z,
        ];
        Vec3::new(x + b.x, y + b.y, z + b.z)
    }

    /// Cost of a replacement with the attributes `values` at the offset `d`.
    #[inline]
    fn cost(&self, values: &[f32], d: Vec3) -> f32 {
        let [_, second, b] = self.head;
        let twice = self.slope(d) + b.truncate();
        let same = twice.x * d.x + twice.y * d.y + twice.z * d.z + second.z;
        (same + self.change(values, d)).max(0.0)
    }
}

/// The linear function g·d + k of one attribute.
#[inline]
fn at(sum: Vec4, d: Vec3) -> f32 {
    // The order of operations is fixed, so that the result is the same on every machine.
    let [x, y, z, k] = (sum * d.extend(1.0)).to_array();
    x + y + z + k
}

impl<'a> Attributes<'a> {
    pub(crate) fn new(surface: &Surface<'a>, points: &Points) -> Self {
        let (values, stride) = (surface.attributes, surface.stride);
        let records = vec![Vec4::ZERO; values.len() / stride * (HEAD + stride)];
        let mut attributes = Self { values, stride, records };
        for &vertices in surface.indices.as_chunks().0 {
            let [a, b, c] = vertices;
            let position = |vertex: u32| points.position(points.of(vertex), 0);
            let positions = [position(a), position(b), position(c)];
            if let Ok(normal) = normal(positions) {
                attributes.add_triangle(vertices, positions, normal);
            }
        }
        attributes
    }

    fn record(&mut self, vertex: u32) -> &mut [Vec4] {
        let len = HEAD + self.stride;
        &mut self.records[vertex as usize * len..][..len]
    }

    /// Adds a triangle to the records of its vertices. The length of `normal` is twice the triangle's area.
    fn add_triangle(&mut self, vertices: [u32; 3], positions: [DVec3; 3], normal: DVec3) {
        let [first, second] = [positions[1] - positions[0], positions[2] - positions[0]];
        let (square, weight) = (normal.length_squared(), normal.length() * 0.5);
        // The gradient lies in the triangle's plane. Along the two edges, it gives the attribute differences b − a and
        // c − a.
        let [along_first, along_second] = [second.cross(normal) / square, normal.cross(first) / square];
        let [a, b, c] = vertices;
        let [own_a, own_b, own_c] = [self.values_of(a), self.values_of(b), self.values_of(c)];
        let [mut first_row, mut others] = [DVec3::ZERO; 2];
        for (attribute, ((a, b), c)) in own_a.iter().zip(own_b).zip(own_c).enumerate() {
            let [a, b, c] = [f64::from(*a), f64::from(*b), f64::from(*c)];
            let gradient = along_first * (b - a) + along_second * (c - a);
            let weighted = gradient * weight;
            first_row += gradient * weighted.x;
            others += DVec3::new(gradient.y, gradient.y, gradient.z)
                * DVec3::new(weighted.y, weighted.z, weighted.z);
            let more = weighted.as_vec3().extend(0.0);
            vertices.iter().for_each(|vertex| self.record(*vertex)[HEAD + attribute] += more);
        }
        let (row, [yy, yz, zz]) = (first_row.as_vec3(), others.as_vec3().to_array());
        let [first, second] = [row.extend(yy), Vec4::new(yz, zz, 0.0, weight as f32)];
        for vertex in vertices {
            let record = self.record(vertex);
            record[0] += first;
            record[1] += second;
        }
    }

    /// Cost of replacing `vertex` by `target`, which is at the offset `d`.
    pub(crate) fn cost(&self, vertex: u32, target: u32, d: DVec3) -> f64 {
        f64::from(self.of(vertex).cost(self.values_of(target), d.as_vec3()))
    }

    /// Attributes of a vertex, as given in [`Surface::attributes`].
    #[inline]
    pub(crate) fn values_of(&self, vertex: u32) -> &'a [f32] {
        &self.values[vertex as usize * self.stride..][..self.stride]
    }

    /// Reads the start and the end of a vertex's record to prefetch it. The returned number only prevents the compiler
    /// from dropping the reads.
    #[inline]
    pub(crate) fn touch(&self, vertex: u32) -> u32 {
        let own = self.of(vertex);
        own.head[0].x.to_bits() ^ own.sums.last().map_or(0, |last| last.w.to_bits())
    }

    /// The attribute error of one vertex, from which the cost of replacing the vertex is computed.
    #[inline]
    pub(crate) fn of(&self, vertex: u32) -> Own<'_> {
        let len = HEAD + self.stride;
        Own::new(&self.records[vertex as usize * len..][..len], self.values_of(vertex))
    }

    /// Cost of removing the triangles of the given vertices: the triangles' area times the variance of the vertices'
    /// attributes.
    pub(crate) fn lost<I: Iterator<Item = u32>>(&self, vertices: impl Fn() -> I) -> f64 {
        let weight = |vertex: u32| f64::from(self.of(vertex).head[1].w);
        let weights: f64 = vertices().map(weight).sum();
        let mut variance = 0.0;
        for attribute in 0..self.stride {
            let value = |vertex: u32| f64::from(self.values_of(vertex)[attribute]);
            let mean = vertices().map(|vertex| weight(vertex) * value(vertex)).sum::<f64>() / weights;
            variance += vertices().map(|vertex| weight(vertex) * (value(vertex) - mean).powi(2)).sum::<f64>();
        }
        // Each triangle is counted three times, once per vertex.
        if weights > 0.0 { variance / 3.0 } else { 0.0 }
    }

    /// Merges the record of `vertex` into the record of `target`, which is at the offset `d`.
    pub(crate) fn merge(&mut self, vertex: u32, target: u32, d: DVec3) {
        let len = HEAD + self.stride;
        let (own, values) = (self.values_of(vertex), self.values_of(target));
        let [from, to] = [vertex, target].map(|vertex| vertex as usize * len);
        let Ok([from, to]) = self.records.get_disjoint_mut([from..from + len, to..to + len]) else { return };
        add_moved(to, &Own::new(from, own), values, d.as_vec3());
    }

    /// Sums several vertices at one position into `joint`, as if they were one vertex with the first vertex's
    /// attributes.
    pub(crate) fn join(&self, vertices: impl IntoIterator<Item = u32>, joint: &mut Joint<'a>) {
        joint.record.clear();
        joint.record.resize(HEAD + self.stride, Vec4::ZERO);
        for (at, vertex) in vertices.into_iter().enumerate() {
            if at == 0 {
                joint.values = self.values_of(vertex);
            }
            add_moved(&mut joint.record, &self.of(vertex), joint.values, Vec3::ZERO);
        }
    }

    /// As [`Self::cost`], but for several vertices at one position.
    pub(crate) fn joint_cost(&self, joint: &Joint<'a>, target: u32, d: DVec3) -> f64 {
        f64::from(Own::new(&joint.record, joint.values).cost(self.values_of(target), d.as_vec3()))
    }
}

/// Adds a vertex to the record of its replacement. The replacement has the attributes `values` and is at the offset `d`.
fn add_moved(record: &mut [Vec4], own: &Own<'_>, values: &[f32], d: Vec3) {
    let ([first, mut second, _], mut slope) = (own.head, own.slope(d).extend(0.0));
    let sums = own.sums.iter().zip(&mut record[HEAD..]);
    for ((to_value, from_value), (sum, to_sum)) in values.iter().zip(own.values).zip(sums) {
        let s = to_value - from_value;
        slope -= *sum * s;
        let mut more = *sum;
        more.w = at(*sum, d) - second.w * s;
        *to_sum += more;
    }
    slope.w = 0.0;
    second.z = own.cost(values, d);
    record.iter_mut().zip([first, second, slope]).for_each(|(sum, more)| *sum += more);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a vertex that is replaced twice, the cost equals the sum computed directly.
    #[test]
    fn it_sums_squared_differences_from_linear_functions() {
        let positions =
            [[0.0, 0.0, 0.0], [2.0, 0.5, 0.0], [0.0, 1.0, 1.0], [-1.0, 0.25, 0.5], [0.5, -2.0, 1.5]];
        let values: [f32; 10] = [0.0, 1.0, 3.0, -1.0, 0.5, 0.25, -2.0, 1.5, 0.75, 2.0];
        let indices = [0, 1, 2, 0, 2, 3, 0, 3, 4];
        let points = Points::new(&[positions.to_vec()]);
        let position = |point| points.position(point, 0);
        let surface =
            Surface { poses: &[positions.to_vec()], indices: &indices, attributes: &values, stride: 2 };
        let mut attributes = Attributes::new(&surface, &points);
        let value = |vertex: u32, attribute: usize| f64::from(values[vertex as usize * 2 + attribute]);
        // Squared difference between the attributes at a vertex and their linear functions on a triangle, times the
        // triangle's area. Vertices may be on or off the triangle's plane.
        let off = |triangle: usize, to: u32| -> f64 {
            let corners = [0, 1, 2].map(|at| indices[triangle * 3 + at]);
            let [a, b, c] = corners.map(position);
            let (first, second, d) = (b - a, c - a, position(to) - a);
            let gram = first.length_squared() * second.length_squared() - first.dot(second).powi(2);
            let u = (d.dot(first) * second.length_squared() - d.dot(second) * first.dot(second)) / gram;
            let v = (d.dot(second) * first.length_squared() - d.dot(first) * first.dot(second)) / gram;
            let square = |attribute| {
                let [a, b, c] = corners.map(|vertex| value(vertex, attribute));
                (a + u * (b - a) + v * (c - a) - value(to, attribute)).powi(2)
            };
            0.5 * first.cross(second).length() * (square(0) + square(1))
        };
        let close = |a: f64, b: f64| (a - b).abs() < 1e-5 * (1.0 + b);
        let direct = attributes.cost(0, 3, position(3) - position(0));
        assert!(close(direct, off(0, 3)), "{direct}");
        attributes.merge(0, 3, position(3) - position(0));
        // Before the merges, vertex 0 belonged to all three triangles, and vertex 3 to the last two.
        let cost = attributes.cost(3, 4, position(4) - position(3));
        let expected = off(0, 4) + 2.0 * off(1, 4);
        assert!(close(cost, expected), "{cost} {expected}");
        attributes.merge(3, 1, position(1) - position(3));
        let cost = attributes.cost(1, 2, position(2) - position(1));
        assert!(close(cost, 2.0 * off(2, 2)), "{cost}");
    }

    /// The joint cost of vertices at one position is the sum of their single costs.
    #[test]
    fn several_vertices_are_replaced_at_once() {
        let turn = |at: f32| [at.cos(), at.sin(), 0.1 * at];
        let positions: Vec<[f32; 3]> =
            (0..24).map(|at| if at < 12 { [0.0; 3] } else { turn(at as f32 * 0.5) }).collect();
        let values: Vec<f32> = (0..48).map(|at| ((at * 7) % 11) as f32 * 0.25).collect();
        let indices: Vec<u32> = (0..11).flat_map(|at| [at, at + 12, at + 13]).collect();
        let poses = [positions];
        let points = Points::new(&poses);
        let surface = Surface { poses: &poses, indices: &indices, attributes: &values, stride: 2 };
        let attributes = Attributes::new(&surface, &points);
        let mut joint = Joint::default();
        attributes.join(0..11, &mut joint);
        for target in 12..23 {
            let d = points.position(points.of(target), 0);
            let sum: f64 = (0..11).map(|vertex| attributes.cost(vertex, target, d)).sum();
            let together = attributes.joint_cost(&joint, target, d);
            assert!(sum > 1.0 && (together - sum).abs() < 1e-5 * sum, "{together} and {sum}");
        }
    }
}
