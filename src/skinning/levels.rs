//! Levels of detail of skinned meshes: the mesh is simplified for all poses of its clips, and the error of each
//! level is measured (A sections 9.3 and 9.4: all poses of the animation count).

use std::iter::successors;

use glam::Vec3;
use rayon::prelude::*;

use super::pose::{Moment, Pose, moments, poses_of};
use crate::InputError;
use crate::asset::Model;
use crate::asset::mesh::{MAX_LEVELS, Mesh, MeshLevel};
use crate::mesh::simplify::{Options, Simplified, Surface, simplify_within};
use keys::Keys;
use near::{Near, Sides};
use welded::Welded;

mod keys;
mod near;
mod welded;

/// The error of the finest level, as a fraction of the mesh's size ([`Keys::size`]).
const FIRST: f32 = 1e-3;

/// The ratio of the errors of successive levels. Numbers of triangles fall by about its inverse.
const STEP: f32 = std::f32::consts::SQRT_2;

/// A level is kept only if its triangles are at most this fraction of the level before.
const WORTHWHILE: f64 = 0.9;

/// The cost of a difference of 1 in a normal, as a fraction of the mesh's size.
const NORMAL: f32 = 5e-3;

/// The margin by which [`MeshLevel::error`] exceeds the sampled maximum, for what lies between poses.
const ERROR_MARGIN: f32 = 1.01;

/// Coarser levels of one of a model's meshes.
#[derive(Debug, Clone)]
pub struct MeshLevels {
    /// The levels for [`Mesh::levels`]. The first has an error of a thousandth of the mesh's size, and each
    /// later one 1.4 times the error of the one before and at most 0.9 times its triangles. Empty if nothing
    /// can be removed. The size is the diagonal of the box around the triangles at rest or, if clips make the
    /// mesh more than twice as large or small, in the pose in which they make it largest. The units in which a
    /// mesh was bound do not matter.
    pub levels: Vec<MeshLevel>,
    near: Vec<Near>,
}

impl MeshLevels {
    /// Simplifies a mesh for these clips and its rest pose, and measures each level in `poses` of each clip,
    /// evenly spaced from start to end; [`poses_of`] gives a sufficient number for a clip.
    /// Without clips only the rest pose counts. Blending is linear, with the clips' weights of morph targets.
    /// Edges that are hard in normals only do not hinder simplification: each remaining corner keeps a vertex
    /// whose normal is close to its own.
    ///
    /// The error of a level is the largest distance, in all of these poses, between a vertex of the mesh and
    /// the level's triangles close to it, and between midpoints of the level's triangles and edges and the
    /// mesh's triangles for which they stand. It is increased by 1 % for poses in between. Other points of the
    /// surfaces may be further apart: up to 1.4 times as far for a creature and a cow, and up to 10 times for a
    /// mesh that is as coarse as its bumps.
    ///
    /// A model that is scaled has the same levels, with errors scaled alike, however it is scaled: exactly for
    /// powers of two; for other factors rounding may decide between collapses of equal cost.
    ///
    /// # Errors
    /// [`InputError`] as [`Extent::new`](super::Extent::new).
    pub fn new(model: &Model, mesh: usize, clips: &[usize], poses: usize) -> Result<Self, InputError> {
        let moments = moments(model, mesh, clips, poses)?;
        let mesh = &model.meshes[mesh];
        let keys = Keys::new(model, mesh, &moments);
        let welded = Welded::new(mesh, &keys.poses);
        let simplified = simplified(mesh, &welded, &keys)?;
        let levels = found(mesh, &welded, &simplified);
        let unit = keys.unit;
        let poses: Vec<Vec<Vec3>> =
            keys.poses.into_iter().map(|pose| pose.into_iter().map(Vec3::from).collect()).collect();
        let sides: Vec<Sides> =
            levels.par_iter().map(|level| Sides::new(mesh, &simplified, level, &poses)).collect();
        let errors = moments
            .par_iter()
            .map(|moment| {
                let points = points(model, mesh, *moment, unit);
                sides.iter().map(|sides| sides.error(&points)).collect::<Vec<f32>>()
            })
            .reduce(|| vec![0.0; sides.len()], |a, b| a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect());
        let mut most = 0.0_f32;
        let level = |(Found { indices, .. }, error): (Found, f32)| {
            most = most.max(unit * (ERROR_MARGIN * error));
            MeshLevel { indices, error: most }
        };
        Ok(Self {
            levels: levels.into_iter().zip(errors).map(level).collect(),
            near: sides.into_iter().map(|sides| sides.near).collect(),
        })
    }

