//! Levels of detail of skinned meshes. A mesh is simplified for all poses of its clips, and the error of each level is
//! measured in all of these poses (thesis A sections 9.3 and 9.4). Meshes of a model that share borders are simplified as one
//! surface, so that no gap opens between them (thesis B section 5.2).

use std::iter::successors;
use std::ops::ControlFlow;

use glam::Vec3;

use super::attribute_weights::NORMAL;
use super::pose::{Moment, moments};
use crate::InputError;
use crate::asset::mesh::{MAX_LEVELS, MeshLevel};
use crate::asset::{Mesh, Model};
use crate::mesh::progressive::{Became, partners};
use crate::mesh::simplify::{Groups, Simplified, SimplifyOptions, Surface, simplify_watched};
use crate::parallel;
use bodies::Bodies;
use errors::{Suspects, errors};
use keys::{Keys, key_moments};
use near::{Near, Sides};
use welded::Welded;
use whole::{Shared, Whole, shared};

mod bodies;
mod errors;
mod keys;
mod near;
mod welded;
mod whole;

/// The error of the first level, as a fraction of the mesh's size ([`Keys::size`]).
const FIRST: f32 = 1e-3;

/// The ratio between the errors of successive levels. From level to level, the number of triangles falls by about this
/// factor.
const STEP: f32 = std::f32::consts::SQRT_2;

/// A level is kept only if its triangle count is at most this fraction of the previous level's count.
const WORTHWHILE: f64 = 0.9;

/// Safety factor of [`MeshLevel::error`] over the sampled maximum, for poses between the samples.
pub(super) const ERROR_MARGIN: f32 = 1.03;

/// The coarser levels of detail of one mesh of a model.
#[derive(Debug, Clone)]
pub struct MeshLevels {
    /// The levels for [`Mesh::levels`](crate::asset::Mesh::levels). Empty if nothing can be removed.
    ///
    /// The first level has an error of a thousandth of the mesh's size. Each later level has 1.4 times the error of the
    /// previous level, and at most 0.9 times its triangles. The size is the diagonal of the box around the triangles at
    /// rest. If the largest pose of the clips has more than twice or less than half this size, its size counts instead.
    /// The units of the bind pose do not matter. If meshes share borders, sizes and triangle counts are taken over all
    /// of these meshes together. All of these meshes have the same number of levels with the same errors.
    pub levels: Vec<MeshLevel>,
    /// For each vertex, the vertex that replaces it at coarser levels; see
    /// [`Mesh::partners`](crate::asset::Mesh::partners).
    pub partners: Vec<u32>,
    near: Vec<Near>,
}

impl MeshLevels {
    /// Simplifies a mesh for its rest pose and the given clips. The error of each level is measured in `poses` poses of
    /// each clip, evenly spaced from start to end.
    ///
    /// [`poses_of`](super::poses_of) gives a sufficient number of poses for a clip. Without clips, only the rest pose
    /// counts. Blending is linear, with the clips' weights of morph targets.
    ///
    /// Vertices that differ only in normals are merged first. Afterwards each remaining triangle corner gets the vertex
    /// with the closest normal: closest to the corner's own normal, or, in a flat-shaded triangle, to the triangle's
    /// normal. Texture coordinates count if the mesh's material shows a texture, or if the mesh has no material. The
    /// model's other meshes are ignored; [`add_levels`] keeps borders between meshes closed.
    ///
    /// The error of a level is the largest of the following distances in all sampled poses, plus 3 % for poses in
    /// between:
    ///
    /// - from each vertex of the mesh to the nearby triangles of the level;
    /// - from the midpoint of each triangle and edge of the level to the nearby triangles of the mesh.
    ///
    /// Other points of the two surfaces may be further apart: up to 1.4 times as far for a creature and a cow, and up
    /// to 10 times for a mesh whose triangles are as large as its bumps.
    ///
    /// A scaled model has the same levels, and their errors scale with it. This is exact for powers of two. For other
    /// factors, rounding may change the order of collapses with equal cost.
    ///
    /// # Errors
    /// [`InputError`] in the cases of [`Extent::new`](super::Extent::new).
    pub fn new(model: &Model, mesh: usize, clips: &[usize], poses: usize) -> Result<Self, InputError> {
        let moments = moments(model, mesh, clips, poses)?;
        let task =
            Task { model, moments: &moments, bodies: &Bodies::new(model, &[mesh], &looked_at(&moments)) };
        let all = task.run(&[vec![mesh]], &Shared::new(), &mut unwatched)?;
        Ok(all.unwrap_or_default().remove(0).1)
    }

