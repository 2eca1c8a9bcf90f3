//! Pairs of nearby parts of a level and the original mesh. Collapses are local: if a vertex collapses into a target
//! vertex, the target and the triangles around the target are close to the vertex in every pose.

use std::collections::HashMap;
use std::ops::Range;

use glam::Vec3;

use super::Found;
use super::bodies::common;
use super::whole::{Whole, sorted};
use crate::mesh::nearest::nearest_on_triangle;
use crate::mesh::simplify::{NO_BODY, Simplified};
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::surface::tangent::Adjacency;

/// The largest number of candidate triangles per point. If there are more, the triangles nearest in the first pose are
/// kept.
const MAX: usize = 32;

/// For each item of a sequence, the triangles close to it.
#[derive(Debug, Clone, Default)]
pub(super) struct Near {
    /// Index in `triangles` of each item's first triangle. There is one more entry than items.
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

    fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    fn triangles_of(&self, thing: usize) -> &[[u32; 3]] {
        &self.triangles[self.starts[thing] as usize..self.starts[thing + 1] as usize]
    }

    /// The lists of the items in `range`, with the triangles' corners renumbered by `local`.
    pub(super) fn part(&self, range: Range<usize>, local: impl Fn(u32) -> u32) -> Self {
        let is_own = |corners: &&[u32; 3]| range.contains(&(corners[0] as usize));
        let own = |thing: usize| self.triangles_of(thing).iter().filter(is_own);
        Self::of(range.clone().map(|thing| own(thing).map(|corners| corners.map(&local)).collect()))
    }

    /// The point nearest to `wanted` on the triangles of an item; `None` if the item has no triangles.
    pub(super) fn nearest(&self, thing: usize, wanted: Vec3, point: &impl Fn(u32) -> Vec3) -> Option<Vec3> {
        let on = |triangle: &[u32; 3]| nearest_on_triangle(wanted, triangle.map(point));
        let points = self.triangles_of(thing).iter().map(on);
        points.min_by(|a, b| a.distance_squared(wanted).total_cmp(&b.distance_squared(wanted)))
    }
}

/// Samples for both directions of a level's error: from the mesh to the level, and from the level to the mesh.
pub(super) struct Sides {
    /// For each vertex of the mesh that the level lacks, the nearby triangles of the level.
    pub(super) near: Near,
    /// Sample points on the level, as barycentric coordinates in the level's triangles.
    samples: Vec<Sample>,
    /// For each sample point, the nearby triangles of the mesh.
    behind: Near,
}

/// A point in a triangle: the triangle's corners, and the point's barycentric coordinates.
pub(super) type Sample = ([u32; 3], [f32; 3]);

impl Sides {
    /// Finds the nearby parts of a level and its mesh in the poses `keys`. Nearby parts belong to the same mesh.
    /// `bodies` has the rigid body of each vertex.
    pub(super) fn new(
        whole: &Whole<'_>,
        simplified: &Simplified,
        found: &Found,
        keys: &[Vec<Vec3>],
        bodies: &[u32],
    ) -> Self {
        let level = &found.indices;
        let point = |vertex: u32| simplified.point(vertex);
        let around = |indices: &[u32], target: &dyn Fn(u32) -> u32| {
            let corners: Vec<u32> = indices.iter().map(|vertex| point(target(*vertex))).collect();
            Around::new(&corners, whole.vertices())
        };
        let ring = around(level, &|vertex| vertex);
        let near = Near::of(before(whole, &ring, found, &point, keys, bodies).into_iter());

        // The meshes' triangles with an area above 0, listed by the points into which their corners have collapsed.
        let has_area = |triangle: &&[u32]| simplified.are_apart([triangle[0], triangle[1], triangle[2]]);
        let area: Vec<u32> = whole.indices.chunks_exact(3).filter(has_area).flatten().copied().collect();
        let became = around(&area, &|vertex| found.remap[vertex as usize]);
        let samples: Vec<_> = level.chunks_exact(3).flat_map(samples_of).collect();
        let search = Search::new(&area, keys, bodies);
        let clusters = Clusters::new(&search, &became);
        let mut candidates = Vec::new();
        let behind = Near::of(level.chunks_exact(3).flat_map(|triangle| {
            let is_own = |at: &u32| whole.member_of(&corners_of(&area, *at)) == whole.member_of(triangle);
            let beside = ring.beside(triangle, level, &point);
            let body = common(bodies, &[triangle[0], triangle[1], triangle[2]]);
            let is_rigid = clusters.are_rigid(&beside, body);
            if !is_rigid {
                candidates = sorted(beside.iter().flat_map(|point| became.of(*point)).filter(is_own));
            }
            let mut likely = None;
            samples_of(triangle).map(|(corners, parts)| {
                let point = |key: &Vec<Vec3>| blend(&corners, &parts, &|vertex| key[vertex as usize]);
                if is_rigid {
                    let found = clusters.nearest(&search, point(&keys[0]), &beside, is_own, likely);
                    likely = found;
                    return found.map(|at| corners_of(&area, at)).into_iter().collect();
                }
                search.nearest_in_each(point, body, &candidates)
            })
        }));
        Self { near, samples, behind }
    }

