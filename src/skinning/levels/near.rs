//! The parts of a level and of its mesh that are close to each other. Collapses are local: the vertex into
//! which a vertex has collapsed, and the triangles around it, are close to it in every pose.

use std::collections::BTreeSet;
use std::ops::Range;

use glam::Vec3;

use super::Found;
use super::whole::Whole;
use crate::mesh::nearest::nearest_on_triangle;
use crate::mesh::simplify::Simplified;
use crate::surface::tangent::Adjacency;

/// The largest number of triangles that may be nearest in some pose; those of the first poses are kept.
const MAX: usize = 32;

/// For each item of a sequence, the triangles close to it.
#[derive(Debug, Clone, Default)]
pub(super) struct Near {
    /// Where the triangles of each item begin; one more entry than there are items.
    starts: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl Near {
    fn of(lists: impl Iterator<Item = Vec<[u32; 3]>>) -> Self {
        let mut near = Self { starts: vec![0], triangles: Vec::new() };
        for list in lists {
            near.triangles.extend(list);
            near.starts.push(near.triangles.len() as u32);
        }
        near
    }

    /// The triangles of the things in a range, with other numbers of their corners.
    pub(super) fn part(&self, range: Range<usize>, local: impl Fn(u32) -> u32) -> Self {
        let triangles =
            |thing: usize| &self.triangles[self.starts[thing] as usize..self.starts[thing + 1] as usize];
        Self::of(range.map(|thing| triangles(thing).iter().map(|corners| corners.map(&local)).collect()))
    }

    /// The point nearest to `wanted` on the triangles of an item, if it has any.
    pub(super) fn nearest(&self, thing: usize, wanted: Vec3, point: &impl Fn(u32) -> Vec3) -> Option<Vec3> {
        let range = self.starts[thing] as usize..self.starts[thing + 1] as usize;
        let on = |triangle: &[u32; 3]| nearest_on_triangle(wanted, triangle.map(point));
        let points = self.triangles[range].iter().map(on);
        points.min_by(|a, b| a.distance_squared(wanted).total_cmp(&b.distance_squared(wanted)))
    }
}

/// Both directions of a level's error: from the mesh to the level, and from the level to the mesh.
pub(super) struct Sides {
    /// For each vertex of the mesh that the level does not have.
    pub(super) near: Near,
    /// Samples on the level, as barycentric coordinates in its triangles.
    samples: Vec<([u32; 3], [f32; 3])>,
    /// For each sample, triangles of the mesh.
    behind: Near,
}

impl Sides {
    /// `keys` are the poses that decide what is close. What is close is of the same mesh.
    pub(super) fn new(whole: &Whole<'_>, simplified: &Simplified, found: &Found, keys: &[Vec<Vec3>]) -> Self {
        let level = &found.indices;
        let point = |vertex: u32| simplified.point(vertex);
        let around = |indices: &[u32], target: &dyn Fn(u32) -> u32| {
            let corners: Vec<u32> = indices.iter().map(|vertex| point(target(*vertex))).collect();
            Around::new(&corners, whole.vertices())
        };
        let ring = around(level, &|vertex| vertex);
        let near = Near::of(before(whole, &ring, found, &point, keys).into_iter());

        // Triangles of the meshes that have an area, by the points into which their corners have collapsed.
        let has_area = |triangle: &&[u32]| simplified.are_apart([triangle[0], triangle[1], triangle[2]]);
        let area: Vec<u32> = whole.indices.chunks_exact(3).filter(has_area).flatten().copied().collect();
        let became = around(&area, &|vertex| found.remap[vertex as usize]);
        let samples: Vec<_> = level.chunks_exact(3).flat_map(samples_of).collect();
        let behind = Near::of(level.chunks_exact(3).flat_map(|triangle| {
            let is_own = |at: &u32| whole.member_of(&corners_of(&area, *at)) == whole.member_of(triangle);
            let mut candidates: Vec<u32> = (ring.beside(triangle, level, &point).into_iter())
                .flat_map(|point| became.of(point))
                .filter(is_own)
                .collect();
            candidates.sort_unstable();
            candidates.dedup();
            samples_of(triangle).map(|(corners, parts)| {
                let point = |key: &Vec<Vec3>| blend(&corners, &parts, &|vertex| key[vertex as usize]);
                nearest_in_each(keys, point, candidates.iter().map(|at| corners_of(&area, *at)))
            })
        }));
        Self { near, samples, behind }
    }

