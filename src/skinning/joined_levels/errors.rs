//! The distances of joined levels from level 0, in both directions, in many poses. Most samples are skipped in most poses:
//! a triangle that was near in the first pose is near enough.

use glam::DVec3;
use rayon::prelude::*;

use super::tree::{Posed, Tree};
use crate::asset::{Mesh, Model};
use crate::skinning::pose::{Moment, bones_at, positions_of};

/// The meshes of a level, as indices in the model.
pub(super) type Level = Vec<usize>;

/// Number of moments that are examined in parallel, from the same known distances.
const BATCH: usize = 64;

/// Smallest and largest number of steps along an edge of a level's triangle, between two samples.
const STEPS: [f64; 2] = [2.0, 8.0];

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
        let largest = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect();
        known = batch.par_iter().map(look).reduce(|| known.clone(), largest);
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
        let own: Vec<Vec<u32>> = model.meshes.iter().map(|mesh| (0..mesh.vertices() as u32).collect()).collect();
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
            model.meshes[*mesh].indices.as_chunks::<3>().0.iter().map(move |corners| corners.map(|at| start + at))
        };
        meshes.iter().flat_map(of_mesh).collect()
    }
}

/// A point in a triangle.
struct Sample {
    corners: [u32; 3],
    /// Barycentric coordinates.
    parts: [f64; 3],
    /// A triangle of the other surface that was near in the first pose, as its index in the tree.
    hint: u32,
}

impl Sample {
    fn new(corners: [u32; 3], parts: [f64; 3]) -> Self {
        Self { corners, parts, hint: 0 }
    }

    fn position(&self, points: &[DVec3]) -> DVec3 {
        self.corners.iter().zip(self.parts).map(|(corner, part)| part * points[*corner as usize]).sum()
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
    forth: Vec<Sample>,
    /// Samples of the level.
    back: Vec<Sample>,
}

impl Pairs {
    /// `levels` has the triangles of each level, and `first` the positions of the vertices in the first pose.
    fn new(levels: &[Vec<[u32; 3]>], first: &[DVec3]) -> Self {
        let length = |[a, b]: [u32; 2]| first[a as usize].distance(first[b as usize]);
        let edge = levels[0].iter().flat_map(|corners| edges(*corners)).map(length).sum::<f64>()
            / (3 * levels[0].len()) as f64;
        let fine = Tree::new(levels[0].clone(), first);
        let near_fine = fine.posed(first);
        let coarse = levels[1..].par_iter().map(|level| {
            let tree = Tree::new(level.clone(), first);
            let back = level.iter().flat_map(|corners| {
                let longest = edges(*corners).map(length).into_iter().fold(0.0, f64::max);
                // The quotient is not a number if level 0 has no extent.
                lattice(*corners, (longest / edge).ceil().max(STEPS[0]).min(STEPS[1]) as u32)
            });
            let (forth, back) = {
                let near = tree.posed(first);
                (hinted(samples(&levels[0]), &near, first), hinted(back, &near_fine, first))
            };
            Coarse { tree, forth, back }
        });
        let coarse = coarse.collect();
        Self { fine, coarse }
    }

    /// The squared distances of all levels at the positions `points`, where they exceed `known`; otherwise `known`.
    fn larger(&self, points: &[DVec3], known: &[f64]) -> Vec<f64> {
        let fine = self.fine.posed(points);
        let of_level = |(Coarse { tree, forth, back }, known): (&Coarse, &f64)| {
            let coarse = tree.posed(points);
            largest(back, &fine, largest(forth, &coarse, *known))
        };
        self.coarse.iter().zip(known).map(of_level).collect()
    }
}

/// The largest squared distance of samples from a surface; at least `known`.
fn largest(samples: &[Sample], surface: &Posed<'_>, mut known: f64) -> f64 {
    for sample in samples {
        let point = sample.position(surface.points());
        let squared = surface.squared_to(sample.hint, point);
        if squared > known {
            known = surface.beyond(point, squared, known).unwrap_or(known);
        }
    }
    known
}

fn hinted(samples: impl Iterator<Item = Sample>, other: &Posed<'_>, first: &[DVec3]) -> Vec<Sample> {
    samples.map(|sample| Sample { hint: other.nearest(sample.position(first)), ..sample }).collect()
}

fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// The vertices, and the midpoints of edges and triangles, each once.
fn samples(triangles: &[[u32; 3]]) -> impl Iterator<Item = Sample> {
    let once = |mut all: Vec<[u32; 3]>| {
        all.sort_unstable();
        all.dedup();
        all.into_iter()
    };
    let vertices = once(triangles.as_flattened().iter().map(|vertex| [*vertex; 3]).collect());
    let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b), a.min(b)];
    let edges = once(triangles.iter().flat_map(|corners| edges(*corners).map(sorted)).collect());
    let vertices = vertices.map(|corners| Sample::new(corners, [1.0, 0.0, 0.0]));
    let edges = edges.map(|corners| Sample::new(corners, [0.5, 0.5, 0.0]));
    let middles = triangles.iter().map(|corners| Sample::new(*corners, [1.0 / 3.0; 3]));
    vertices.chain(edges).chain(middles.collect::<Vec<_>>())
}

/// The midpoint of a triangle, and points in it with `steps` steps along each edge.
fn lattice(corners: [u32; 3], steps: u32) -> impl Iterator<Item = Sample> {
    let points = (0..=steps).flat_map(move |a| (0..=steps - a).map(move |b| [a, b, steps - a - b]));
    let sample = move |parts: [u32; 3]| Sample::new(corners, parts.map(|part| f64::from(part) / f64::from(steps)));
    points.map(sample).chain([Sample::new(corners, [1.0 / 3.0; 3])])
}
