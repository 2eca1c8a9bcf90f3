//! Levels of detail of skinned meshes: the mesh simplified for all that its clips do, and how far each level's surface
//! is off, measured (A sections 9.3 and 9.4: all poses of the animation count).

use std::iter::successors;

use glam::Vec3;
use rayon::prelude::*;

use super::pose::{Moment, Pose, moments};
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

/// The most that the finest level may be off, of the mesh's size ([`Keys::size`]).
const FIRST: f32 = 1e-3;

/// How much more each level may be off than the one before. Triangles go with about its inverse.
const STEP: f32 = std::f32::consts::SQRT_2;

/// A level has at most so many of the triangles of the one before; otherwise it is left out.
const WORTHWHILE: f64 = 0.9;

/// What a normal that is off by 1 counts, of the mesh's size.
const NORMAL: f32 = 5e-3;

/// By how much [`MeshLevel::error`] is larger than what was found, for what lies between the poses.
const ERROR_MARGIN: f32 = 1.01;

/// Coarser forms of one of a model's meshes.
#[derive(Debug, Clone)]
pub struct MeshLevels {
    /// For [`Mesh::levels`]: the first is off by a thousandth of the mesh's size, each by 1.4 times as much as the one
    /// before, and has 0.9 times its triangles at most. None where nothing can be left out. The size is the diagonal of
    /// the box around its triangles at rest; where clips make it more than twice as large or small, in the pose in which
    /// they make it largest. Units in which a mesh was bound do not matter.
    pub levels: Vec<MeshLevel>,
    near: Vec<Near>,
}

impl MeshLevels {
    /// Simplifies a mesh for these clips and its rest pose, and measures each level in `poses` of each clip, evenly spaced
    /// from start to end; [`poses_of`](super::poses_of) a clip are many enough. Without clips at rest alone. Blended
    /// linearly, with the weights of morph targets that the clips have. Edges that are hard in normals alone do not
    /// matter: what is left keeps vertices that face as they did.
    ///
    /// The error of a level is the largest distance, in all of these poses, from a vertex of the mesh to the level's
    /// triangles near it, and from the middles of the level's triangles and their edges to the mesh's triangles that
    /// they stand for; 1 % more, for poses between these. Other places on the surfaces may be further apart: of a creature
    /// and a cow up to 1.4 times as far, where a mesh is as coarse as its bumps up to 10 times.
    ///
    /// A model that is as many times as large as another has the same levels, and errors as many times as large,
    /// whatever makes it so: exactly for powers of two; otherwise rounding may decide between collapses that cost the
    /// same.
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

    /// The place on level `level + 1` of the mesh that is nearest to where a vertex of the mesh should be, among the
    /// triangles that were nearest in some pose; `point` of a level's vertices says where they are. A vertex that the
    /// level has is at its own place.
    ///
    /// # Panics
    /// For levels and vertices that there are not.
    pub fn nearest(&self, level: usize, vertex: usize, wanted: Vec3, point: impl Fn(u32) -> Vec3) -> Vec3 {
        self.near[level].nearest(vertex, wanted, &point).unwrap_or_else(|| point(vertex as u32))
    }
}

/// Gives all meshes of a model their levels ([`MeshLevels::new`]), and says what each was found to be.
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

/// Where all vertices are, in multiples of `unit`.
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

/// A level on its way.
struct Found {
    /// What each vertex has become.
    remap: Vec<u32>,
    indices: Vec<u32>,
}

/// Of vertices of the one before each.
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

    /// What is measured is what was kept, where the simplifier saw all moments: nothing near is overlooked.
    #[test]
    fn errors_are_the_distances_that_were_kept() {
        let plain = crate::samples::creature().expect("valid");
        for scale in [1e-6, 1.0, 1e8, 1e15] {
            let mut model = plain.clone();
            let mesh = &mut model.meshes[0];
            mesh.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
            // All of it follows one bone, or bones would have to be as large.
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

    /// A ninth of the triangles within a hundredth of its height, and every level as good as it says in moments that nobody
    /// looked at.
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

    /// Every triangle with vertices of its own, which face as it does: what is left of it still does.
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
            // Where normals are means of others, other collapses come first.
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