    /// The point on level `level + 1` of the mesh that is nearest to `wanted`, the correct position of the mesh's
    /// vertex `vertex`. Only triangles that were nearest to the vertex in some pose are searched. `point` gives the
    /// positions of the level's vertices. If the level has the vertex, the result is the vertex's own position.
    ///
    /// # Panics
    /// If the level or the vertex does not exist.
    pub fn nearest(&self, level: usize, vertex: usize, wanted: Vec3, point: impl Fn(u32) -> Vec3) -> Vec3 {
        self.near[level].nearest(vertex, wanted, &point).unwrap_or_else(|| point(vertex as u32))
    }
}

/// Fraction of the progress that simplification takes. Measuring errors takes the rest.
const SIMPLIFICATION: f64 = 0.7;

/// The inputs for computing levels.
struct Task<'a> {
    model: &'a Model,
    moments: &'a [Moment],
    bodies: &'a Bodies,
}

impl Task<'_> {
    /// The levels of all meshes of `groups`, each with the mesh's index. The meshes of a group are simplified as one,
    /// and have the same number of levels with the same errors. `watch` gets the progress, from 0 to 1 and never
    /// decreasing. If `watch` breaks, the result is `None`.
    fn run(
        &self,
        groups: &[Vec<usize>],
        borders: &Shared,
        watch: &mut dyn FnMut(f32) -> ControlFlow<()>,
    ) -> Result<Option<Vec<(usize, MeshLevels)>>, InputError> {
        let wholes: Vec<Whole<'_>> =
            groups.iter().map(|group| Whole::new(self.model, group, borders)).collect();
        let all = wholes.iter().map(|whole| whole.indices.len()).sum::<usize>().max(1) as f64;
        let mut begun = 0.0;
        let mut groups = Vec::with_capacity(wholes.len());
        for whole in &wholes {
            let part = whole.indices.len() as f64 / all;
            let mut removed = |fraction: f64| watch((SIMPLIFICATION * (begun + part * fraction)) as f32);
            let Some(group) = Group::new(whole, self.moments, self.bodies, &mut removed)? else {
                return Ok(None);
            };
            groups.push(group);
            begun += part;
        }
        let mut looked = |moments: usize| {
            let fraction = moments as f64 / self.moments.len() as f64;
            watch((SIMPLIFICATION + (1.0 - SIMPLIFICATION) * fraction) as f32)
        };
        let suspects: Vec<_> = groups.iter().map(|group| (group.whole, &group.suspects)).collect();
        let errors = errors(self.model, &suspects, self.moments, &mut looked).continue_value();
        let Some(errors) = errors.filter(|_| watch(1.0).is_continue()) else { return Ok(None) };
        let found = groups.iter().zip(&errors).flat_map(|(group, errors)| group.levels(errors));
        Ok(Some(found.collect()))
    }
}

/// Meshes that are simplified as one surface, and the levels found so far.
struct Group<'a> {
    whole: &'a Whole<'a>,
    unit: f32,
    simplified: Simplified,
    levels: Vec<Found>,
    sides: Vec<Sides>,
    suspects: Suspects,
}

