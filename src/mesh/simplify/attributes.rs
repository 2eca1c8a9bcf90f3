//! The cost of changes in attributes (Hoppe, "New Quadric Metric for Simplifying Meshes with Appearance
//! Attributes", Visualization 1999): on each triangle an attribute is a linear function of position.
//!
//! Weights are areas, and the sums are not divided by them, as those of positions are: a wrong normal disturbs by the
//! area that it shades (so does meshoptimizer). A mean would count it in the smallest triangle as much as in the largest.

use glam::DVec3;

use super::Surface;
use super::points::Points;
use super::quadric::Quadric;
use super::turned::normal;

/// For each vertex, the sum over triangles and attributes of weight × (g·d + k − s)². Here g is the gradient of
/// the attribute, k its accumulated constant difference, and d and s are the differences in position and
/// attribute from the vertex.
pub(crate) struct Attributes<'a> {
    values: &'a [f32],
    stride: usize,
    /// The part without s, and the sums of weights.
    quadrics: Vec<Quadric>,
    /// For each attribute, the weighted sums of g and of k.
    sums: Vec<(DVec3, f64)>,
}

/// What the costs of replacing a vertex depend on.
pub(crate) struct Own<'a> {
    quadric: &'a Quadric,
    sums: &'a [(DVec3, f64)],
    values: &'a [f32],
}

impl Own<'_> {
    /// The sum of the mean of a point's quadric and of the part of this one that does not depend on the replacement's
    /// attributes.
    #[inline]
    pub(crate) fn with(&self, shape: &Quadric) -> Quadric {
        shape.mean_plus(self.quadric)
    }

    /// The part of the cost that depends on the attributes of the replacement, which is `d` away.
    #[inline]
    pub(crate) fn change(&self, values: &[f32], d: DVec3) -> f64 {
        let mut cost = 0.0;
        for ((to, from), (gradient, lost)) in values.iter().zip(self.values).zip(self.sums) {
            let s = f64::from(*to) - f64::from(*from);
            cost += s * (s * self.quadric.weight - 2.0 * (gradient.dot(d) + lost));
        }
        cost
    }
}

impl<'a> Attributes<'a> {
    pub(crate) fn new(surface: &Surface<'a>, points: &Points) -> Self {
        let (values, stride) = (surface.attributes, surface.stride);
        let quadrics = vec![Quadric::default(); values.len() / stride];
        let sums = vec![(DVec3::ZERO, 0.0); values.len()];
        let mut attributes = Self { values, stride, quadrics, sums };
        for triangle in surface.indices.chunks_exact(3) {
            let vertices = [0, 1, 2].map(|corner| triangle[corner]);
            let positions = vertices.map(|vertex| points.position(points.of(vertex), 0));
            if let Ok(normal) = normal(positions) {
                attributes.add_triangle(vertices, positions, normal);
            }
        }
        attributes
    }

    #[inline]
    fn value(&self, vertex: u32, attribute: usize) -> f64 {
        f64::from(self.values[vertex as usize * self.stride + attribute])
    }

    /// Adds a triangle; `normal` has twice the triangle's area as its length.
    fn add_triangle(&mut self, vertices: [u32; 3], positions: [DVec3; 3], normal: DVec3) {
        let [first, second] = [positions[1] - positions[0], positions[2] - positions[0]];
        let (square, weight) = (normal.length_squared(), normal.length() * 0.5);
        let mut quadric = Quadric::linear(DVec3::ZERO, weight);
        for attribute in 0..self.stride {
            let [a, b, c] = vertices.map(|vertex| self.value(vertex, attribute));
            // The gradient lies in the triangle's plane and gives the differences of b − a and c − a along its
            // edges.
            let gradient = (second.cross(normal) * (b - a) + normal.cross(first) * (c - a)) / square;
            quadric.add_unweighted(&Quadric::linear(gradient, weight));
            for vertex in vertices {
                self.sums[vertex as usize * self.stride + attribute].0 += gradient * weight;
            }
        }
        vertices.iter().for_each(|vertex| self.quadrics[*vertex as usize].add(&quadric));
    }

    /// The cost of replacing `vertex` by `target`, which is `d` away.
    pub(crate) fn cost(&self, vertex: u32, target: u32, d: DVec3) -> f64 {
        let quadric = &self.quadrics[vertex as usize];
        let mut cost = quadric.at(d);
        for attribute in 0..self.stride {
            let s = self.value(target, attribute) - self.value(vertex, attribute);
            let (gradient, lost) = self.sums[vertex as usize * self.stride + attribute];
            cost += s * (s * quadric.weight - 2.0 * (gradient.dot(d) + lost));
        }
        cost.max(0.0)
    }

    /// The attributes of a vertex, in no unit.
    #[inline]
    pub(crate) fn values_of(&self, vertex: u32) -> &[f32] {
        &self.values[vertex as usize * self.stride..][..self.stride]
    }

    /// What the costs of replacing a vertex depend on.
    #[inline]
    pub(crate) fn of(&self, vertex: u32) -> Own<'_> {
        Own {
            quadric: &self.quadrics[vertex as usize],
            sums: &self.sums[vertex as usize * self.stride..][..self.stride],
            values: self.values_of(vertex),
        }
    }

    /// Replaces `vertex` by `target`, which is `d` away.
    pub(crate) fn merge(&mut self, vertex: u32, target: u32, d: DVec3) {
        let cost = self.cost(vertex, target, d);
        let [from, to] = [vertex, target].map(|vertex| vertex as usize * self.stride);
        let weight = self.quadrics[vertex as usize].weight;
        let mut gradients = DVec3::ZERO;
        for attribute in 0..self.stride {
            let s = self.value(target, attribute) - self.value(vertex, attribute);
            let (gradient, lost) = self.sums[from + attribute];
            gradients += gradient * s;
            let sum = &mut self.sums[to + attribute];
            sum.0 += gradient;
            sum.1 += gradient.dot(d) + lost - weight * s;
        }
        let moved = self.quadrics[vertex as usize].moved_by(d, gradients, cost);
        self.quadrics[target as usize].add(&moved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The result equals the sum written out, for a vertex that is replaced twice.
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
        // The difference between each attribute's plane through a triangle's corners and the attribute at a
        // vertex, on the plane or off it.
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
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12 * (1.0 + b);
        let direct = attributes.cost(0, 3, position(3) - position(0));
        assert!(close(direct, off(0, 3)), "{direct}");
        attributes.merge(0, 3, position(3) - position(0));
        // Only vertex 3 belonged to the last two triangles.
        let cost = attributes.cost(3, 4, position(4) - position(3));
        let expected = off(0, 4) + 2.0 * off(1, 4);
        assert!(close(cost, expected), "{cost} {expected}");
        attributes.merge(3, 1, position(1) - position(3));
        let cost = attributes.cost(1, 2, position(2) - position(1));
        assert!(close(cost, 2.0 * off(2, 2)), "{cost}");
    }
}
