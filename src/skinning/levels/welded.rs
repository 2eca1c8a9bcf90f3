//! A mesh without hard edges: vertices that differ in their normals alone are one. So a mesh whose every triangle has
//! vertices of its own can be simplified; its triangles keep vertices that face as theirs did.

use std::collections::HashMap;

use glam::Vec3;

use crate::asset::mesh::Mesh;
use crate::mesh::simplify::{Simplified, weld};

/// Which vertices are one.
pub(super) struct Welded {
    /// Of each vertex the first that is one with it.
    first: Vec<u32>,
    /// Of each first one all.
    all: HashMap<u32, Vec<u32>>,
}

impl Welded {
    /// Vertices at one place in every pose, with the same texture coordinates.
    pub(super) fn new(mesh: &Mesh, poses: &[Vec<[f32; 3]>]) -> Self {
        let points = weld(poses);
        let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::with_capacity(mesh.vertices());
        let mut all: HashMap<u32, Vec<u32>> = HashMap::new();
        // Adding 0 makes one zero of two.
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

    /// Triangles of first ones.
    pub(super) fn indices(&self, mesh: &Mesh) -> Vec<u32> {
        mesh.indices.iter().map(|vertex| self.first[*vertex as usize]).collect()
    }

    /// The normal of each first one: the mean of all.
    pub(super) fn normals(&self, normals: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let mut means = normals.to_vec();
        for (first, all) in &self.all {
            let sum: Vec3 = all.iter().map(|vertex| Vec3::from(normals[*vertex as usize])).sum();
            means[*first as usize] = sum.normalize_or_zero().to_array();
        }
        means
    }

    /// What each vertex has become after so many collapses, among first ones.
    pub(super) fn remap(&self, simplified: &Simplified, collapses: usize) -> Vec<u32> {
        let remap = simplified.remap(collapses);
        self.first.iter().map(|first| remap[*first as usize]).collect()
    }

    /// The triangles with three different points where vertices have become these heirs, of vertices that are `used`: a
    /// corner that was collapsed gets the vertex there whose normal is nearest to its own.
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
            // The first of several.
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
