//! How far attributes are from what they were (Hoppe, "New Quadric Metric for Simplifying Meshes with Appearance
//! Attributes", Visualization 1999): on each triangle an attribute is a linear function of the place.

use glam::DVec3;

use super::quadric::Quadric;
use super::topology::Topology;
use super::turned::normal;

/// Of each vertex, the sum over triangles of weight × Σ (g·d + k − s)²: g an attribute's gradient, k what it has lost
/// by then, d and s how far place and attribute are from those of the vertex.
pub struct Attributes<'a> {
    values: &'a [f32],
    stride: usize,
    /// The part without s, and the weights.
    quadrics: Vec<Quadric>,
    /// Of each attribute: the weighted sums of g and k.
    sums: Vec<(DVec3, f64)>,
}

impl<'a> Attributes<'a> {
    /// `place` gives each point's place.
    pub fn new(
        topology: &Topology,
        triangles: u32,
        place: impl Fn(u32) -> DVec3,
        values: &'a [f32],
        stride: usize,
    ) -> Self {
        let vertices = values.len() / stride;
        let quadrics = vec![Quadric::default(); vertices];
        let sums = vec![(DVec3::ZERO, 0.0); values.len()];
        let mut attributes = Self { values, stride, quadrics, sums };
        for triangle in 0..triangles {
            let corners = topology.corners(triangle);
            let places = corners.map(|corner| place(corner.point));
            if let Ok(normal) = normal(places) {
                attributes.add_triangle(corners.map(|corner| corner.vertex), places, normal);
            }
        }
        attributes
    }

    fn value(&self, vertex: u32, attribute: usize) -> f64 {
        f64::from(self.values[vertex as usize * self.stride + attribute])
    }

    /// `normal` is twice its area long.
    fn add_triangle(&mut self, vertices: [u32; 3], places: [DVec3; 3], normal: DVec3) {
        let [first, second] = [places[1] - places[0], places[2] - places[0]];
        let (square, weight) = (normal.length_squared(), normal.length() * 0.5);
        let mut quadric = Quadric::linear(DVec3::ZERO, weight);
        for attribute in 0..self.stride {
            let [a, b, c] = vertices.map(|vertex| self.value(vertex, attribute));
            // Along the triangle, and b − a and c − a along its edges.
            let gradient = (second.cross(normal) * (b - a) + normal.cross(first) * (c - a)) / square;
            quadric.add_unweighted(&Quadric::linear(gradient, weight));
            for vertex in vertices {
                self.sums[vertex as usize * self.stride + attribute].0 += gradient * weight;
            }
        }
        vertices.iter().for_each(|vertex| self.quadrics[*vertex as usize].add(&quadric));
    }

    pub fn weight(&self, vertex: u32) -> f64 {
        self.quadrics[vertex as usize].weight
    }

    /// The sum where a vertex becomes another, `d` away.
    pub fn cost(&self, vertex: u32, heir: u32, d: DVec3) -> f64 {
        let quadric = &self.quadrics[vertex as usize];
        let mut cost = quadric.at(d);
        for attribute in 0..self.stride {
            let s = self.value(heir, attribute) - self.value(vertex, attribute);
            let (gradient, lost) = self.sums[vertex as usize * self.stride + attribute];
            cost += s * (s * quadric.weight - 2.0 * (gradient.dot(d) + lost));
        }
        cost.max(0.0)
    }

    /// A vertex becomes another, `d` away.
    pub fn merge(&mut self, vertex: u32, heir: u32, d: DVec3) {
        let cost = self.cost(vertex, heir, d);
        let [from, to] = [vertex, heir].map(|vertex| vertex as usize * self.stride);
        let weight = self.weight(vertex);
        let mut gradients = DVec3::ZERO;
        for attribute in 0..self.stride {
            let s = self.value(heir, attribute) - self.value(vertex, attribute);
            let (gradient, lost) = self.sums[from + attribute];
            gradients += gradient * s;
            let sum = &mut self.sums[to + attribute];
            sum.0 += gradient;
            sum.1 += gradient.dot(d) + lost - weight * s;
        }
        let moved = self.quadrics[vertex as usize].moved_by(d, gradients, cost);
        self.quadrics[heir as usize].add(&moved);
    }
}