impl<'a> Group<'a> {
    fn new(
        whole: &'a Whole<'a>,
        moments: &[Moment],
        bodies: &Bodies,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Option<Self>, InputError> {
        let keys = Keys::new(whole, moments);
        let welded = Welded::new(whole, &keys.poses);
        let of: Vec<u32> = whole.meshes.iter().flat_map(|mesh| bodies.of(*mesh)).copied().collect();
        let Some(simplified) = simplified(whole, &welded, &keys, &of, watch)? else { return Ok(None) };
        let levels = found(whole, &welded, &keys, &simplified);
        let unit = keys.unit;
        let poses: Vec<Vec<Vec3>> =
            keys.poses.into_iter().map(|pose| pose.into_iter().map(Vec3::from).collect()).collect();
        let sides: Vec<Sides> =
            parallel::map(&levels, |level| Sides::new(whole, &simplified, level, &poses, &of));
        let suspects = Suspects::new(whole, &sides, &poses[0], &of, [unit, bodies.rounding / unit]);
        Ok(Some(Self { whole, unit, simplified, levels, sides, suspects }))
    }

    /// The finished levels of each mesh, with the mesh's index. `errors` has the largest distance per level, in units
    /// of `unit`.
    fn levels(&self, errors: &[f32]) -> Vec<(usize, MeshLevels)> {
        let whole = self.whole;
        let mut most = 0.0_f32;
        let error = |error: &f32| {
            most = most.max(self.unit * (ERROR_MARGIN * error));
            most
        };
        let errors: Vec<f32> = errors.iter().map(error).collect();
        let became: Vec<Became<'_>> =
            self.levels.iter().map(|level| Became { indices: &level.indices, remap: &level.into }).collect();
        let place = |vertex: u32| (whole.member[vertex as usize], self.simplified.point(vertex));
        let partners = partners(&whole.indices, &became, place, whole.vertices());
        let of_mesh = |(member, mesh): (usize, &usize)| {
            let level = |(level, error): (&Found, &f32)| MeshLevel {
                indices: whole.own(&level.indices, member),
                error: *error,
            };
            let local = |vertex: u32| whole.local(vertex);
            let found = MeshLevels {
                levels: self.levels.iter().zip(&errors).map(level).collect(),
                partners: partners[whole.range(member)].iter().map(|vertex| local(*vertex)).collect(),
                near: self.sides.iter().map(|sides| sides.near.part(whole.range(member), local)).collect(),
            };
            (*mesh, found)
        };
        whole.meshes.iter().enumerate().map(of_mesh).collect()
    }
}

/// All moments to sample: the rest pose and the given moments.
fn looked_at(moments: &[Moment]) -> Vec<Moment> {
    std::iter::once(Moment::Rest).chain(moments.iter().copied()).collect()
}

/// Computes the levels of all meshes of a model as [`MeshLevels::new`] does, sets them in the model, and returns them.
///
/// Meshes whose borders coincide in every pose are simplified as one. Their borders stay closed at every level, and
/// they have the same number of levels with the same errors. At each remaining vertex where a mesh had triangles, the
/// mesh keeps at least one, because errors count the distance to the nearest triangle of the same mesh.
///
/// `clips` are the indices of the clips that will be played; none for a static mesh. `poses` is the number of poses
/// sampled per clip, at most 216,001. To miss no motion, use the largest result of [`poses_of`](super::poses_of); fewer poses are
/// quicker. Without clips, only the rest pose counts, and `poses` may be 1.
///
/// The computing time grows with vertices × clips × poses for vertices that follow several bones. For vertices with one
/// bone, it does not depend on the number of poses. A character or a rock of tens of thousands of triangles takes
/// seconds. To avoid this at every start, keep the result: serde can store a [`Model`] with its levels in any format.
/// For loading screens, use [`add_levels_with_progress`].
///
/// # Errors
/// [`InputError`] in the cases of [`MeshLevels::new`], and for a model that [`join_levels`](super::join_levels) made.
pub fn add_levels(model: &mut Model, clips: &[usize], poses: usize) -> Result<Vec<MeshLevels>, InputError> {
    let looks = Looks { clips, poses, is_at_rest: false };
    Ok(watched(model, looks, &mut unwatched)?.unwrap_or_default())
}

/// As [`add_levels`], but the rest pose counts in addition to the clips, so errors also hold at rest.
///
/// # Errors
/// The same errors as [`add_levels`].
pub fn add_levels_and_at_rest(
    model: &mut Model,
    clips: &[usize],
    poses: usize,
) -> Result<Vec<MeshLevels>, InputError> {
    let looks = Looks { clips, poses, is_at_rest: true };
    Ok(watched(model, looks, &mut unwatched)?.unwrap_or_default())
}

/// As [`add_levels`], but reports progress to `watch`: the completed fraction of the work, from 0 to 1, never decreasing.
///
/// `watch` is called on the calling thread, so it needs no lock. For a model that takes long, it is called many times a
/// second. If `watch` breaks, the model stays unchanged and the result is `None`.
///
/// ```
/// use std::ops::ControlFlow;
///
/// let mut rock = relievo_samples::rock()?;
/// let mut drawn = 0;
/// let found = relievo::ops::skinning::add_levels_with_progress(&mut rock, &[], 1, &mut |fraction| {
///     drawn = (100.0 * fraction) as u32; // the width of a bar
///     ControlFlow::Continue(())
/// })?;
/// assert_eq!((drawn, found.map(|levels| levels.len())), (100, Some(1)));
/// # Ok::<(), relievo::InputError>(())
/// ```
///
/// # Errors
/// The same errors as [`add_levels`].
pub fn add_levels_with_progress(
    model: &mut Model,
    clips: &[usize],
    poses: usize,
    watch: &mut dyn FnMut(f32) -> ControlFlow<()>,
) -> Result<Option<Vec<MeshLevels>>, InputError> {
    watched(model, Looks { clips, poses, is_at_rest: false }, watch)
}

/// As [`add_levels_with_progress`], but for all clips and the rest pose.
///
/// # Errors
/// The same errors as [`add_levels`].
pub(super) fn add_levels_of_all_clips(
    model: &mut Model,
    poses: usize,
    watch: &mut dyn FnMut(f32) -> ControlFlow<()>,
) -> Result<Option<Vec<MeshLevels>>, InputError> {
    let clips: Vec<usize> = (0..model.clips.len()).collect();
    watched(model, Looks { clips: &clips, poses, is_at_rest: true }, watch)
}

/// A progress callback that ignores the progress and never breaks.
fn unwatched<T>(_: T) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The clips and poses at which a model is sampled.
struct Looks<'a> {
    clips: &'a [usize],
    /// Number of poses per clip.
    poses: usize,
    /// Whether the rest pose counts in addition to clips.
    is_at_rest: bool,
}

