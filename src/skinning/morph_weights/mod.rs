//! Keyframes of a mesh's morph weights in a set of clips, in the layout of the kernel that evaluates them for each
//! instance.

use crate::InputError;
use crate::animation::clip_set::ClipSet;
use crate::asset::Interpolation;
use crate::asset::Mesh;
#[cfg(feature = "gpu")]
use crate::shared::skinning::morph_weights as packed;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{MorphWeightsJob, MorphWeightsPass};

/// Bound on the difference between CPU and GPU for one morph weight, on any device: 1.3e-4. It holds for values and
/// tangents (per second) of at most 1, keys 1/8 to 1 s apart, and times up to 16 s.
///
/// Derivation, with ε = 2⁻²⁴: a time of 16 s has a relative error of 3ε, which is 2.3e-5 of a segment of 1/8 s. The
/// slope of a spline in a segment is at most 5: up to 3 from the values at both ends, and up to 2 from their tangents.
/// The error of the time therefore changes a weight by at most 1.2e-4. The arithmetic of the spline adds about 40ε.
pub const MORPH_WEIGHTS_BOUND: f32 = 1.3e-4;

/// The location of one clip's keyframes in a [`WeightSet`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightEntry {
    /// The clip's duration in seconds.
    pub duration: f32,
    /// Index of the clip's first key time in [`WeightSet::times`].
    pub first_time: u32,
    /// Number of keys, at least 1.
    pub keys: u32,
    /// Index of the clip's first value in [`WeightSet::values`].
    pub first_value: u32,
    /// Interpolation of the weights between keyframes.
    pub interpolation: Interpolation,
}

#[cfg(feature = "gpu")]
impl WeightEntry {
    /// The entry in the layout of kernels.
    fn packed(&self) -> packed::WeightEntry {
        let Self { duration, first_time, keys, first_value, interpolation } = *self;
        let interpolation = interpolation as u32;
        packed::WeightEntry { duration, first_time, keys, first_value, interpolation }
    }
}

/// The keyframes of a mesh's morph weights in several clips.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightSet {
    /// The keyframes of each clip of the set.
    pub entries: Vec<WeightEntry>,
    /// Key times of all clips, in seconds.
    pub times: Vec<f32>,
    /// Values of all keyframes, one keyframe after the other: one value per morph target, or three for cubic splines.
    pub values: Vec<f32>,
    /// Number of morph targets.
    pub targets: usize,
}

impl WeightSet {
    /// Collects the morph weights of a mesh in a set of clips. `clips` gives the model's clip index for each clip of
    /// the set. A clip that does not animate the weights gets one keyframe with [`Mesh::weights`].
    ///
    /// # Errors
    /// [`InputError`] if `clips` and the set differ in length.
    pub fn new(mesh: &Mesh, set: &ClipSet, clips: &[usize]) -> Result<Self, InputError> {
        InputError::check_len("clips", clips.len(), set.clips().len(), "a clip of the set")?;
        let targets = mesh.targets.len();
        let mut all = Self { entries: Vec::new(), times: Vec::new(), values: Vec::new(), targets };
        for (of_set, clip) in set.clips().iter().zip(clips) {
            let keys = mesh.weight_keys.iter().find(|(of, _)| of == clip).map(|(_, keys)| keys);
            let rest = (&[0.0][..], &mesh.weights[..], Interpolation::Step);
            let (times, values, interpolation) = keys.map_or(rest, |keys| keys.parts());
            all.entries.push(WeightEntry {
                duration: of_set.duration,
                first_time: all.times.len() as u32,
                keys: times.len() as u32,
                first_value: all.values.len() as u32,
                interpolation,
            });
            all.times.extend(times);
            all.values.extend(values);
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::MorphTarget;
    use crate::asset::morph::WeightKeys;

    #[test]
    fn sets_have_keys_for_every_clip() {
        let mut model = crate::samples::creature().expect("valid");
        let mesh = &mut model.meshes[0];
        mesh.targets = vec![MorphTarget::default(); 2];
        mesh.weights = vec![0.25, 0.5];
        let keys = WeightKeys::new(["t", "v"], vec![0.0, 1.0], vec![1.0; 12], Interpolation::CubicSpline, 2);
        mesh.weight_keys = vec![(2, keys.expect("valid"))];
        let set = ClipSet::new(&[&model.clips[0], &model.clips[2]]).expect("one skeleton");
        let weights = WeightSet::new(&model.meshes[0], &set, &[0, 2]).expect("fits");
        let keys = |entry: &WeightEntry| {
            (entry.first_time, entry.keys, entry.first_value, entry.interpolation, entry.duration)
        };
        let [walk, wave] = [0, 2].map(|clip: usize| model.clips[clip].duration());
        let found: Vec<_> = weights.entries.iter().map(keys).collect();
        assert_eq!(
            found,
            [(0, 1, 0, Interpolation::Step, walk), (1, 2, 2, Interpolation::CubicSpline, wave)]
        );
        assert_eq!((&weights.times[..], weights.values.len()), (&[0.0, 0.0, 1.0][..], 14));
        let refused = WeightSet::new(&model.meshes[0], &set, &[0]).expect_err("refused");
        assert_eq!((&*refused.path, &*refused.bound), ("clips.len", "must be 2, one a clip of the set"));
    }
}
