//! A mesh without hard edges. Vertices that differ only in their normals are merged, so that a mesh can be simplified
//! even if each triangle has its own vertices. Afterwards each triangle gets back vertices with normals close to its
//! original normals.

use std::collections::HashMap;

use glam::Vec3;

use super::keys::Keys;
use super::whole::Whole;
use crate::mesh::simplify::{Simplified, weld};

/// Groups of vertices that are merged because they differ only in their normals.
pub(super) struct Welded {
    /// For each vertex, the first vertex of its group, which represents the group.
    first: Vec<u32>,
    /// For the first vertex of each group, all vertices of the group.
    all: HashMap<u32, Vec<u32>>,
}

impl Welded {
    /// Merges vertices of the same mesh that have the same position in every pose and the same texture coordinates.
    pub(super) fn new(whole: &Whole<'_>, poses: &[Vec<[f32; 3]>]) -> Self {
        let points = weld(poses);
        let mut known: HashMap<(u32, u32, [u32; 2]), u32> = HashMap::with_capacity(whole.vertices());
        let mut all: HashMap<u32, Vec<u32>> = HashMap::new();
        // Adding 0 turns −0 into +0.
        let bits = |number: f32| (number + 0.0).to_bits();
        let first = (0..whole.vertices() as u32)
            .map(|vertex| {
                let at = vertex as usize;
                let key = (whole.member[at], points[at], whole.uv[at].map(bits));
                let first = *known.entry(key).or_insert(vertex);
                all.entry(first).or_default().push(vertex);
                first
            })
            .collect();
        Self { first, all }
    }

    /// The triangles, with each vertex replaced by the first vertex of its group.
    pub(super) fn indices(&self, whole: &Whole<'_>) -> Vec<u32> {
        whole.indices.iter().map(|vertex| self.first[*vertex as usize]).collect()
    }

    /// For the first vertex of each group, the mean normal of the group. Other vertices keep their normals.
    pub(super) fn normals(&self, normals: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let mut means = normals.to_vec();
        for (first, all) in &self.all {
            let sum: Vec3 = all.iter().map(|vertex| Vec3::from(normals[*vertex as usize])).sum();
            means[*first as usize] = sum.normalize_or_zero().to_array();
        }
        means
    }

    /// For each vertex, the first vertex of the group into which it has collapsed after `collapses` collapses.
    pub(super) fn remap(&self, simplified: &Simplified, collapses: usize) -> Vec<u32> {
        let remap = simplified.remap(collapses);
        self.first.iter().map(|first| remap[*first as usize]).collect()
    }

    /// Computes the next level. Returns its triangles, the replacement of each vertex that the previous level uses, and
    /// the number of triangles.
    ///
    /// `triangles` is the previous level, and `remap` gives the collapses. Each triangle of the result has three
    /// different points. A collapsed vertex is replaced by a used vertex at its new point. Among several such vertices,
    /// the one with the normal closest to the old normal is taken. In flat-shaded triangles, it is the one with the
    /// normal closest to the new triangle's normal.
    ///
    /// If no triangle of a mesh has three different points, the mesh becomes a point: one of its vertices replaces all
    /// others, and one triangle has this vertex in all three corners. Such triangles are not counted.
    pub(super) fn next(
        &self,
        whole: &Whole<'_>,
        keys: &Keys,
        simplified: &Simplified,
        remap: &[u32],
        triangles: &[u32],
    ) -> (Vec<u32>, Vec<u32>, usize) {
        let mut used = vec![false; whole.vertices()];
        triangles.iter().for_each(|vertex| used[*vertex as usize] = true);
        let faces = flat_faces(keys, remap, triangles);
        let corner = |vertex: u32| match faces[vertex as usize] {
            Vec3::ZERO => {
                self.corner(&whole.normals, whole.normals[vertex as usize].into(), remap, &used, vertex)
            }
            face => self.corner(&keys.normals, face, remap, &used, vertex),
        };
        let mut into: Vec<u32> =
            (0..whole.vertices() as u32).map(|at| if used[at as usize] { corner(at) } else { at }).collect();
        let is_left =
            |triangle: &[u32]| simplified.are_apart([0, 1, 2].map(|at| remap[triangle[at] as usize]));
        let mut has = vec![false; whole.meshes.len()];
        for triangle in triangles.chunks_exact(3).filter(|triangle| is_left(triangle)) {
            has[whole.member_of(triangle) as usize] = true;
        }
        let (mut left, mut count) = (Vec::new(), 0);
        let mut points = vec![None; whole.meshes.len()];
        for triangle in triangles.chunks_exact(3) {
            let member = whole.member_of(triangle) as usize;
            if is_left(triangle) {
                count += 1;
                left.extend(triangle.iter().map(|vertex| into[*vertex as usize]));
            } else if !has[member] && points[member].is_none() {
                points[member] = Some(triangle[0]);
                left.extend([triangle[0]; 3]);
            }
        }
        for (vertex, member) in whole.member.iter().enumerate() {
            if let Some(point) = points[*member as usize].filter(|_| used[vertex]) {
                into[vertex] = point;
            }
        }
        (left, into, count)
    }

    /// The replacement of a vertex: among the used vertices at its new point, the one whose normal is closest to
    /// `wanted`.
    fn corner(&self, normals: &[[f32; 3]], wanted: Vec3, remap: &[u32], used: &[bool], vertex: u32) -> u32 {
        let target = remap[vertex as usize];
        if target == self.first[vertex as usize] {
            return vertex;
        }
        let facing = |other: &&u32| wanted.dot(normals[**other as usize].into());
        let others = self.all[&target].iter().filter(|other| used[**other as usize]);
        // If several vertices are equally close, the first of them is taken.
        others.rev().max_by(|a, b| facing(a).total_cmp(&facing(b))).copied().unwrap_or(target)
    }
}

/// Cosine of 2.5°. A triangle is flat-shaded if the normals of its corners agree within this angle.
const FLAT: f32 = 0.999;

/// For each vertex, the sum of the new normals of its flat-shaded triangles in the first key pose. The sum is 0 if one
/// of the vertex's triangles is not flat-shaded.
fn flat_faces(keys: &Keys, remap: &[u32], triangles: &[u32]) -> Vec<Vec3> {
    let mut faces = vec![Vec3::ZERO; remap.len()];
    let mut is_smooth = vec![false; remap.len()];
    for triangle in triangles.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|vertex| Vec3::from(keys.normals[vertex as usize]));
        if a.dot(b).min(b.dot(c)).min(c.dot(a)) < FLAT {
            triangle.iter().for_each(|vertex| is_smooth[*vertex as usize] = true);
            continue;
        }
        let [a, b, c] = triangle.map(|vertex| Vec3::from(keys.poses[0][remap[vertex as usize] as usize]));
        triangle.iter().for_each(|vertex| faces[*vertex as usize] += (b - a).cross(c - a));
    }
    faces
        .iter_mut()
        .zip(is_smooth)
        .filter(|(_, is_smooth)| *is_smooth)
        .for_each(|(face, _)| *face = Vec3::ZERO);
    faces
}
