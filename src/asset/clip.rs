//! Clips: what moves bones. Each bone has up to three tracks, translation, rotation and scale, each with key times
//! of its own; interpolation between keys is glTF's (2.0, appendix C).
//!
//! # Layout
//!
//! A clip is three flat arrays, fit for storage buffers as they are:
//!
//! - `tracks`: three [`Track`]s a bone, translation, rotation, scale; 16 bytes each.
//! - `times`: `f32` seconds, ascending within a track. Tracks with equal times share them.
//! - `values`: `vec4<f32>`s: a translation or scale with 0 behind it, or a quaternion x, y, z, w. Cubic splines
//!   have three a key: in-tangent, value, out-tangent, the tangents times the seconds of the stretch that they bend.
//!
//! So a key takes 16 bytes, 48 in a cubic spline, and 4 more where its time is not shared. A bone without keys has
//! a track of 0 keys whose one value is the bone's rest pose.
//!
//! # What is decided where glTF is silent
//!
//! - Times that repeat are a jump: the last key of that time counts from then on. Times that descend are refused.
//! - Quaternions are stored with length 1; one shorter than [`SHORTEST`](super::transform::SHORTEST) is refused.
//!   Keys of linear rotation have the sign that is nearer to the key before, so that the path between neighbours is
//!   the short one without looking. The tangents of cubic splines fit their values' signs: both stay as they are.
//! - Times below 2⁻¹⁰⁰ s count as 0: devices may flush smaller differences to zero.

mod replaced;

use super::skeleton::Skeleton;
use super::transform::{finite, unit};
use crate::InputError;

/// The largest key time in seconds: some 12 days.
pub const LONGEST: f32 = 1_048_576.0;

/// Smaller times are 0.
const LEAST_TIME: f32 = 7.888_609e-31;

/// How values between keys are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Interpolation {
    /// The key before.
    Step = 0,
    /// On the straight line; rotations on the shortest arc.
    Linear = 1,
    /// A Hermite spline with tangents at each key, in units a second; rotations are normalized after it.
    CubicSpline = 2,
}

impl Interpolation {
    /// What a track's number stands for.
    pub fn of_code(code: u32) -> Self {
        match code {
            0 => Self::Step,
            1 => Self::Linear,
            _ => Self::CubicSpline,
        }
    }
}

/// The keys of one track, before they are laid out.
#[derive(Debug, Clone, PartialEq)]
pub struct Keys {
    /// Seconds, not descending.
    pub times: Vec<f32>,
    /// One a key; in cubic splines three: in-tangent, value, out-tangent. Translations and scales have 0 last.
    pub values: Vec<[f32; 4]>,
    /// How values between keys are found.
    pub interpolation: Interpolation,
}

impl Keys {
    /// Checks times and values of translations, scales or, if `is_rotation`, quaternions; `paths` come before the
    /// fields of times and values.
    ///
    /// # Errors
    /// [`InputError`] for no keys, times that descend, are negative, too large or not finite, other than one value a
    /// key (three in splines), and values that are not finite or rotations without a direction.
    pub(crate) fn validate(&self, [times, values]: [&str; 2], is_rotation: bool) -> Result<(), InputError> {
        check_times(times, &self.times)?;
        let each = self.values_a_key();
        if self.values.len() != each * self.times.len() {
            let bound = format!("must be {}, {each} a key", each * self.times.len());
            return Err(InputError::new(format!("{values}.len"), self.values.len(), bound));
        }
        for (at, value) in self.values.iter().enumerate() {
            let path = format!("{values}[{at}]");
            finite(&path, value)?;
            if is_rotation && (each == 1 || at % 3 == 1) {
                unit(&path, *value)?;
            }
        }
        Ok(())
    }

    fn values_a_key(&self) -> usize {
        if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }

    /// Valid keys as they are stored.
    ///
    /// # Errors
    /// [`InputError`] for tangents that leave `f32` when they are multiplied by their seconds.
    pub(crate) fn stored(&self, path: &str, is_rotation: bool) -> Result<Self, InputError> {
        let mut keys = self.clone();
        keys.times.iter_mut().filter(|time| **time < LEAST_TIME).for_each(|time| *time = 0.0);
        match self.interpolation {
            Interpolation::CubicSpline => {
                stretch_tangents(&keys.times, &mut keys.values);
                finite(path, keys.values.as_flattened())?;
            }
            _ if is_rotation => {
                for value in &mut keys.values {
                    *value = unit(path, *value)?;
                }
                if self.interpolation == Interpolation::Linear {
                    take_short_ways(&mut keys.values);
                }
            }
            _ => {}
        }
        Ok(keys)
    }
}