    /// All samples of both directions, each with the nearby triangles of the other surface. Samples at vertices come
    /// first. Samples without nearby triangles are left out.
    pub(super) fn all(&self) -> impl Iterator<Item = (Sample, &[[u32; 3]])> {
        let vertices = (0..self.near.len()).map(|vertex| ([vertex as u32; 3], [1.0, 0.0, 0.0]));
        let forth = vertices.enumerate().map(|(at, sample)| (sample, self.near.triangles_of(at)));
        let back =
            self.samples.iter().enumerate().map(|(at, sample)| (*sample, self.behind.triangles_of(at)));
        forth.chain(back).filter(|(_, triangles)| !triangles.is_empty())
    }
}

/// For each vertex of the mesh that the level lacks, the nearby triangles of the level.
fn before(
    whole: &Whole<'_>,
    ring: &Around,
    Found { remap, indices: level, .. }: &Found,
    point: &impl Fn(u32) -> u32,
    keys: &[Vec<Vec3>],
    bodies: &[u32],
) -> Vec<Vec<[u32; 3]>> {
    let (mut is_used, mut is_left) = (vec![false; whole.vertices()], vec![false; whole.vertices()]);
    whole.indices.iter().for_each(|vertex| is_used[*vertex as usize] = true);
    level.iter().for_each(|vertex| is_left[*vertex as usize] = true);
    let search = Search::new(level, keys, bodies);
    // A cache, because many vertices have collapsed into the same vertex.
    let mut rings: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
    // The triangles of each mesh, computed on demand.
    let mut owned: HashMap<u32, Vec<u32>> = HashMap::new();
    let near = |vertex: u32| {
        if is_left[vertex as usize] {
            return Vec::new();
        }
        let is_own = |at: &u32| whole.member_of(&corners_of(level, *at)) == whole.member[vertex as usize];
        // A vertex that no triangle uses has no candidates. `target` need not be a corner of the level: another vertex
        // at its position, with other attributes, may be used instead. Candidates are therefore found by position.
        let target = remap[vertex as usize];
        let own = || ring.two_rings(target, level, point).into_iter().filter(is_own).collect();
        let candidates = rings.entry((target, whole.member[vertex as usize])).or_insert_with(own);
        if !candidates.is_empty() || !is_used[vertex as usize] {
            return search.nearest_in_each(|key| key[vertex as usize], bodies[vertex as usize], candidates);
        }
        // The whole mesh, or the part of it around the vertex, has become a point. No triangle of the mesh is left
        // around the vertex, so the nearest of the mesh's triangles is used instead.
        let member = whole.member[vertex as usize];
        let all = owned.entry(member).or_insert_with(|| (0..level.len() as u32 / 3).filter(is_own).collect());
        search.nearest_in_each(|key| key[vertex as usize], bodies[vertex as usize], all)
    };
    (0..whole.vertices() as u32).map(near).collect()
}

/// Four sample points of a triangle: its midpoint, and the midpoints of its edges.
fn samples_of(triangle: &[u32]) -> [Sample; 4] {
    const THIRD: f32 = 1.0 / 3.0;
    let corners = [triangle[0], triangle[1], triangle[2]];
    [[THIRD; 3], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]].map(|parts| (corners, parts))
}

pub(super) fn blend(corners: &[u32; 3], parts: &[f32; 3], point: &impl Fn(u32) -> Vec3) -> Vec3 {
    corners.iter().zip(parts).map(|(corner, part)| *part * point(*corner)).sum()
}

fn corners_of(indices: &[u32], triangle: u32) -> [u32; 3] {
    [0, 1, 2].map(|corner| indices[3 * triangle as usize + corner])
}

/// Searches, in each of several poses, for the nearest of some triangles.
struct Search<'a> {
    /// The triangles, three vertex indices each.
    indices: &'a [u32],
    keys: &'a [Vec<Vec3>],
    /// The rigid body of each vertex.
    bodies: &'a [u32],
    /// A sphere around each triangle in the first pose.
    spheres: Vec<BoundingSphere>,
}

