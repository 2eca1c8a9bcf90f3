//! Clips: animations of a skeleton's bones. Each bone has up to three tracks (translation, rotation and scale), and each track
//! has its own key times. Interpolation between keys follows glTF 2.0, appendix C.
//!
//! # Layout
//!
//! A clip consists of three flat arrays:
//!
//! - `tracks`: three [`Track`]s per bone, in the order translation, rotation, scale.
//! - `times`: `f32` seconds, ascending within a track. Tracks with equal key times share one list.
//! - `values`: `vec4<f32>`s. A value is a translation or a scale followed by 0, or a quaternion x, y, z, w. Cubic splines have
//!   three values per key: in-tangent, value, out-tangent. A tangent is stored multiplied by the duration of its segment in
//!   seconds. The segment of an in-tangent ends at the key; the segment of an out-tangent starts at the key.
//!
//! The value of a key thus takes 16 bytes (48 in a cubic spline). The key's time takes 4 more bytes, unless another track
//! shares the time. A bone without keys has three tracks with 0 keys and one value each: the bone's rest pose.
//!
//! # Decisions where glTF leaves room
//!
//! - Successive keys with equal times make the value jump: from that time on, the last of these keys applies. Descending times
//!   are refused.
//! - Quaternions are stored with length 1. A quaternion shorter than 1e-6 is refused.
//! - A key of a linear rotation is stored with the sign that brings it closer to the previous key. Sampling then takes the
//!   shortest path between neighbouring keys, without tests of signs. Cubic splines keep all signs, because the signs of a
//!   value and its tangents must match.
//! - Times below 2⁻¹⁰⁰ s count as 0, because devices may flush the tiny differences between such times to zero.

mod keys;
mod layout;
mod replaced;
mod stored;

use serde::{Deserialize, Serialize};

use super::skeleton::Skeleton;
use crate::InputError;

pub(crate) use keys::check_times;
pub use keys::{Interpolation, Keys, LONGEST};
use layout::Layout;

/// The animation keys of one bone. A component that is `None` keeps its value in the rest pose.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BoneKeys {
    /// Keys of the translation in metres, in the parent's space.
    pub translation: Option<Keys>,
    /// Keys of the rotation: quaternions (x, y, z, w) of any non-zero length.
    pub rotation: Option<Keys>,
    /// Keys of the scale factors along the bone's axes.
    pub scale: Option<Keys>,
}

/// The component of a bone's transform that a track animates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TransformPart {
    /// Translation: the first track of a bone.
    Translation = 0,
    /// Rotation: the second track of a bone.
    Rotation = 1,
    /// Scale: the third track of a bone.
    Scale = 2,
}

impl TransformPart {
    /// All three components, in the order of a bone's tracks.
    pub const ALL: [Self; 3] = [Self::Translation, Self::Rotation, Self::Scale];
}

/// Location of a track's keys in the clip's arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Track {
    /// Index of the first key's time in [`Clip::times`].
    pub first_time: u32,
    /// Index of the first key's value in [`Clip::values`].
    pub first_value: u32,
    /// Number of keys. 0 means that the track holds a single value, the rest pose.
    pub keys: u32,
    /// Interpolation of values between keys.
    pub interpolation: Interpolation,
}

/// An animation of one skeleton, stored in flat arrays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "stored::StoredClip")]
pub struct Clip {
    name: String,
    duration: f32,
    tracks: Vec<Track>,
    times: Vec<f32>,
    values: Vec<[f32; 4]>,
}