/// Refuses no times, and such as descend or are out of range.
pub(crate) fn check_times(path: &str, times: &[f32]) -> Result<(), InputError> {
    if times.is_empty() {
        return Err(InputError::new(format!("{path}.len"), 0, "must be at least 1"));
    }
    if u32::try_from(times.len()).is_err() {
        return Err(InputError::new(
            format!("{path}.len"),
            times.len(),
            format!("must be at most {}", u32::MAX),
        ));
    }
    if let Some(at) = times.iter().position(|time| !(0.0..=LONGEST).contains(time)) {
        let bound = format!("must be in 0..={LONGEST} seconds");
        return Err(InputError::new(format!("{path}[{at}]"), times[at], bound));
    }
    match times.windows(2).position(|pair| pair[0] > pair[1]) {
        None => Ok(()),
        Some(at) => {
            let bound = format!("must not be below the time before it, {}", times[at]);
            Err(InputError::new(format!("{path}[{}]", at + 1), times[at + 1], bound))
        }
    }
}

/// Gives each quaternion the sign that is nearer to the one before.
fn take_short_ways(values: &mut [[f32; 4]]) {
    for at in 1..values.len() {
        let (before, here) = (values[at - 1], values[at]);
        let dot: f64 = before.iter().zip(here).map(|(a, b)| f64::from(*a) * f64::from(b)).sum();
        if dot < 0.0 {
            values[at] = here.map(|component| -component);
        }
    }
}

/// Multiplies tangents by the seconds between their key and the one on their side: what a spline needs of them.
fn stretch_tangents(times: &[f32], values: &mut [[f32; 4]]) {
    for (key, pair) in times.windows(2).enumerate() {
        for at in [3 * key + 2, 3 * key + 3] {
            values[at] = values[at].map(|tangent| tangent * (pair[1] - pair[0]));
        }
    }
}

/// What moves one bone. Without keys it keeps its rest pose.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BoneKeys {
    /// Metres, in the parent's space.
    pub translation: Option<Keys>,
    /// Quaternions (x, y, z, w), of any length but 0.
    pub rotation: Option<Keys>,
    /// Factors along the bone's axes.
    pub scale: Option<Keys>,
}

/// Which part of a transform a track moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// The first of a bone's tracks.
    Translation = 0,
    /// The second.
    Rotation = 1,
    /// The third.
    Scale = 2,
}

impl Part {
    /// In the order of a bone's tracks.
    pub const ALL: [Self; 3] = [Self::Translation, Self::Rotation, Self::Scale];
}

/// Where a track's keys lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Track {
    /// Its first key's time, in `times`.
    pub first_time: u32,
    /// Its first value, in `values`.
    pub first_value: u32,
    /// How many keys. 0: the one value is the rest pose.
    pub keys: u32,
    /// 0 step, 1 linear, 2 cubic spline: see [`Track::interpolation`].
    pub code: u32,
}

impl Track {
    /// How values between keys are found.
    pub fn interpolation(&self) -> Interpolation {
        Interpolation::of_code(self.code)
    }
}

/// A clip of one skeleton, laid out flat.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    name: String,
    duration: f32,
    tracks: Vec<Track>,
    times: Vec<f32>,
    values: Vec<[f32; 4]>,
}