impl<'a> Search<'a> {
    fn new(indices: &'a [u32], keys: &'a [Vec<Vec3>], bodies: &'a [u32]) -> Self {
        let sphere = |triangle: &[u32; 3]| {
            let corners = triangle.map(|vertex| keys[0][vertex as usize]);
            let center = (corners[0] + corners[1] + corners[2]) / 3.0;
            let radius =
                corners.map(|corner| corner.distance_squared(center)).into_iter().fold(0.0, f32::max);
            // The radius is enlarged slightly, to cover rounding.
            BoundingSphere { center, radius: 1.000_01 * radius.sqrt() }
        };
        let spheres = indices.as_chunks::<3>().0.iter().map(sphere).collect();
        Self { indices, keys, bodies, spheres }
    }

    fn off(&self, key: usize, wanted: Vec3, triangle: u32) -> f32 {
        let corners = corners_of(self.indices, triangle).map(|vertex| self.keys[key][vertex as usize]);
        nearest_on_triangle(wanted, corners).distance_squared(wanted)
    }

    /// The candidate triangles that are nearest to a point in at least one pose, as corners. `wanted` gives the point
    /// in a pose, and `body` is the point's rigid body.
    fn nearest_in_each(
        &self,
        wanted: impl Fn(&Vec<Vec3>) -> Vec3,
        body: u32,
        candidates: &[u32],
    ) -> Vec<[u32; 3]> {
        let corners = |triangle: u32| corners_of(self.indices, triangle);
        let is_rigid = |triangle: u32| body != NO_BODY && common(self.bodies, &corners(triangle)) == body;
        // If the point and all candidates belong to one rigid body, the same triangle is nearest in all poses.
        if self.keys.len() == 1 || candidates.iter().all(|triangle| is_rigid(*triangle)) {
            return self.nearest(wanted(&self.keys[0]), candidates).map(corners).into_iter().collect();
        }
        let first = wanted(&self.keys[0]);
        let off = |triangle: &u32| (self.off(0, first, *triangle), *triangle);
        let mut found: Vec<(f32, u32)> = candidates.iter().map(off).collect();
        let order = |a: &(f32, u32), b: &(f32, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if found.len() > MAX {
            found.select_nth_unstable_by(MAX, order);
            found.truncate(MAX);
        }
        found.sort_unstable_by(order);
        let mut nearest: Vec<[u32; 3]> = Vec::new();
        for (key, points) in self.keys.iter().enumerate() {
            let wanted = wanted(points);
            let distances = found.iter().map(|(off, triangle)| {
                let is_known = key == 0 || is_rigid(*triangle);
                (if is_known { *off } else { self.off(key, wanted, *triangle) }, *triangle)
            });
            let best = distances.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, triangle)| corners(triangle));
            nearest.extend(best.filter(|best| !nearest.contains(best)));
        }
        nearest.sort_unstable();
        nearest
    }

    /// The candidate nearest to `wanted` in the first pose. If several are equally near, the first of them.
    fn nearest(&self, wanted: Vec3, candidates: &[u32]) -> Option<u32> {
        let mut best = Nearest::NONE;
        best.start(self, wanted, candidates.iter().copied());
        candidates.iter().for_each(|triangle| best.add(self, wanted, *triangle));
        best.found()
    }
}

/// The triangle found so far that is nearest in the first pose. If several are equally near, the first of them.
struct Nearest {
    triangle: u32,
    squared: f32,
    /// Distance beyond which a triangle cannot be the nearest.
    within: f32,
}

impl Nearest {
    const NONE: Self = Self { triangle: u32::MAX, squared: f32::INFINITY, within: f32::INFINITY };

    /// Starts with the triangle whose center is nearest. Its distance rules out most other triangles quickly.
    fn start(&mut self, search: &Search<'_>, wanted: Vec3, triangles: impl Iterator<Item = u32>) {
        let to_middle = |triangle: &u32| search.spheres[*triangle as usize].center.distance_squared(wanted);
        if let Some(likely) = triangles.min_by(|a, b| to_middle(a).total_cmp(&to_middle(b))) {
            self.add(search, wanted, likely);
        }
    }

    fn add(&mut self, search: &Search<'_>, wanted: Vec3, triangle: u32) {
        if self.is_beyond(wanted, &search.spheres[triangle as usize]) {
            return;
        }
        let squared = search.off(0, wanted, triangle);
        if squared < self.squared || squared == self.squared && triangle < self.triangle {
            *self = Self { triangle, squared, within: 1.000_01 * squared.sqrt() };
        }
    }

