//! Measurements of simplified meshes.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use crate::shapes::Shape;

/// Counts of edges and points: uses of edges, borders, and the Euler characteristic V − E + F.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Topology {
    pub is_manifold: bool,
    /// The largest number of triangles on one side of an edge.
    pub most_uses: usize,
    /// The number of edges with one triangle.
    pub border: usize,
    pub euler: i64,
}

impl Topology {
    /// Of points, three a triangle: manifold where no edge is used twice in one direction, and the triangles around each
    /// point are connected by edges at it.
    pub fn of(indices: &[u32]) -> Self {
        let mut edges = HashMap::new();
        let mut around: HashMap<u32, Vec<[u32; 2]>> = HashMap::new();
        for triangle in indices.chunks_exact(3) {
            for at in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|corner| triangle[(at + corner) % 3]);
                *edges.entry([a, b]).or_insert(0) += 1;
                around.entry(a).or_default().push([b, c]);
            }
        }
        let most_uses = edges.values().copied().max().unwrap_or(0);
        let is_manifold = most_uses <= 1 && around.values().all(|fan| is_connected(fan));
        let border = edges.keys().filter(|[a, b]| !edges.contains_key(&[*b, *a])).count();
        let undirected = (edges.len() + border) / 2;
        let euler = around.len() as i64 - undirected as i64 + (indices.len() / 3) as i64;
        Self { is_manifold, most_uses, border, euler }
    }
}

fn is_connected(fan: &[[u32; 2]]) -> bool {
    let mut reached = HashSet::from([0]);
    let mut open = vec![0];
    while let Some(at) = open.pop() {
        for (other, [from, to]) in fan.iter().enumerate() {
            if (fan[at][1] == *from || fan[at][0] == *to) && reached.insert(other) {
                open.push(other);
            }
        }
    }
    reached.len() == fan.len()
}

/// The topology of triangles whose vertices at one place count as one.
pub fn topology(shape: &Shape, indices: &[u32]) -> Topology {
    let points = shape.points();
    Topology::of(&indices.iter().map(|index| points[*index as usize]).collect::<Vec<_>>())
}

fn place(shape: &Shape, pose: usize, vertex: u32) -> DVec3 {
    glam::Vec3::from(shape.poses[pose][vertex as usize]).as_dvec3()
}

/// The distances of all vertices from the triangles `indices` in a pose: root mean square, and largest.
pub fn distances(shape: &Shape, pose: usize, indices: &[u32]) -> [f64; 2] {
    from_triangles(shape, pose, shape, indices)
}

/// The distances of all vertices of one shape from another in their first poses: root mean square, and largest.
pub fn distances_between(shape: &Shape, other: &Shape) -> [f64; 2] {
    from_triangles(shape, 0, other, &other.indices)
}

fn from_triangles(shape: &Shape, pose: usize, other: &Shape, indices: &[u32]) -> [f64; 2] {
    let corners =
        indices.chunks_exact(3).map(|triangle| [0, 1, 2].map(|at| place(other, pose, triangle[at])));
    let triangles: Vec<[DVec3; 3]> = corners.collect();
    let squares = (0..shape.uv.len() as u32).map(|vertex| {
        let at = place(shape, pose, vertex);
        triangles.iter().map(|corners| at.distance_squared(nearest(at, corners))).fold(f64::MAX, f64::min)
    });
    let (sum, most) = squares.fold((0.0, 0.0), |(sum, most), square| (sum + square, f64::max(most, square)));
    [(sum / shape.uv.len() as f64).sqrt(), most.sqrt()]
}

/// The point of a triangle that is nearest to another (Ericson, "Real-Time Collision Detection", section 5.1.5).
pub fn nearest(p: DVec3, [a, b, c]: &[DVec3; 3]) -> DVec3 {
    let (ab, ac, ap, bp, cp) = (b - a, c - a, p - a, p - b, p - c);
    let [d1, d2, d3, d4, d5, d6] = [ab.dot(ap), ac.dot(ap), ab.dot(bp), ac.dot(bp), ab.dot(cp), ac.dot(cp)];
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let [va, vb, vc] = [d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2];
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    a + (ab * vb + ac * vc) / (va + vb + vc)
}

/// The normal of a triangle, with a length of twice its area.
pub fn normal(shape: &Shape, pose: usize, triangle: &[u32]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|corner| place(shape, pose, triangle[corner]));
    (b - a).cross(c - a)
}

/// Twice the area of all triangles.
pub fn area(shape: &Shape, pose: usize, indices: &[u32]) -> f64 {
    indices.chunks_exact(3).map(|triangle| normal(shape, pose, triangle).length()).sum()
}
