//! Packages of models: quantization, levels of detail for every clip and the rest pose, and their errors.

use std::ops::ControlFlow;

use super::level_errors;
use super::levels::add_levels_of_all_clips;
use super::motion_bounds::motion_bounds;
use super::pose::{Moment, Pose, moments_in};
use super::poses_of;
use crate::InputError;
use crate::asset::package::{Packed, snapped, welded, write};
use crate::asset::{Clip, Model, ModelFile};

/// Levels of detail are computed from a quarter of the poses that [`poses_of`] counts: 15 poses a second, but at least
/// `LEAST_POSES` and at most `MOST_POSES`.
const SPARSER: usize = 4;
const LEAST_POSES: usize = 9;
const MOST_POSES: usize = 48;

/// Safety factor of the quantization's error over the sampled maximum, for poses between the samples.
const MARGIN: f32 = super::levels::ERROR_MARGIN;

/// Number of poses of a clip from which levels of detail are computed while a program waits. Fewer poses let a scene load in
/// seconds. `relievo scene --compare` measures the effect.
///
/// # Errors
/// [`InputError`] for a clip of more than an hour.
pub fn sparse_poses_of(clip: &Clip) -> Result<usize, InputError> {
    Ok((poses_of(clip)? / SPARSER).clamp(LEAST_POSES, MOST_POSES))
}

/// Makes a package (`.rlv`, [`package`](crate::asset::package)) of a model. Images that the file does not have are written as
/// PNG. `watch` gets the completed fraction of the work, from 0 to 1, never decreasing. If it breaks, the result is `None`.
///
/// Attributes are quantized: positions to 2⁻¹⁵ to 2⁻¹⁶ of the extent of all meshes with the same skin, normals to 0.2°,
/// tangents to 1.2°, texture coordinates to 2⁻¹⁴, weights to 2⁻¹⁴. Then equal vertices are merged, and levels of detail are
/// computed for all clips and the rest pose. The largest distance by which quantization moves a vertex, in the same poses, is
/// added to the errors of all levels.
///
/// A package, and any other model that has levels of detail, is neither quantized nor simplified again. The new package states
/// the quantization of the file.
///
/// # Errors
/// [`InputError`] for a model whose parts do not match each other, and for a clip of more than an hour.
pub fn cook(
    file: &ModelFile,
    watch: &mut dyn FnMut(f32) -> ControlFlow<()>,
) -> Result<Option<Vec<u8>>, InputError> {
    let ModelFile { model, images, quantization } = file;
    model.check().map_err(|error| error.below("model"))?;
    let quantization = model.meshes.iter().map(|mesh| mesh.error).fold(*quantization, f32::max);
    let is_done = quantization > 0.0 || model.meshes.iter().any(|mesh| !mesh.levels.is_empty());
    let (mut model, quantization) = match is_done {
        true => (model.clone(), quantization),
        false => {
            let poses = model.clips.iter().map(sparse_poses_of).collect::<Result<Vec<_>, _>>()?;
            let poses = poses.into_iter().max().unwrap_or(1);
            let snapped = snapped(model)?;
            let quantization = MARGIN * displacement([model, &snapped], poses);
            let mut own = welded(&snapped)?;
            if add_levels_of_all_clips(&mut own, poses, watch)?.is_none() {
                return Ok(None);
            }
            let levels = own.meshes.iter_mut().flat_map(|mesh| &mut mesh.levels);
            levels.for_each(|level| level.error += quantization);
            (own, quantization)
        }
    };
    if !model.clips.is_empty() {
        model.motion = Some(motion_bounds(&model)?);
    }
    let errors = level_errors(&model.meshes);
    write(&Packed { model: &model, errors: &errors, quantization, images }).map(Some)
}

/// The largest distance between the same vertices of two models, at rest and in `poses` poses of each clip.
fn displacement(models: [&Model; 2], poses: usize) -> f32 {
    let clips = 0..models[0].clips.len();
    let moments = clips.flat_map(|clip| moments_in(clip, poses)).chain([Moment::Rest]);
    let mut largest = 0.0_f32;
    for moment in moments {
        for mesh in 0..models[0].meshes.len() {
            let [from, to] = models.map(|model| {
                let mesh = &model.meshes[mesh];
                Pose::new(model, mesh, moment).positions(mesh)
            });
            largest = from.iter().zip(&to).map(|(from, to)| from.distance(*to)).fold(largest, f32::max);
        }
    }
    largest
}
