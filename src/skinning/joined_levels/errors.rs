//! The distances of joined levels from level 0, in both directions, in many poses.
//!
//! Most triangles are skipped in most poses. The distance from a triangle is a convex function, which is largest at a corner of
//! another triangle. So a triangle whose corners are near a single triangle of the other surface is near it as a whole. Of the
//! remaining triangles, most samples are skipped, because the triangle that was nearest in the first pose is near enough.

use glam::DVec3;

use super::tree::{Posed, Tree};
use crate::asset::{Mesh, Model};
use crate::parallel;
use crate::skinning::pose::{Moment, bones_at, positions_of};

/// The meshes of a level, as indices in the model.
pub(super) type Level = Vec<usize>;

/// Number of moments that are examined in parallel, from the same known distances.
const BATCH: usize = 64;

/// Smallest and largest number of steps from sample to sample along the edges of a triangle.
const STEPS: [u32; 2] = [2, 16];

/// Number of steps along an edge of mean length of level 0: in level 0, and in the other levels.
const DENSITY: [f64; 2] = [4.0, 2.0];

/// The distance of each level but the first from the first: the largest of all moments. All meshes have their own triangles
/// as level 0. Each level has at least one triangle.
pub(super) fn errors(model: &Model, levels: &[Level], moments: &[Moment]) -> Vec<f64> {
    let vertices = Vertices::new(model);
    let first = vertices.points(model, moments[0]);
    let triangles = |level: &Level| vertices.triangles(model, level);
    let pairs = Pairs::new(&levels.iter().map(triangles).collect::<Vec<_>>(), &first);
    let mut known = pairs.larger(&first, &vec![0.0; levels.len() - 1]);
    // Widely spaced moments come first. They soon give large distances, so that most samples can be skipped.
    let stride = moments.len().div_ceil(BATCH).max(1);
    let order: Vec<Moment> =
        (0..stride).flat_map(|first| moments.iter().skip(first).step_by(stride)).copied().collect();
    for batch in order.chunks(BATCH) {
        let look = |moment: &Moment| pairs.larger(&vertices.points(model, *moment), &known);
        for own in parallel::map(batch, look) {
            known.iter_mut().zip(own).for_each(|(known, own)| *known = known.max(own));
        }
    }
    known.into_iter().map(f64::sqrt).collect()
}

/// The vertices of all meshes of a model, one mesh after the other.
struct Vertices {
    /// For each mesh, the indices of its vertices in the mesh.
    own: Vec<Vec<u32>>,
    /// For each mesh, the index of its first vertex.
    starts: Vec<u32>,
}

impl Vertices {
    fn new(model: &Model) -> Self {
        let own: Vec<Vec<u32>> =
            model.meshes.iter().map(|mesh| (0..mesh.vertices() as u32).collect()).collect();
        let mut next = 0;
        let start = |own: &Vec<u32>| {
            next += own.len() as u32;
            next - own.len() as u32
        };
        let starts = own.iter().map(start).collect();
        Self { own, starts }
    }

    /// The positions of all vertices at a moment.
    fn points(&self, model: &Model, moment: Moment) -> Vec<DVec3> {
        let bones = bones_at(model, moment);
        let of_mesh = |(mesh, own): (&Mesh, &Vec<u32>)| positions_of(model, mesh, moment, &bones, own);
        model.meshes.iter().zip(&self.own).flat_map(of_mesh).map(|point| point.as_dvec3()).collect()
    }

    /// The triangles of some meshes.
    fn triangles(&self, model: &Model, meshes: &[usize]) -> Vec<[u32; 3]> {
        let of_mesh = |mesh: &usize| {
            let start = self.starts[*mesh];
            model.meshes[*mesh]
                .indices
                .as_chunks::<3>()
                .0
                .iter()
                .map(move |corners| corners.map(|at| start + at))
        };
        meshes.iter().flat_map(of_mesh).collect()
    }
}

/// Samples of all triangles of a surface.
struct Side {
    patches: Vec<Patch>,
    /// For each sample, the triangle of the other surface that was nearest in the first pose, as its index in the tree.
    hints: Vec<u32>,
}

/// A triangle of a surface.
struct Patch {
    corners: [u32; 3],
    /// Steps along each edge from sample to sample.
    steps: u32,
    /// The triangle of the other surface that was nearest to the midpoint in the first pose.
    hint: u32,
    /// Index of the hint of the first sample.
    first: u32,
}