    /// The largest distance, given the positions of all vertices of the mesh.
    pub(super) fn error(&self, points: &[Vec3]) -> f32 {
        let point = |vertex: u32| points[vertex as usize];
        let off = |near: &Near, thing: usize, wanted: Vec3| {
            near.nearest(thing, wanted, &point).map_or(0.0, |found| found.distance(wanted))
        };
        let forth = points.iter().enumerate().map(|(vertex, wanted)| off(&self.near, vertex, *wanted));
        let back = (self.samples.iter().enumerate())
            .map(|(at, (corners, parts))| off(&self.behind, at, blend(corners, parts, &point)));
        forth.chain(back).fold(0.0, f32::max)
    }
}

/// For each vertex that a level does not have, triangles of the level that are close to it.
fn before(
    whole: &Whole<'_>,
    ring: &Around,
    Found { remap, indices: level, .. }: &Found,
    point: &impl Fn(u32) -> u32,
    keys: &[Vec<Vec3>],
) -> Vec<Vec<[u32; 3]>> {
    let (mut is_used, mut is_left) = (vec![false; whole.vertices()], vec![false; whole.vertices()]);
    whole.indices.iter().for_each(|vertex| is_used[*vertex as usize] = true);
    level.iter().for_each(|vertex| is_left[*vertex as usize] = true);
    let near = |vertex: u32| {
        if is_left[vertex as usize] {
            return Vec::new();
        }
        let is_own = |triangle: &[u32; 3]| whole.member_of(triangle) == whole.member[vertex as usize];
        // There may be none for a vertex without triangles. The replacement itself may be a wedge that no triangle of the
        // level uses.
        let mut candidates = ring.two_rings(remap[vertex as usize], level, point);
        candidates.retain(is_own);
        if candidates.is_empty() && is_used[vertex as usize] {
            // Of what became a point, or of a part of the mesh that has vanished.
            candidates = level.as_chunks::<3>().0.iter().copied().filter(is_own).collect();
        }
        nearest_in_each(keys, |key| key[vertex as usize], candidates.into_iter())
    };
    (0..whole.vertices() as u32).map(near).collect()
}

/// The midpoints of a triangle and of its edges.
fn samples_of(triangle: &[u32]) -> [([u32; 3], [f32; 3]); 4] {
    const THIRD: f32 = 1.0 / 3.0;
    let corners = [triangle[0], triangle[1], triangle[2]];
    [[THIRD; 3], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]].map(|parts| (corners, parts))
}

fn blend(corners: &[u32; 3], parts: &[f32; 3], point: &impl Fn(u32) -> Vec3) -> Vec3 {
    corners.iter().zip(parts).map(|(corner, part)| *part * point(*corner)).sum()
}

fn corners_of(indices: &[u32], triangle: u32) -> [u32; 3] {
    [0, 1, 2].map(|corner| indices[3 * triangle as usize + corner])
}

/// Of these triangles, those that are nearest in one of the poses.
fn nearest_in_each(
    keys: &[Vec<Vec3>],
    wanted: impl Fn(&Vec<Vec3>) -> Vec3,
    candidates: impl Iterator<Item = [u32; 3]>,
) -> Vec<[u32; 3]> {
    let off = |key: &Vec<Vec3>, wanted: Vec3, triangle: &[u32; 3]| {
        let corners = triangle.map(|vertex| key[vertex as usize]);
        nearest_on_triangle(wanted, corners).distance_squared(wanted)
    };
    let first = wanted(&keys[0]);
    let mut candidates: Vec<_> =
        candidates.map(|triangle| (off(&keys[0], first, &triangle).to_bits(), triangle)).collect();
    if candidates.len() > MAX {
        candidates.select_nth_unstable(MAX);
        candidates.truncate(MAX);
    }
    candidates.sort_unstable();
    let mut nearest = BTreeSet::new();
    for key in keys {
        let wanted = wanted(key);
        let distances = candidates.iter().map(|(_, triangle)| (off(key, wanted, triangle), triangle));
        nearest.extend(distances.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, triangle)| *triangle));
    }
    nearest.into_iter().collect()
}

/// The triangles around each point.
struct Around(Adjacency);

impl Around {
    /// `corners` are points, three per triangle.
    fn new(corners: &[u32], points: usize) -> Self {
        Self(Adjacency::new(points, corners))
    }

    fn of(&self, point: u32) -> impl Iterator<Item = u32> + '_ {
        self.0.at(point as usize).iter().map(|corner| corner / 3)
    }

    /// The points of the triangles around the points of some vertices.
    fn beside(&self, vertices: &[u32], level: &[u32], of: &impl Fn(u32) -> u32) -> BTreeSet<u32> {
        let around = vertices.iter().flat_map(|vertex| self.of(of(*vertex)));
        around.flat_map(|triangle| corners_of(level, triangle)).map(of).collect()
    }

    /// The triangles around a vertex's point, and those around the corners of these.
    fn two_rings(&self, vertex: u32, level: &[u32], of: &impl Fn(u32) -> u32) -> Vec<[u32; 3]> {
        let points = self.beside(&[vertex], level, of);
        let triangles: BTreeSet<u32> = points.iter().flat_map(|point| self.of(*point)).collect();
        triangles.into_iter().map(|triangle| corners_of(level, triangle)).collect()
    }
}