fn watched(
    model: &mut Model,
    looks: Looks<'_>,
    watch: &mut dyn FnMut(f32) -> ControlFlow<()>,
) -> Result<Option<Vec<MeshLevels>>, InputError> {
    let Looks { clips, poses, is_at_rest } = looks;
    if let Some(at) = model.meshes.iter().position(Mesh::is_of_coarse_levels) {
        let bound = "must be at least 3: a model that was joined from levels is not simplified";
        return Err(InputError::new(format!("model.meshes[{at}].indices.len"), 0, bound));
    }
    let each = (0..model.meshes.len()).map(|mesh| moments(model, mesh, clips, poses));
    if watch(0.0).is_break() {
        return Ok(None);
    }
    let Some(mut moments) = each.collect::<Result<Vec<_>, _>>()?.into_iter().next() else {
        return Ok(watch(1.0).is_continue().then(Vec::new));
    };
    if is_at_rest && !clips.is_empty() {
        moments.push(Moment::Rest);
    }
    let (borders, groups) = shared(model, &key_moments(&moments));
    let meshes: Vec<usize> = (0..model.meshes.len()).collect();
    let bodies = Bodies::new(model, &meshes, &looked_at(&moments));
    let task = Task { model, moments: &moments, bodies: &bodies };
    let Some(mut all) = task.run(&groups, &borders, watch)? else { return Ok(None) };
    all.sort_by_key(|(mesh, _)| *mesh);
    let all: Vec<MeshLevels> = all.into_iter().map(|(_, found)| found).collect();
    for (mesh, found) in model.meshes.iter_mut().zip(&all) {
        mesh.levels.clone_from(&found.levels);
        mesh.partners.clone_from(&found.partners);
    }
    Ok(Some(all))
}

