//! Bounds of a model's motion that were computed in advance.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use serde::{Deserialize, Serialize};

use crate::InputError;
use crate::asset::{Bone, Model, Track};

/// Bounds of a model's motion in its clips, in the model's units. A package has them, so that a scene need not sample the clips.
///
/// The bounds hold for the skeleton, skins, clips and vertices from which they were computed. If any of these has changed since
/// then, the bounds are not used, and a scene samples the clips.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionBounds {
    /// A sphere around all vertices for each clip: x, y and z of its center, and its radius.
    pub(crate) spheres: Vec<[f32; 4]>,
    /// Largest displacement of a vertex in any clip per unit of influence fade
    /// ([`Extent::stray`](crate::skinning::extent::Extent::stray)).
    pub(crate) stray: f32,
    /// [`fingerprint`] of the model.
    of: u64,
}

impl MotionBounds {
    pub(crate) fn new(model: &Model, spheres: Vec<[f32; 4]>, stray: f32) -> Self {
        Self { spheres, stray, of: fingerprint(model) }
    }

    /// Whether the bounds are valid, and were computed from a model with this motion.
    pub(crate) fn fit(&self, model: &Model) -> bool {
        self.check(model.clips.len()).is_ok() && self.of == fingerprint(model)
    }

    /// The same bounds for another model that moves in the same way.
    pub(crate) fn with_model(self, model: &Model) -> Self {
        Self { of: fingerprint(model), ..self }
    }

    /// The same bounds without a model.
    pub(super) fn unbound(self) -> Self {
        Self { of: 0, ..self }
    }

    /// Checks that there is a sphere for each of `clips` clips, and that all numbers are finite, radii and displacement at least
    /// 0.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub(crate) fn check(&self, clips: usize) -> Result<(), InputError> {
        InputError::check_len("motion.spheres", self.spheres.len(), clips, "a clip")?;
        for (at, sphere) in self.spheres.iter().enumerate() {
            if !sphere.iter().all(|value| value.is_finite()) || sphere[3] < 0.0 {
                let bound = "must be finite, with a radius of at least 0";
                return Err(InputError::new(format!("motion.spheres[{at}]"), format!("{sphere:?}"), bound));
            }
        }
        let bound = || "must be finite, and at least 0".to_owned();
        InputError::check((0.0..f32::INFINITY).contains(&self.stray), "motion.stray", self.stray, bound)
    }
}

/// A hash of all that moves a model's vertices. It notices changes, but no forgery.
fn fingerprint(model: &Model) -> u64 {
    let mut words: Vec<u32> = Vec::new();
    for Bone { parent, rest, .. } in model.skeleton.bones() {
        words.push(parent.unwrap_or(u32::MAX));
        words.extend(bits(&rest.translation).chain(bits(&rest.rotation)).chain(bits(&rest.scale)));
    }
    for skin in &model.skins {
        words.extend(skin.bones.iter().copied().chain(bits(skin.inverse_binds.as_flattened())));
    }
    for clip in &model.clips {
        let track =
            |track: &Track| [track.first_time, track.first_value, track.keys, track.interpolation as u32];
        words.extend(clip.tracks().iter().flat_map(track).chain([clip.duration().to_bits()]));
        words.extend(bits(clip.times()).chain(bits(clip.values().as_flattened())));
    }
    for mesh in &model.meshes {
        words.extend([mesh.skin, mesh.vertices(), mesh.targets.len()].map(|count| count as u32));
        words.extend(bits(mesh.positions.as_flattened()).chain(bits(&mesh.weights)));
        words.extend((0..mesh.influences.vertices()).map(|vertex| mesh.influences.of(vertex).len() as u32));
        words.extend(mesh.influences.all().iter().flat_map(|one| [one.bone, one.weight.to_bits()]));
        for target in &mesh.targets {
            words.extend(&target.vertices);
            words.extend(target.deltas.iter().flat_map(|delta| delta.position.map(f32::to_bits)));
        }
        for (clip, keys) in &mesh.weight_keys {
            let (times, values, interpolation) = keys.parts();
            words.extend([*clip as u32, interpolation as u32]);
            words.extend(bits(times).chain(bits(values)));
        }
    }
    let mut hash = DefaultHasher::new();
    words.hash(&mut hash);
    hash.finish()
}

fn bits(values: &[f32]) -> impl Iterator<Item = u32> {
    values.iter().map(|value| value.to_bits())
}