    /// The point on level `level + 1` of the mesh that is nearest to `wanted`, the correct position of a vertex
    /// of the mesh, among the triangles that were nearest in some pose. `point` gives the positions of the
    /// level's vertices. A vertex that the level has is at its own position.
    ///
    /// # Panics
    /// For levels and vertices that do not exist.
    pub fn nearest(&self, level: usize, vertex: usize, wanted: Vec3, point: impl Fn(u32) -> Vec3) -> Vec3 {
        self.near[level].nearest(vertex, wanted, &point).unwrap_or_else(|| point(vertex as u32))
    }
}

/// Computes the levels of all meshes of a model ([`MeshLevels::new`]), sets them, and returns them. `clips` are the indices
/// of the clips that will be played, none for a mesh that stands still, and `poses` is the number of poses of each of them
/// that are examined: the largest of [`poses_of`] misses no motion, fewer are quicker.
///
/// The time grows with vertices × clips × poses: seconds for a character of a few thousand vertices, but minutes for one of
/// tens of thousands or a clip of half a minute. The result is plain data ([`Mesh::levels`]) that a program may store.
///
/// # Errors
/// [`InputError`] as [`MeshLevels::new`].
pub fn add_levels(model: &mut Model, clips: &[usize], poses: usize) -> Result<Vec<MeshLevels>, InputError> {
    let meshes = 0..model.meshes.len();
    let all = meshes.map(|mesh| MeshLevels::new(model, mesh, clips, poses));
    let all = all.collect::<Result<Vec<_>, _>>()?;
    for (mesh, found) in model.meshes.iter_mut().zip(&all) {
        mesh.levels.clone_from(&found.levels);
    }
    Ok(all)
}

/// What became of a mesh that was coarsened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coarsened {
    /// Triangles that are left.
    pub triangles: usize,
    /// Triangles that it had.
    pub of: usize,
    /// How far it is off, in the model's units, in any pose of the clip or at rest.
    pub error: f32,
}

/// Gives every mesh the triangles of the coarsest of its levels that is off by no more than `within` (the model's units) in
/// any pose of a clip, which is looked at 60 times a second, or at rest.
///
/// # Errors
/// [`InputError`] for a distance that is negative or not finite, and as [`poses_of`] and [`MeshLevels::new`].
pub fn coarsen(model: &mut Model, clip: usize, within: f32) -> Result<Vec<Coarsened>, InputError> {
    if !(within >= 0.0 && within.is_finite()) {
        return Err(InputError::new("within", within, "must be finite, and not negative"));
    }
    let poses = model.clips.get(clip).map_or(Ok(1), poses_of)?;
    add_levels(model, &[clip], poses)?;
    let coarsened = |mesh: &mut Mesh| {
        let of = mesh.indices.len() / 3;
        let level = std::mem::take(&mut mesh.levels).into_iter().rfind(|level| level.error <= within);
        let error = level.as_ref().map_or(0.0, |level| level.error);
        if let Some(level) = level {
            mesh.indices = level.indices;
        }
        Coarsened { triangles: mesh.indices.len() / 3, of, error }
    };
    Ok(model.meshes.iter_mut().map(coarsened).collect())
}

/// The positions of all vertices, in multiples of `unit`.
fn points(model: &Model, mesh: &Mesh, moment: Moment, unit: f32) -> Vec<Vec3> {
    let all = Pose::new(model, mesh, moment).positions(mesh);
    all.into_iter().map(|point| point / unit).collect()
}