impl Clip {
    /// A clip of `skeleton`, one [`BoneKeys`] a bone. It lasts as long as its last key, or `duration` if that is
    /// longer.
    ///
    /// # Errors
    /// [`InputError`] that names the bone's field, with its index: other than one a bone, no keys in a track, times
    /// that descend or leave 0..=[`LONGEST`], values that do not fit the times or are not finite, rotations without
    /// a direction.
    pub fn new(
        name: impl Into<String>,
        skeleton: &Skeleton,
        bones: &[BoneKeys],
        duration: f32,
    ) -> Result<Self, InputError> {
        if bones.len() != skeleton.len() {
            let bound = format!("must be {}, one a bone", skeleton.len());
            return Err(InputError::new("clip.bones.len", bones.len(), bound));
        }
        if !(0.0..=LONGEST).contains(&duration) {
            let bound = format!("must be in 0..={LONGEST} seconds");
            return Err(InputError::new("clip.duration", duration, bound));
        }
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

    /// A clip without keys, 0 seconds long: every bone stays at rest. For models that have no clip.
    ///
    /// # Errors
    /// [`InputError`] for a skeleton of so many bones that values do not fit a buffer.
    pub fn at_rest(name: impl Into<String>, skeleton: &Skeleton) -> Result<Self, InputError> {
        Self::new(name, skeleton, &vec![BoneKeys::default(); skeleton.len()], 0.0)
    }

    /// As the file has it; names need not differ.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Seconds; 0 where all keys lie at time 0.
    pub fn duration(&self) -> f32 {
        self.duration
    }

    /// How many bones it moves, or leaves at rest.
    pub fn bones(&self) -> usize {
        self.tracks.len() / 3
    }

    /// Three a bone: translation, rotation, scale.
    pub fn tracks(&self) -> &[Track] {
        &self.tracks
    }

    /// The key times of all tracks, in seconds.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// The values of all tracks.
    pub fn values(&self) -> &[[f32; 4]] {
        &self.values
    }

    /// One track of a bone.
    pub fn track(&self, bone: usize, part: Part) -> &Track {
        &self.tracks[3 * bone + part as usize]
    }

    /// The key times of one track; none where it is at rest.
    pub fn times_of(&self, track: &Track) -> &[f32] {
        &self.times[track.first_time as usize..][..track.keys as usize]
    }

    /// The value of a key, without its tangents.
    pub fn key(&self, track: &Track, key: usize) -> [f32; 4] {
        let at = if track.interpolation() == Interpolation::CubicSpline { 3 * key + 1 } else { key };
        self.values[track.first_value as usize + at]
    }

    /// Bytes of the three arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.tracks) + size_of_val(&*self.times) + size_of_val(&*self.values)
    }
}

/// A clip that grows.
#[derive(Default)]
struct Layout {
    tracks: Vec<Track>,
    times: Vec<f32>,
    values: Vec<[f32; 4]>,
    // Where times lie that a track has already.
    known: std::collections::HashMap<Vec<u32>, usize>,
    last: f32,
}

impl Layout {
    fn add(&mut self, keys: Option<Keys>, rest: [f32; 4]) {
        let at_rest = Keys { times: vec![], values: vec![rest], interpolation: Interpolation::Step };
        let keys = keys.unwrap_or(at_rest);
        let bits = keys.times.iter().map(|time| time.to_bits()).collect();
        let first_time = *self.known.entry(bits).or_insert_with(|| {
            self.times.extend(&keys.times);
            self.times.len() - keys.times.len()
        });
        self.last = keys.times.last().copied().unwrap_or(0.0).max(self.last);
        self.tracks.push(Track {
            first_time: first_time as u32,
            first_value: self.values.len() as u32,
            keys: keys.times.len() as u32,
            code: keys.interpolation as u32,
        });
        self.values.extend(keys.values);
    }

    fn finish(self, name: String, duration: f32) -> Result<Clip, InputError> {
        // Shaders count bytes of values in u32.
        if self.values.len() > (1 << 28) - 1 {
            return Err(InputError::new("clip.values.len", self.values.len(), "must be below 2^28"));
        }
        let Self { mut tracks, mut times, mut values, last, .. } = self;
        tracks.shrink_to_fit();
        times.shrink_to_fit();
        values.shrink_to_fit();
        Ok(Clip { name, duration: duration.max(last), tracks, times, values })
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
        let track = |first_time, first_value, keys, code| Track { first_time, first_value, keys, code };
        assert_eq!(clip.tracks()[..3], [track(0, 0, 2, 0), track(0, 2, 2, 1), track(2, 4, 1, 2)]);
        assert_eq!(clip.tracks()[3].keys, 0);
        let identity = [0.0, 0.0, 0.0, 1.0];
        assert_eq!(clip.values()[2..4], [identity; 2], "unit, and the short way");
        assert_eq!(clip.values()[7..], [[1.0, 2.0, 3.0, 0.0], identity, [4.0, 5.0, 6.0, 0.0]]);
        assert_eq!(clip.key(clip.track(0, Part::Scale), 0), [7.0; 4]);
        assert_eq!(clip.bytes(), 6 * 16 + 3 * 4 + 10 * 16);
        assert_eq!(Clip::new("a", &skeleton(), &bones, 2.0).expect("valid").duration(), 2.0);
    }

    #[test]
    fn what_is_no_clip_is_refused_by_field() {
        let refused = |translation, rotation| {
            let bones = [BoneKeys::default(), BoneKeys { translation, rotation, scale: None }];
            let error = Clip::new("a", &skeleton(), &bones, 0.0).expect_err("refused");
            (error.field, error.value)
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
        assert_eq!(few.field, "clip.bones.len");
        let long = Clip::new("a", &skeleton(), &[BoneKeys::default(), BoneKeys::default()], f32::NAN);
        assert_eq!(long.expect_err("refused").field, "clip.duration");
    }
}
