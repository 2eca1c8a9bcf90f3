//! Which model bounds of motion belong to.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use crate::asset::{Bone, Model, MotionBounds, Track};

impl MotionBounds {
    /// Bounds of a model: a sphere for each clip, and [`MotionBounds::stray`].
    #[doc(hidden)]
    pub fn new(model: &Model, spheres: Vec<[f32; 4]>, stray: f32) -> Self {
        Self { spheres, stray, of: fingerprint(model) }
    }

    /// Whether the bounds are valid, and were computed from a model with this motion.
    #[doc(hidden)]
    pub fn fit(&self, model: &Model) -> bool {
        self.check(model.clips.len()).is_ok() && self.of == fingerprint(model)
    }

    /// The same bounds for another model that moves in the same way.
    #[doc(hidden)]
    pub fn with_model(self, model: &Model) -> Self {
        Self { of: fingerprint(model), ..self }
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