fn simplified(mesh: &Mesh, welded: &Welded, keys: &Keys) -> Result<Simplified, InputError> {
    let (normal, texture) = (NORMAL * keys.size, keys.texture_scale(mesh));
    let (normals, indices) = (welded.normals(&keys.normals), welded.indices(mesh));
    let attributes: Vec<f32> = (normals.iter().zip(&mesh.uv))
        .flat_map(|([x, y, z], [u, v])| [normal * x, normal * y, normal * z, texture * u, texture * v])
        .collect();
    let surface = Surface { poses: &keys.poses, indices: &indices, attributes: &attributes, stride: 5 };
    let distances: Vec<f32> =
        successors(Some(FIRST * keys.size), |last| Some(STEP * last)).take(MAX_LEVELS - 1).collect();
    simplify_within(&surface, &Options::default(), &distances)
}

/// A level under construction.
struct Found {
    /// The vertex into which each vertex has collapsed.
    remap: Vec<u32>,
    indices: Vec<u32>,
}

/// The levels, each using a subset of the vertices of the one before.
fn found(mesh: &Mesh, welded: &Welded, simplified: &Simplified) -> Vec<Found> {
    let mut distances: Vec<f32> = simplified.collapses().iter().map(|collapse| collapse.distance).collect();
    distances.dedup();
    let mut last = mesh.indices.len();
    let mut used = vec![true; mesh.vertices()];
    let level = |distance: f32| {
        let remap = welded.remap(simplified, simplified.collapses_near(distance));
        let indices = welded.triangles(mesh, simplified, &remap, &used);
        if indices.is_empty() || indices.len() as f64 > WORTHWHILE * last as f64 {
            return None;
        }
        last = indices.len();
        used.fill(false);
        indices.iter().for_each(|vertex| used[*vertex as usize] = true);
        Some(Found { remap, indices })
    };
    distances.into_iter().filter_map(level).collect()
}

#[cfg(all(test, feature = "samples"))]
mod tests {
    use super::*;
    use crate::asset::{Influence, Influences};

    /// If the simplifier saw all moments, the measured errors equal the distances that it kept: no near
    /// triangle is overlooked.
    #[test]
    fn errors_are_the_distances_that_were_kept() {
        let plain = crate::samples::creature().expect("valid");
        for scale in [1e-6, 1.0, 1e8, 1e15] {
            let mut model = plain.clone();
            let mesh = &mut model.meshes[0];
            mesh.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
            // All vertices follow one bone; otherwise the bones would have to be scaled too.
            let follows = (0..mesh.vertices()).map(|_| vec![Influence { bone: 0, weight: 1.0 }]);
            mesh.influences = Influences::new("w", model.skins[0].bones.len(), follows).expect("valid");
            let mesh = &model.meshes[0];
            let keys = Keys::new(&model, mesh, &[Moment::In(0, 0.0)]);
            let welded = Welded::new(mesh, &keys.poses);
            let simplified = simplified(mesh, &welded, &keys).expect("valid");
            let mut distances: Vec<f32> = simplified.collapses().iter().map(|one| one.distance).collect();
            distances.dedup();
            let levels = found(mesh, &welded, &simplified);
            let found = MeshLevels::new(&model, 0, &[0], 1).expect("valid").levels;
            assert_eq!(levels.len(), found.len());
            assert!(levels.len() > 9, "{} at {scale}", levels.len());
            for (MeshLevel { indices, error }, kept) in found.iter().zip(&levels) {
                assert_eq!(*indices, kept.indices);
                let remap = |distance: f32| welded.remap(&simplified, simplified.collapses_near(distance));
                let distance = distances.iter().find(|distance| remap(**distance) == kept.remap);
                let part = error / (ERROR_MARGIN * keys.unit * distance.expect("one of them"));
                assert!((0.95..=1.001).contains(&part), "{part} at {scale}");
            }
        }
    }

