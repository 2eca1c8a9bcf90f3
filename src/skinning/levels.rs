//! Levels of detail of skinned meshes: the mesh is simplified for all poses of its clips, and the error of each
//! level is measured (A sections 9.3 and 9.4: all poses of the animation count). Meshes of a model that share borders are
//! simplified as one, so that no gap opens between them (B section 5.2).

use std::iter::successors;

use glam::Vec3;
use rayon::prelude::*;

use super::attribute_weights::NORMAL;
use super::pose::{Moment, moments};
use crate::InputError;
use crate::asset::Model;
use crate::asset::mesh::{MAX_LEVELS, MeshLevel};
use crate::mesh::progressive::{Became, partners};
use crate::mesh::simplify::{Options, Simplified, Surface, simplify_within};
pub use coarsen::{Coarsened, coarsen};
use keys::{Keys, key_moments};
use near::{Near, Sides};
use welded::Welded;
use whole::{Shared, Whole, shared};

mod coarsen;
mod keys;
mod near;
mod welded;
mod whole;

/// The error of the finest level, as a fraction of the mesh's size ([`Keys::size`]).
const FIRST: f32 = 1e-3;

/// The ratio of the errors of successive levels. Numbers of triangles fall by about its inverse.
const STEP: f32 = std::f32::consts::SQRT_2;

/// A level is kept only if its triangles are at most this fraction of the level before.
const WORTHWHILE: f64 = 0.9;

/// The margin by which [`MeshLevel::error`] exceeds the sampled maximum, for what lies between poses.
const ERROR_MARGIN: f32 = 1.03;

/// Coarser levels of one of a model's meshes.
#[derive(Debug, Clone)]
pub struct MeshLevels {
    /// The levels for [`Mesh::levels`](crate::asset::Mesh::levels). The first has an error of a thousandth of the mesh's size, and each
    /// later one 1.4 times the error of the one before and at most 0.9 times its triangles. Empty if nothing
    /// can be removed. The size is the diagonal of the box around the triangles at rest or, if clips make the
    /// mesh more than twice as large or small, in the pose in which they make it largest. The units in which a
    /// mesh was bound do not matter. Where meshes share borders, sizes and numbers of triangles are those of all of them
    /// together, and all have equally many levels with the same errors.
    pub levels: Vec<MeshLevel>,
    /// The partner of each vertex, for [`Mesh::partners`](crate::asset::Mesh::partners).
    pub partners: Vec<u32>,
    near: Vec<Near>,
}