impl Side {
    /// Samples of triangles, about `spacing` apart in the first pose. `other` is the other surface in this pose.
    fn new(triangles: &[[u32; 3]], spacing: f64, other: &Posed<'_>) -> Self {
        let mut side = Self { patches: Vec::with_capacity(triangles.len()), hints: Vec::new() };
        for corners in triangles {
            let points = corners.map(|corner| other.points()[corner as usize]);
            let longest = edges(points).into_iter().fold(0.0, f64::max);
            // The quotient is not a number if level 0 has no extent. It then becomes 0.
            let [least, most] = STEPS;
            let steps = ((longest / spacing).ceil() as u32).clamp(least, most);
            let first = side.hints.len() as u32;
            side.hints.extend(samples(steps).map(|parts| other.nearest(blend(points, parts))));
            // The midpoint is the last sample.
            let hint = side.hints[side.hints.len() - 1];
            side.patches.push(Patch { corners: *corners, steps, hint, first });
        }
        side
    }

    /// The largest squared distance of a sample from the other surface; at least `known`.
    fn largest(&self, other: &Posed<'_>, mut known: f64) -> f64 {
        for Patch { corners, steps, hint, first } in &self.patches {
            let points = corners.map(|corner| other.points()[corner as usize]);
            if points.into_iter().all(|point| other.squared_to(*hint, point) <= known) {
                continue;
            }
            for (parts, hint) in samples(*steps).zip(&self.hints[*first as usize..]) {
                let point = blend(points, parts);
                let squared = other.squared_to(*hint, point);
                if squared > known {
                    known = other.beyond(point, squared, known).unwrap_or(known);
                }
            }
        }
        known
    }
}

/// Level 0, and each other level, with samples of both.
struct Pairs {
    fine: Tree,
    coarse: Vec<Coarse>,
}

struct Coarse {
    tree: Tree,
    /// Samples of level 0.
    forth: Side,
    /// Samples of the level.
    back: Side,
}

impl Pairs {
    /// `levels` has the triangles of each level, and `first` the positions of the vertices in the first pose.
    fn new(levels: &[Vec<[u32; 3]>], first: &[DVec3]) -> Self {
        let points = |corners: &[u32; 3]| corners.map(|corner| first[corner as usize]);
        let all = levels[0].iter().flat_map(|corners| edges(points(corners))).sum::<f64>();
        let edge = all / (3 * levels[0].len()) as f64;
        let fine = Tree::new(levels[0].clone(), first);
        let near_fine = fine.posed(first);
        let coarse = |level: &Vec<[u32; 3]>| {
            let tree = Tree::new(level.clone(), first);
            let forth = Side::new(&levels[0], edge / DENSITY[0], &tree.posed(first));
            let back = Side::new(level, edge / DENSITY[1], &near_fine);
            Coarse { tree, forth, back }
        };
        let coarse = parallel::map(&levels[1..], coarse);
        Self { fine, coarse }
    }

    /// The squared distances of all levels at the positions `points`, where they exceed `known`; otherwise `known`.
    fn larger(&self, points: &[DVec3], known: &[f64]) -> Vec<f64> {
        let fine = self.fine.posed(points);
        let of_level = |(Coarse { tree, forth, back }, known): (&Coarse, &f64)| {
            back.largest(&fine, forth.largest(&tree.posed(points), *known))
        };
        self.coarse.iter().zip(known).map(of_level).collect()
    }
}

/// The lengths of a triangle's edges.
fn edges([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [a.distance(b), b.distance(c), c.distance(a)]
}

/// Barycentric coordinates of samples: a lattice with `steps` steps along each edge, then the midpoint.
fn samples(steps: u32) -> impl Iterator<Item = [f64; 3]> {
    let part = move |part: u32| f64::from(part) / f64::from(steps);
    let lattice =
        (0..=steps).flat_map(move |a| (0..=steps - a).map(move |b| [a, b, steps - a - b].map(part)));
    lattice.chain([[1.0 / 3.0; 3]])
}

fn blend(points: [DVec3; 3], parts: [f64; 3]) -> DVec3 {
    points.into_iter().zip(parts).map(|(point, part)| part * point).sum()
}