    /// A ninth of the triangles remain within a hundredth of the height, and at moments that were not sampled
    /// every level keeps its error too.
    #[test]
    fn creatures_lose_triangles_by_distance() {
        let model = crate::samples::creature().expect("valid");
        let mesh = &model.meshes[0];
        let found = MeshLevels::new(&model, 0, &[0, 2], 16).expect("valid");
        let mut levelled = model.clone();
        levelled.meshes[0].levels.clone_from(&found.levels);
        assert_eq!(levelled.meshes[0].validate(&model.skins), Ok(()));
        let triangles = |error: f32| {
            let levels = found.levels.iter().filter(|level| level.error < error);
            levels.map(|level| level.indices.len()).min().unwrap_or(mesh.indices.len())
        };
        assert!(5 * triangles(0.011) < mesh.indices.len() && 9 * triangles(0.018) < mesh.indices.len());
        for (level, MeshLevel { indices, error }) in found.levels.iter().enumerate() {
            let mut worst = 0.0_f32;
            for (clip, fraction) in [(0, 0.123), (0, 0.77), (2, 0.41)] {
                let points = Pose::new(&model, mesh, Moment::In(clip, fraction)).positions(mesh);
                let mut drawn = vec![Vec3::NAN; points.len()];
                indices.iter().for_each(|vertex| drawn[*vertex as usize] = points[*vertex as usize]);
                for (vertex, point) in points.iter().enumerate() {
                    let nearest = found.nearest(level, vertex, *point, |vertex| drawn[vertex as usize]);
                    assert!(nearest.is_finite(), "level {level}: vertex {vertex}");
                    worst = worst.max(nearest.distance(*point));
                }
            }
            assert!(worst <= *error && worst > 0.5 * error, "level {level}: {worst} of {error}");
        }
    }

    /// A mesh in which every triangle has vertices of its own, with its face normal; the remaining triangles
    /// keep such normals.
    #[test]
    fn hard_edges_do_not_matter() {
        let mut model = crate::samples::creature().expect("valid");
        let smooth = MeshLevels::new(&model, 0, &[0], 9).expect("valid");
        let mesh = model.meshes[0].clone();
        let corners: Vec<usize> = mesh.indices.iter().map(|vertex| *vertex as usize).collect();
        let influences = corners.iter().map(|vertex| mesh.influences.of(*vertex).to_vec());
        let positions: Vec<_> = corners.iter().map(|vertex| mesh.positions[*vertex]).collect();
        let indices: Vec<u32> = (0..corners.len() as u32).collect();
        let hard = Mesh {
            normals: crate::asset::mesh::smooth_normals(&positions, &indices),
            tangents: corners.iter().map(|vertex| mesh.tangents[*vertex]).collect(),
            uv: corners.iter().map(|vertex| mesh.uv[*vertex]).collect(),
            influences: Influences::new("w", model.skins[0].bones.len(), influences).expect("valid"),
            positions,
            indices,
            ..mesh
        };
        model.meshes[0] = hard;
        let found = add_levels(&mut model, &[0], 9).expect("valid").remove(0);
        assert_eq!(model.meshes[0].validate(&model.skins), Ok(()));
        assert_eq!(found.levels.len(), smooth.levels.len());
        for (hard, smooth) in found.levels.iter().zip(&smooth.levels) {
            // Where normals are averages of others, other collapses come first.
            let ratio = hard.indices.len() as f64 / smooth.indices.len() as f64;
            assert!((0.9..1.1).contains(&ratio), "{ratio}");
        }
        let mesh = &model.meshes[0];
        let face = |triangle: &[u32]| {
            let [a, b, c] = [0, 1, 2].map(|at| Vec3::from(mesh.positions[triangle[at] as usize]));
            (b - a).cross(c - a).normalize_or_zero()
        };
        let facing = found.levels[3].indices.chunks_exact(3).flat_map(|triangle| {
            let face = face(triangle);
            triangle.iter().map(move |vertex| face.dot(mesh.normals[*vertex as usize].into()))
        });
        let all: Vec<f32> = facing.collect();
        let mean = all.iter().sum::<f32>() / all.len() as f32;
        assert!(mean > 0.9, "{mean}");
    }
}
