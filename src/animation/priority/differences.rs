//! Differences between each key and the next key. They give the first five terms of priorities.

use super::NOISE;
use crate::InputError;
use crate::animation::instance::Wrap;
use crate::animation::local_to_model::reference::local_to_model;
use crate::animation::sample::reference::sample_bone;
use crate::asset::clip::{Clip, TransformPart};
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;
use crate::asset::transform::Transform;

/// Change of a bone's transform from one key to the next.
pub(super) struct Difference {
    pub(super) bone: u32,
    pub(super) key: u32,
    pub(super) time: f32,
    /// Time of the bone's next key in seconds. If there is none, it equals `time`.
    pub(super) until: f32,
    /// Changes of translation (in units of the model), rotation (in radians) and scale (as a factor of the scale at rest).
    pub(super) change: [f64; 3],
}

/// Changes at all keys of a clip, bone by bone and key by key.
pub(super) struct Differences {
    pub(super) keys: Vec<Difference>,
    pub(super) offsets: Vec<u32>,
    pub(super) size: f64,
}

impl Differences {
    pub(super) fn new(skeleton: &Skeleton, clip: &Clip, wrap: Wrap) -> Result<Self, InputError> {
        InputError::check_same("clip.bones", clip.bones(), skeleton.len(), "as the skeleton's")?;
        let mut all = Self { keys: Vec::new(), offsets: vec![0], size: size(skeleton) };
        let above = skeleton.scales_above();
        for (bone, node) in skeleton.bones().iter().enumerate() {
            let times = key_times(clip, bone);
            let change = |from: &Transform, to: &Transform| {
                let [translation, rotation, scale] = change(from, to);
                [translation * above[bone], rotation, scale / node.scale()]
            };
            let at = |time: f32| sample_bone(clip, bone, time, RotationPath::Slerp);
            for (key, time) in times.iter().enumerate() {
                let next = times.get(key + 1).or_else(|| times.first().filter(|_| wrap == Wrap::Loop));
                let change = next.map_or([0.0; 3], |next| change(&at(*time), &at(*next)));
                let until = times.get(key + 1).copied().unwrap_or(*time);
                let (bone, key) = (bone as u32, key as u32);
                all.keys.push(Difference { bone, key, time: *time, until, change });
            }
            all.offsets.push(all.keys.len() as u32);
        }
        Ok(all)
    }

    /// First five terms of each key's priority, in the order of [`TERMS`](super::TERMS): all but the user term.
    pub(super) fn terms(&self, skeleton: &Skeleton) -> Vec<[f64; 5]> {
        let largest = |part: usize| self.keys.iter().map(|key| key.change[part]).fold(0.0, f64::max);
        let least = [NOISE * self.size, NOISE, NOISE];
        let fraction = |value: f64, largest: f64, least: f64| {
            if largest < least || largest <= 0.0 { 0.0 } else { value / largest }
        };
        let largest = [0, 1, 2].map(largest);
        let most_children = skeleton.descendants().iter().copied().max().unwrap_or(0).into();
        let deepest = f64::from(skeleton.depths().iter().copied().max().unwrap_or(0));
        let of_key = |key: &Difference| {
            let bone = key.bone as usize;
            let [translation, rotation, scale] =
                [0, 1, 2].map(|part| fraction(key.change[part], largest[part], least[part]));
            let children = fraction(skeleton.descendants()[bone].into(), most_children, NOISE);
            let depth = (deepest - f64::from(skeleton.depths()[bone]) + 1.0) / (deepest + 1.0);
            [translation, rotation, scale, children, depth]
        };
        self.keys.iter().map(of_key).collect()
    }
}

/// Key times of a bone's translation, rotation and scale tracks, in seconds: sorted, without duplicates.
pub fn key_times(clip: &Clip, bone: usize) -> Vec<f32> {
    let tracks = TransformPart::ALL.map(|part| clip.times_of(clip.track(bone, part)));
    let mut times = tracks.concat();
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

fn change(from: &Transform, to: &Transform) -> [f64; 3] {
    [
        distance(from.translation, to.translation),
        angle(from.rotation, to.rotation),
        distance(from.scale, to.scale),
    ]
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f64 {
    let [a, b] = [a, b].map(|v| glam::DVec3::from(v.map(f64::from)));
    a.distance(b)
}

/// Rotation angle `2·acos(min(1, |a·b|))` between two quaternions, in radians. It is computed from the chord, which is exact for
/// small angles. With the cosine, rounding would give an error of 0.001 rad.
fn angle(a: [f32; 4], b: [f32; 4]) -> f64 {
    let [a, b] = [a, b].map(|q| glam::DVec4::from(q.map(f64::from)).normalize());
    let b = if a.dot(b) < 0.0 { -b } else { b };
    4.0 * libm::asin((a.distance(b) / 2.0).min(1.0))
}

/// Size of a skeleton: the diagonal of the box around all bone origins at rest, in units of the model.
pub fn size(skeleton: &Skeleton) -> f64 {
    let model_matrices = local_to_model(skeleton, &skeleton.rest());
    let positions = model_matrices.iter().map(|model| glam::DVec3::from(model.map(|row| f64::from(row[3]))));
    let (low, high) = positions.fold((glam::DVec3::MAX, glam::DVec3::MIN), |(low, high), position| {
        (low.min(position), high.max(position))
    });
    low.distance(high)
}