    /// Whether a whole sphere is farther from `wanted` than the nearest triangle found so far.
    fn is_beyond(&self, wanted: Vec3, sphere: &BoundingSphere) -> bool {
        let reach = self.within + sphere.radius;
        sphere.center.distance_squared(wanted) > reach * reach
    }

    fn found(&self) -> Option<u32> {
        (self.triangle != u32::MAX).then_some(self.triangle)
    }
}

/// Groups of the mesh's triangles, one group per point of the level. A triangle is in the groups of the points into
/// which its corners have collapsed.
struct Clusters<'a> {
    around: &'a Around,
    /// For each point, a sphere around its triangles in the first pose.
    spheres: Vec<BoundingSphere>,
    /// For each point, the rigid body that all of its triangles belong to, or [`NO_BODY`].
    bodies: Vec<u32>,
    /// Whether there is only one pose.
    is_still: bool,
}

impl<'a> Clusters<'a> {
    fn new(search: &Search<'_>, around: &'a Around) -> Self {
        let sphere = |point: u32| {
            let all = || around.of(point).map(|triangle| search.spheres[triangle as usize]);
            let count = all().count().max(1) as f32;
            let center = all().map(|sphere| sphere.center).sum::<Vec3>() / count;
            // The radius is enlarged slightly, to cover rounding.
            let reach = |other: BoundingSphere| 1.000_01 * (other.center.distance(center) + other.radius);
            BoundingSphere { center, radius: all().map(reach).fold(0.0, f32::max) }
        };
        let body = |point: u32| {
            let mut bodies =
                around.of(point).map(|triangle| common(search.bodies, &corners_of(search.indices, triangle)));
            let first = bodies.next().unwrap_or(NO_BODY);
            if bodies.all(|other| other == first) { first } else { NO_BODY }
        };
        let points = || 0..around.len();
        let is_still = search.keys.len() == 1;
        let bodies = if is_still { Vec::new() } else { points().map(body).collect() };
        Self { around, spheres: points().map(sphere).collect(), bodies, is_still }
    }

    /// Whether the triangles of all these points keep their distances from `body` in every pose.
    fn are_rigid(&self, points: &[u32], body: u32) -> bool {
        let is_on =
            |point: &u32| self.bodies[*point as usize] == body || self.around.of(*point).next().is_none();
        self.is_still || body != NO_BODY && points.iter().all(is_on)
    }

    /// The triangle around `points` that is nearest to `wanted` in the first pose. Only triangles that pass `is_own`
    /// count. `likely` is a triangle that is examined first; `None` if there is no guess.
    fn nearest(
        &self,
        search: &Search<'_>,
        wanted: Vec3,
        points: &[u32],
        is_own: impl Fn(&u32) -> bool,
        likely: Option<u32>,
    ) -> Option<u32> {
        let mut best = Nearest::NONE;
        match likely {
            Some(triangle) => best.add(search, wanted, triangle),
            None => {
                let to_middle = |point: &u32| self.spheres[*point as usize].center.distance_squared(wanted);
                let point = *points.iter().min_by(|a, b| to_middle(a).total_cmp(&to_middle(b)))?;
                best.start(search, wanted, self.around.of(point).filter(&is_own));
            }
        }
        for &point in points {
            if !best.is_beyond(wanted, &self.spheres[point as usize]) {
                let own = self.around.of(point).filter(&is_own);
                own.for_each(|triangle| best.add(search, wanted, triangle));
            }
        }
        best.found()
    }
}

/// For each point, the triangles that have a corner there.
struct Around(Adjacency);

impl Around {
    /// Lists the triangles around each of `points` points. `corners` has three points per triangle.
    fn new(corners: &[u32], points: usize) -> Self {
        Self(Adjacency::new(points, corners))
    }

    /// Number of points.
    fn len(&self) -> u32 {
        self.0.offsets.len() as u32 - 1
    }

    fn of(&self, point: u32) -> impl Iterator<Item = u32> + '_ {
        self.0.at(point as usize).iter().map(|corner| corner / 3)
    }

    /// The corner points of all triangles around the given vertices, without duplicates.
    fn beside(&self, vertices: &[u32], level: &[u32], of: &impl Fn(u32) -> u32) -> Vec<u32> {
        let around = vertices.iter().flat_map(|vertex| self.of(of(*vertex)));
        sorted(around.flat_map(|triangle| corners_of(level, triangle)).map(of))
    }

    /// The triangles around a vertex's point, and the triangles around the corners of these triangles.
    fn two_rings(&self, vertex: u32, level: &[u32], of: &impl Fn(u32) -> u32) -> Vec<u32> {
        let points = self.beside(&[vertex], level, of);
        sorted(points.iter().flat_map(|point| self.of(*point)))
    }
}