impl Clip {
    /// Builds a clip of `skeleton` from one [`BoneKeys`] per bone. The clip lasts until its last key, or `duration` seconds if
    /// that is longer.
    ///
    /// # Errors
    /// [`InputError`] for a duration outside 0..=[`LONGEST`] seconds, and for a list that does not have one entry per bone. For
    /// wrong keys, the error names the field and the bone's index. Keys are wrong if a track has none, if times descend or
    /// leave 0..=[`LONGEST`], if the number of values does not match the times, if a value is not finite, or if a rotation has
    /// no direction.
    pub fn new(
        name: impl Into<String>,
        skeleton: &Skeleton,
        bones: &[BoneKeys],
        duration: f32,
    ) -> Result<Self, InputError> {
        InputError::check_len("clip.bones", bones.len(), skeleton.len(), "a bone")?;
        let bound = || format!("must be in 0..={LONGEST} seconds");
        InputError::check((0.0..=LONGEST).contains(&duration), "clip.duration", duration, bound)?;
        let mut layout = Layout::default();
        for (index, (bone, keys)) in skeleton.bones().iter().zip(bones).enumerate() {
            let [translation, scale] =
                [bone.rest.translation, bone.rest.scale].map(|[x, y, z]| [x, y, z, 0.0]);
            for (part, keys, rest) in [
                ("translation", &keys.translation, translation),
                ("rotation", &keys.rotation, bone.rest.rotation),
                ("scale", &keys.scale, scale),
            ] {
                let path = format!("clip.bones[{index}].{part}");
                let paths = [format!("{path}.times"), format!("{path}.values")];
                let is_rotation = part == "rotation";
                let keys = keys.as_ref().map(|keys| {
                    keys.validate([&paths[0], &paths[1]], is_rotation)?;
                    keys.stored(&paths[1], is_rotation)
                });
                layout.add(keys.transpose()?, rest);
            }
        }
        layout.finish(name.into(), duration)
    }

    /// Builds a clip of 0 seconds without keys: every bone stays at rest. Use it for models without clips.
    ///
    /// # Errors
    /// [`InputError`] for a skeleton with so many bones that their values exceed one buffer.
    pub fn at_rest(name: impl Into<String>, skeleton: &Skeleton) -> Result<Self, InputError> {
        Self::new(name, skeleton, &vec![BoneKeys::default(); skeleton.len()], 0.0)
    }

    /// The clip's name in the file; names need not be unique.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Duration in seconds, at least the time of the last key.
    pub fn duration(&self) -> f32 {
        self.duration
    }

    /// Number of bones, including those that stay at rest.
    pub fn bones(&self) -> usize {
        self.tracks.len() / 3
    }

    /// The tracks of all bones: three per bone, in the order translation, rotation, scale.
    pub fn tracks(&self) -> &[Track] {
        &self.tracks
    }

    /// The key times of all tracks, in seconds. [`Track::first_time`] is an index into them.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// The values of all tracks, as vectors of four components. [`Track::first_value`] is an index into them.
    pub fn values(&self) -> &[[f32; 4]] {
        &self.values
    }

    /// The track of one bone that animates `part`.
    pub fn track(&self, bone: usize, part: TransformPart) -> &Track {
        &self.tracks[3 * bone + part as usize]
    }

    /// The key times of one track, in seconds; empty for a track at rest.
    pub fn times_of(&self, track: &Track) -> &[f32] {
        &self.times[track.first_time as usize..][..track.keys as usize]
    }

    /// The value of one key of a track, without the tangents of a cubic spline.
    pub fn key(&self, track: &Track, key: usize) -> [f32; 4] {
        let at = if track.interpolation == Interpolation::CubicSpline { 3 * key + 1 } else { key };
        self.values[track.first_value as usize + at]
    }