/// Simplifies the meshes. `bodies` has the rigid body of each vertex. `watch` gets the fraction of triangles removed so
/// far.
fn simplified(
    whole: &Whole<'_>,
    welded: &Welded,
    keys: &Keys,
    bodies: &[u32],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Simplified>, InputError> {
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
    let meshes: Vec<u32> = match whole.meshes.len() {
        1 => Vec::new(),
        _ => whole.indices.chunks_exact(3).map(|triangle| whole.member_of(triangle)).collect(),
    };
    let groups = Groups { bodies, meshes: &meshes };
    Ok(simplify_watched(&surface, &SimplifyOptions::default(), &distances, &groups, watch)?.continue_value())
}

/// A level of detail under construction.
struct Found {
    /// For each vertex, the vertex into which it has collapsed at this level.
    remap: Vec<u32>,
    /// For each vertex that the previous level uses, the vertex that replaces it at this level.
    into: Vec<u32>,
    indices: Vec<u32>,
}

/// The levels of detail, finest first. Each level uses a subset of the previous level's vertices.
fn found(whole: &Whole<'_>, welded: &Welded, keys: &Keys, simplified: &Simplified) -> Vec<Found> {
    let mut distances: Vec<f32> = simplified.collapses().iter().map(|collapse| collapse.distance).collect();
    distances.dedup();
    let mut last = whole.indices.len() / 3;
    let mut levels: Vec<Found> = Vec::new();
    for distance in distances {
        let remap = welded.remap(simplified, simplified.collapses_near(distance));
        let before = levels.last().map_or(&whole.indices, |level| &level.indices);
        let (indices, into, triangles) = welded.next(whole, keys, simplified, &remap, before);
        if triangles > 0 && triangles as f64 <= WORTHWHILE * last as f64 {
            last = triangles;
            levels.push(Found { remap, into, indices });
        }
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::{Influence, Influences};
    use crate::skinning::pose::Pose;

    /// If the simplifier saw all moments, the measured errors equal its own distances. No nearby triangle is overlooked.
    #[test]
    fn errors_are_the_distances_that_were_kept() {
        let plain = crate::samples::creature().expect("valid");
        for scale in [1e-6, 1.0, 1e8, 1e15] {
            let mut model = plain.clone();
            let mesh = &mut model.meshes[0];
            mesh.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
            // All vertices follow one bone; otherwise the bones would also have to be scaled.
            let follows = (0..mesh.vertices()).map(|_| vec![Influence { bone: 0, weight: 1.0 }]);
            mesh.influences = Influences::new("w", model.skins[0].bones.len(), follows).expect("valid");
            let whole = Whole::new(&model, &[0], &Shared::new());
            let keys = Keys::new(&whole, &[Moment::In(0, 0.0)]);
            let welded = Welded::new(&whole, &keys.poses);
            let simplified = simplified(&whole, &welded, &keys, &[], &mut unwatched);
            let simplified = simplified.expect("valid").expect("not broken");
            let mut distances: Vec<f32> = simplified.collapses().iter().map(|one| one.distance).collect();
            distances.dedup();
            let levels = super::found(&whole, &welded, &keys, &simplified);
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

    /// With an error of a hundredth of the height, a ninth of the triangles remain. Every level also keeps its error at
    /// moments that were not sampled.
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

    /// In this mesh, every triangle has its own vertices with the face normal. The triangles of the levels also have
    /// face normals.
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
        // Averaged normals change the order of collapses, so one level more or less is accepted.
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
