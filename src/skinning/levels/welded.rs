//! A mesh without hard edges: vertices that differ only in their normals are merged, so that a mesh in which
//! every triangle has vertices of its own can be simplified. Its triangles then get back vertices with normals
//! close to their own.

use std::collections::HashMap;

use glam::Vec3;

use crate::asset::mesh::Mesh;
use crate::mesh::simplify::{Simplified, weld};

/// The groups of merged vertices.
pub(super) struct Welded {
    /// For each vertex, the first vertex of its group.
    first: Vec<u32>,
    /// For each first vertex, all vertices of its group.
    all: HashMap<u32, Vec<u32>>,
}

impl Welded {
    /// Merges vertices that have one position in every pose and the same texture coordinates.
    pub(super) fn new(mesh: &Mesh, poses: &[Vec<[f32; 3]>]) -> Self {
        let points = weld(poses);
        let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::with_capacity(mesh.vertices());
        let mut all: HashMap<u32, Vec<u32>> = HashMap::new();
        // Adding 0 turns −0 into +0.
        let bits = |number: f32| (number + 0.0).to_bits();
        let first = (0..mesh.vertices() as u32)
            .map(|vertex| {
                let at = vertex as usize;
                let first = *known.entry((points[at], mesh.uv[at].map(bits))).or_insert(vertex);
                all.entry(first).or_default().push(vertex);
                first
            })
            .collect();
        Self { first, all }
    }

    /// The triangles with vertices replaced by the first ones of their groups.
    pub(super) fn indices(&self, mesh: &Mesh) -> Vec<u32> {
        mesh.indices.iter().map(|vertex| self.first[*vertex as usize]).collect()
    }

    /// The normal of each first vertex: the mean of its group.
    pub(super) fn normals(&self, normals: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let mut means = normals.to_vec();
        for (first, all) in &self.all {
            let sum: Vec3 = all.iter().map(|vertex| Vec3::from(normals[*vertex as usize])).sum();
            means[*first as usize] = sum.normalize_or_zero().to_array();
        }
        means
    }

    /// For each vertex, the first vertex into which it has collapsed after `collapses` collapses.
    pub(super) fn remap(&self, simplified: &Simplified, collapses: usize) -> Vec<u32> {
        let remap = simplified.remap(collapses);
        self.first.iter().map(|first| remap[*first as usize]).collect()
    }

    /// The triangles that still have three different points after vertices have collapsed as `remap` says,
    /// using only vertices that are `used`. A collapsed corner gets the vertex at its new point whose normal is
    /// closest to its own.
    pub(super) fn triangles(
        &self,
        mesh: &Mesh,
        simplified: &Simplified,
        remap: &[u32],
        used: &[bool],
    ) -> Vec<u32> {
        let normal = |vertex: u32| Vec3::from(mesh.normals[vertex as usize]);
        let corner = |vertex: u32| {
            let target = remap[vertex as usize];
            if target == self.first[vertex as usize] {
                return vertex;
            }
            let facing = |other: &&u32| normal(**other).dot(normal(vertex));
            let others = self.all[&target].iter().filter(|other| used[**other as usize]);
            // Takes the first of several equally close ones.
            others.rev().max_by(|a, b| facing(a).total_cmp(&facing(b))).copied().unwrap_or(target)
        };
        let mut left = Vec::new();
        for triangle in mesh.indices.chunks_exact(3) {
            if simplified.are_apart([0, 1, 2].map(|at| remap[triangle[at] as usize])) {
                left.extend(triangle.iter().map(|vertex| corner(*vertex)));
            }
        }
        left
    }
}