    /// Size of tracks, times and values together, in bytes.
    #[doc(hidden)]
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.tracks) + size_of_val(&*self.times) + size_of_val(&*self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::skeleton::Bone;
    use crate::asset::transform::Transform;

    fn skeleton() -> Skeleton {
        let rest = Transform { translation: [1.0, 2.0, 3.0], scale: [4.0, 5.0, 6.0], ..Transform::IDENTITY };
        let bone = |parent| Bone { name: String::new(), parent, rest };
        Skeleton::of_joints(vec![bone(None), bone(Some(0))]).expect("valid")
    }

    fn keys(times: &[f32], values: &[[f32; 4]], interpolation: Interpolation) -> Option<Keys> {
        Some(Keys { times: times.to_vec(), values: values.to_vec(), interpolation })
    }

    #[test]
    fn the_layout_is_the_documented_one() {
        let translation = keys(&[0.0, 0.5], &[[1.0; 4], [2.0; 4]], Interpolation::Step);
        let half = [0.0, 0.0, 0.0, -2.0];
        let rotation = keys(&[0.0, 0.5], &[[0.0, 0.0, 0.0, 3.0], half], Interpolation::Linear);
        let scale = keys(&[0.25], &[[0.0; 4], [7.0; 4], [0.0; 4]], Interpolation::CubicSpline);
        let bones = [BoneKeys { translation, rotation, scale }, BoneKeys::default()];
        let clip = Clip::new("a", &skeleton(), &bones, 0.0).expect("valid");
        assert_eq!((clip.name(), clip.duration(), clip.bones()), ("a", 0.5, 2));
        // Translation and rotation share their times.
        assert_eq!(clip.times(), [0.0, 0.5, 0.25]);
        let track = |first_time, first_value, keys, interpolation| Track {
            first_time,
            first_value,
            keys,
            interpolation,
        };
        let [step, linear, spline] = [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline];
        let expected = [track(0, 0, 2, step), track(0, 2, 2, linear), track(2, 4, 1, spline)];
        assert_eq!(clip.tracks()[..3], expected);
        assert_eq!(clip.tracks()[3].keys, 0);
        let identity = [0.0, 0.0, 0.0, 1.0];
        assert_eq!(clip.values()[2..4], [identity; 2], "unit, and the short way");
        assert_eq!(clip.values()[7..], [[1.0, 2.0, 3.0, 0.0], identity, [4.0, 5.0, 6.0, 0.0]]);
        assert_eq!(clip.key(clip.track(0, TransformPart::Scale), 0), [7.0; 4]);
        assert_eq!(Clip::new("a", &skeleton(), &bones, 2.0).expect("valid").duration(), 2.0);
    }

    #[test]
    fn what_is_no_clip_is_refused_by_field() {
        let refused = |translation, rotation| {
            let bones = [BoneKeys::default(), BoneKeys { translation, rotation, scale: None }];
            let error = Clip::new("a", &skeleton(), &bones, 0.0).expect_err("refused");
            (error.path, error.value)
        };
        let linear = Interpolation::Linear;
        for (times, values, field, value) in [
            (&[][..], &[][..], "times.len", "0"),
            (&[0.0, -1.0], &[[0.0; 4]; 2], "times[1]", "-1"),
            (&[f32::NAN], &[[0.0; 4]], "times[0]", "NaN"),
            (&[2e6], &[[0.0; 4]], "times[0]", "2000000"),
            (&[0.0, 2.0, 2.0, 1.0], &[[0.0; 4]; 4], "times[3]", "1"),
            (&[0.0], &[[0.0; 4]; 2], "values.len", "2"),
            (&[0.0], &[[0.0, f32::INFINITY, 0.0, 0.0]], "values[0][1]", "inf"),
        ] {
            let (found, what) = refused(keys(times, values, linear), None);
            assert_eq!(
                (found.as_str(), what.as_str()),
                (&*format!("clip.bones[1].translation.{field}"), value)
            );
        }
        assert_eq!(refused(None, keys(&[0.0], &[[0.0; 4]], linear)).0, "clip.bones[1].rotation.values[0]");
        let spline = keys(&[0.0], &[[0.0; 4]; 3], Interpolation::CubicSpline);
        assert_eq!(refused(None, spline).0, "clip.bones[1].rotation.values[1]");
        let few = Clip::new("a", &skeleton(), &[], 0.0).expect_err("refused");
        assert_eq!(few.path, "clip.bones.len");
        let long = Clip::new("a", &skeleton(), &[BoneKeys::default(), BoneKeys::default()], f32::NAN);
        assert_eq!(long.expect_err("refused").path, "clip.duration");
    }
}