impl MeshLevels {
    /// Simplifies a mesh for these clips and its rest pose, and measures each level in `poses` of each clip,
    /// evenly spaced from start to end; [`poses_of`](super::poses_of) gives a sufficient number for a clip.
    /// Without clips only the rest pose counts. Blending is linear, with the clips' weights of morph targets.
    /// Edges that are hard in normals only do not hinder simplification: each remaining corner keeps a vertex
    /// whose normal is close to its own. The model's other meshes do not matter; [`add_levels`] keeps borders to them closed.
    ///
    /// The error of a level is the largest distance, in all of these poses, between a vertex of the mesh and
    /// the level's triangles close to it, and between midpoints of the level's triangles and edges and the
    /// mesh's triangles for which they stand. It is increased by 3 % for poses in between. Other points of the
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
        let mut all = levels_of(&Whole::new(model, &[mesh], &Shared::new()), &moments)?;
        Ok(all.remove(0))
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

/// The levels of meshes that are simplified as one: one entry for each, which have equally many levels with the same errors.
fn levels_of(whole: &Whole<'_>, moments: &[Moment]) -> Result<Vec<MeshLevels>, InputError> {
    let keys = Keys::new(whole, moments);
    let welded = Welded::new(whole, &keys.poses);
    let simplified = simplified(whole, &welded, &keys)?;
    let levels = found(whole, &welded, &simplified);
    let unit = keys.unit;
    let poses: Vec<Vec<Vec3>> =
        keys.poses.into_iter().map(|pose| pose.into_iter().map(Vec3::from).collect()).collect();
    let sides: Vec<Sides> =
        levels.par_iter().map(|level| Sides::new(whole, &simplified, level, &poses)).collect();
    let errors = moments
        .par_iter()
        .map(|moment| {
            let points = whole.points(*moment, unit);
            sides.iter().map(|sides| sides.error(&points)).collect::<Vec<f32>>()
        })
        .reduce(|| vec![0.0; sides.len()], |a, b| a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect());
    let mut most = 0.0_f32;
    let error = |error: f32| {
        most = most.max(unit * (ERROR_MARGIN * error));
        most
    };
    let errors: Vec<f32> = errors.into_iter().map(error).collect();
    let became: Vec<Became<'_>> =
        levels.iter().map(|level| Became { indices: &level.indices, remap: &level.into }).collect();
    let place = |vertex: u32| (whole.member[vertex as usize], simplified.point(vertex));
    let partners = partners(&whole.indices, &became, place, whole.vertices());
    let of_mesh = |member: usize| {
        let level = |(level, error): (&Found, &f32)| MeshLevel {
            indices: whole.own(&level.indices, member),
            error: *error,
        };
        let local = |vertex: u32| whole.local(vertex);
        MeshLevels {
            levels: levels.iter().zip(&errors).map(level).collect(),
            partners: partners[whole.range(member)].iter().map(|vertex| local(*vertex)).collect(),
            near: sides.iter().map(|sides| sides.near.part(whole.range(member), local)).collect(),
        }
    };
    Ok((0..whole.meshes.len()).map(of_mesh).collect())
}

/// Computes the levels of all meshes of a model ([`MeshLevels::new`]), sets them, and returns them. Meshes whose borders have
/// the same positions in every pose are simplified as one: their borders stay closed at every level, and they have equally
/// many levels with the same errors. A mesh of which nothing is left at a level has one triangle without area there. `clips` are the indices
/// of the clips that will be played, none for a mesh that stands still, and `poses` is the number of poses of each of them
/// that are examined: the largest of [`poses_of`](super::poses_of) misses no motion, fewer are quicker.
///
/// The time grows with vertices × clips × poses: seconds for a character of a few thousand vertices, but minutes for one of
/// tens of thousands or a clip of half a minute. The result is plain data ([`Mesh::levels`](crate::asset::Mesh::levels)) that a program may store.
///
/// # Errors
/// [`InputError`] as [`MeshLevels::new`].
pub fn add_levels(model: &mut Model, clips: &[usize], poses: usize) -> Result<Vec<MeshLevels>, InputError> {
    let each = (0..model.meshes.len()).map(|mesh| moments(model, mesh, clips, poses));
    let Some(moments) = each.collect::<Result<Vec<_>, _>>()?.into_iter().next() else {
        return Ok(Vec::new());
    };
    let (borders, groups) = shared(model, &key_moments(&moments));
    let mut all: Vec<(usize, MeshLevels)> = Vec::with_capacity(model.meshes.len());
    for group in &groups {
        let found = levels_of(&Whole::new(model, group, &borders), &moments)?;
        all.extend(group.iter().copied().zip(found));
    }
    all.sort_by_key(|(mesh, _)| *mesh);
    let all: Vec<MeshLevels> = all.into_iter().map(|(_, found)| found).collect();
    for (mesh, found) in model.meshes.iter_mut().zip(&all) {
        mesh.levels.clone_from(&found.levels);
        mesh.partners.clone_from(&found.partners);
    }
    Ok(all)
}

fn simplified(whole: &Whole<'_>, welded: &Welded, keys: &Keys) -> Result<Simplified, InputError> {
    let texture = keys.texture_factors(whole);
    let (normals, indices) = (welded.normals(&keys.normals), welded.indices(whole));
    let attributes: Vec<f32> = (normals.iter().zip(&whole.uv).zip(&whole.member))
        .flat_map(|(([x, y, z], [u, v]), member)| {
            let texture = texture[*member as usize];
            [NORMAL * x, NORMAL * y, NORMAL * z, texture * u, texture * v]
        })
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
    /// For each vertex of the level before, the vertex that takes its place.
    into: Vec<u32>,
    indices: Vec<u32>,
}

/// The levels, each using a subset of the vertices of the one before.
fn found(whole: &Whole<'_>, welded: &Welded, simplified: &Simplified) -> Vec<Found> {
    let mut distances: Vec<f32> = simplified.collapses().iter().map(|collapse| collapse.distance).collect();
    distances.dedup();
    let mut last = whole.indices.len() / 3;
    let mut levels: Vec<Found> = Vec::new();
    for distance in distances {
        let remap = welded.remap(simplified, simplified.collapses_near(distance));
        let before = levels.last().map_or(&whole.indices, |level| &level.indices);
        let (indices, into, triangles) = welded.next(whole, simplified, &remap, before);
        if triangles > 0 && triangles as f64 <= WORTHWHILE * last as f64 {
            last = triangles;
            levels.push(Found { remap, into, indices });
        }
    }
    levels
}

#[cfg(all(test, feature = "samples"))]
mod tests {
    use super::*;
    use crate::asset::{Influence, Influences, Mesh};
    use crate::skinning::pose::Pose;

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
            let whole = Whole::new(&model, &[0], &Shared::new());
            let keys = Keys::new(&whole, &[Moment::In(0, 0.0)]);
            let welded = Welded::new(&whole, &keys.poses);
            let simplified = simplified(&whole, &welded, &keys).expect("valid");
            let mut distances: Vec<f32> = simplified.collapses().iter().map(|one| one.distance).collect();
            distances.dedup();
            let levels = super::found(&whole, &welded, &simplified);
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
        // Where normals are averages of others, other collapses come first, and a level more may be worthwhile.
        assert!(found.levels.len().abs_diff(smooth.levels.len()) <= 1);
        let mut compared = 0;
        for hard in &found.levels {
            let alike = |level: &&MeshLevel| (0.95..1.05).contains(&(level.error / hard.error));
            if let Some(smooth) = smooth.levels.iter().find(alike) {
                let ratio = hard.indices.len() as f64 / smooth.indices.len() as f64;
                assert!((0.85..1.15).contains(&ratio), "{ratio}");
                compared += 1;
            }
        }
        assert!(compared > 8, "{compared}");
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
