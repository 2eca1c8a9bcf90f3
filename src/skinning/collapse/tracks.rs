//! Tracks of bones whose parents have collapsed. A track combines the motion of the collapsed bones and of the bone
//! itself, relative to the kept bone above.

use glam::{DQuat, DVec3};

use super::choice::Remap;
use super::compose::{Composed, is_constant, signs_in};
use super::rest::Rest;
use crate::InputError;
use crate::animation::sample::reference::{sample_parts, slerp};
use crate::asset::clip::{Clip, Interpolation, Keys, TransformPart};
use crate::asset::keyframe::{KeyframeCursor, RotationPath, keyframe_cursor};
use crate::asset::transform::finite;
use crate::asset::{Model, Skeleton, Transform};

/// Allowed displacement caused by interpolating between two combined keys, as a fraction of the model's size at rest
/// (half the diagonal of its bounding box). It applies to points that follow the bone or bones below it.
///
/// Translation, rotation and scale are each tested at a quarter, half and three quarters of the interval. If the
/// displacement is larger, up to 63 keys are added within the interval.
const BETWEEN_KEYS: f64 = 1e-3;

/// The largest number of times that an interval between two keys is halved.
const HALVINGS: u32 = 6;

/// Two values count as equal if they differ by less than this fraction of the larger value.
const ROUNDING: f32 = 1e-6;

/// Converts a clip to the kept bones. `skeleton` is the skeleton of these bones.
pub(super) fn clip(
    model: &Model,
    clip: &Clip,
    remap: &Remap,
    skeleton: &Skeleton,
    rest: &Rest,
) -> Result<Clip, InputError> {
    let mut tracks = Vec::with_capacity(3 * skeleton.len());
    for (bone, reduced) in remap.kept().zip(skeleton.bones()) {
        let chain = remap.chain(bone);
        if chain.len() == 1 {
            tracks.extend(TransformPart::ALL.map(|part| clip.stored_keys(clip.track(bone, part))));
            continue;
        }
        let composed = Chain::new(model, clip, &chain, rest).tracks()?;
        tracks.extend(
            TransformPart::ALL
                .into_iter()
                .zip(composed)
                .map(|(part, keys)| settled(keys, part, &reduced.rest)),
        );
    }
    Clip::of_stored(clip.name(), clip.duration(), tracks)
}

/// If a track has no keys but its constant value differs from the rest transform, adds a key. A track without keys
/// would mean the rest transform.
fn settled(mut keys: Keys, part: TransformPart, rest: &Transform) -> Keys {
    if keys.times.is_empty() {
        let rest = value(rest, part);
        let length = rest.iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
        if distance(part, keys.values[0], rest) <= f64::from(ROUNDING * length) {
            keys.values[0] = rest;
        } else {
            keys.times.push(0.0);
        }
    }
    keys
}

/// The side from which a time is approached, which matters at a key where the track jumps.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Before,
    After,
}

/// A kept bone in a clip, with the collapsed bones between it and the next kept bone above.
struct Chain<'a> {
    clip: &'a Clip,
    /// The collapsed bones, each with the signs of its scale.
    collapsed: Vec<(usize, DVec3)>,
    bone: usize,
    /// The largest displacement of the model's points per unit of error in translation, rotation (radians) and scale.
    levers: [f64; 3],
    tolerance: f64,
}

impl<'a> Chain<'a> {
    fn new(model: &Model, clip: &'a Clip, chain: &[usize], rest: &Rest) -> Self {
        let (bone, collapsed) = (chain[chain.len() - 1], &chain[..chain.len() - 1]);
        let above = model.skeleton.bones()[chain[0]].parent;
        let scale = above.map_or(1.0, |above| rest.scale(above as usize));
        let own = rest.scale(bone);
        let of_scale = if own > 0.0 { scale * rest.radii[bone] / own } else { 0.0 };
        let signed = |bone: &usize| (*bone, signs_in(clip, *bone).unwrap_or(DVec3::ONE));
        Self {
            clip,
            collapsed: collapsed.iter().map(signed).collect(),
            bone,
            levers: [scale, rest.radii[bone], of_scale],
            tolerance: BETWEEN_KEYS * rest.size,
        }
    }

    fn tracks(&self) -> Result<[Keys; 3], InputError> {
        let is_rigid = self.moving(self.collapsed.iter().map(|(bone, _)| *bone)).is_empty();
        let [translation, mut rotation, scale] =
            if is_rigid { TransformPart::ALL.map(|part| self.mapped(part)) } else { self.sampled() };
        if rotation.interpolation != Interpolation::CubicSpline {
            rotation = rotation.stored("rotation", true)?;
        }
        let all = [translation, rotation, scale];
        all.iter().try_for_each(|keys| finite("keys", keys.values.as_flattened()))?;
        Ok(all)
    }

    /// The keys of all tracks of these bones, except constant tracks.
    fn moving(&self, bones: impl Iterator<Item = usize>) -> Vec<Keys> {
        let tracks = bones.flat_map(|bone| TransformPart::ALL.map(|part| (bone, part)));
        let moving = tracks.filter(|(bone, part)| !is_constant(self.clip, *bone, *part));
        moving.map(|(bone, part)| self.clip.stored_keys(self.clip.track(bone, part))).collect()
    }

    /// The combined transform of the collapsed bones at a time.
    fn above(&self, time: f32, side: Side) -> Composed {
        let add = |above: Composed, (bone, signs): &(usize, DVec3)| {
            above.with(&local(self.clip, *bone, time, side), *signs)
        };
        self.collapsed.iter().fold(Composed::IDENTITY, add)
    }

    fn at(&self, time: f32, side: Side) -> Transform {
        self.above(time, side).with(&local(self.clip, self.bone, time, side), DVec3::ONE).transform()
    }

    /// The bone's own keys, transformed by the collapsed bones, which do not move. The result is exact, because the
    /// transform is linear in the keys' values.
    fn mapped(&self, part: TransformPart) -> Keys {
        let above = self.above(0.0, Side::After);
        let mut keys = self.clip.stored_keys(self.clip.track(self.bone, part));
        let is_spline = keys.interpolation == Interpolation::CubicSpline;
        for (at, value) in keys.values.iter_mut().enumerate() {
            let is_tangent = is_spline && at % 3 != 1;
            let [x, y, z, w] = value.map(f64::from);
            let vector = DVec3::new(x, y, z);
            *value = match part {
                TransformPart::Translation if is_tangent => above.vector(vector).extend(0.0),
                TransformPart::Translation => above.point(vector).extend(0.0),
                TransformPart::Rotation => above.turned(DQuat::from_xyzw(x, y, z, w)).into(),
                TransformPart::Scale => (above.scale * vector).extend(0.0),
            }
            .as_vec4()
            .to_array();
        }
        keys
    }

    /// Keys at the key times of all tracks of the chain. More keys are added where linear interpolation is too
    /// inaccurate.
    fn sampled(&self) -> [Keys; 3] {
        let tracks = self.moving(self.collapsed.iter().map(|(bone, _)| *bone).chain([self.bone]));
        let mut times: Vec<f32> = tracks.iter().flat_map(|keys| keys.times.iter().copied()).collect();
        times.sort_by(f32::total_cmp);
        times.dedup();
        let is_step = tracks.iter().all(|keys| keys.interpolation == Interpolation::Step);
        let mut poses: Vec<(f32, Transform)> = Vec::new();
        for (at, time) in times.into_iter().enumerate() {
            let [before, after] = [Side::Before, Side::After].map(|side| (time, self.at(time, side)));
            if let Some(last) = poses.last().copied().filter(|_| !is_step) {
                self.halve([last, before], HALVINGS, &mut poses);
            }
            if before != after && (at == 0 || !is_step) {
                poses.push(before);
            }
            poses.push(after);
        }
        let interpolation = if is_step { Interpolation::Step } else { Interpolation::Linear };
        TransformPart::ALL.map(|part| keys(&poses, part, interpolation))
    }

    /// Adds keys between two keys, by repeated halving, if linear interpolation is too inaccurate.
    fn halve(&self, ends: [(f32, Transform); 2], halvings: u32, poses: &mut Vec<(f32, Transform)>) {
        let [(from, start), (to, end)] = ends;
        let at = |fraction: f32| from + (to - from) * fraction;
        let middle = at(0.5);
        let is_off = |fraction: f32| {
            let pose = self.at(at(fraction), Side::After);
            TransformPart::ALL.into_iter().zip(self.levers).any(|(part, lever)| {
                let straight = between(part, value(&start, part), value(&end, part), fraction);
                lever * distance(part, straight, value(&pose, part)) > self.tolerance
            })
        };
        let has_room = halvings > 0 && middle > from && middle < to;
        if has_room && [0.25, 0.5, 0.75].into_iter().any(is_off) {
            let pose = (middle, self.at(middle, Side::After));
            self.halve([ends[0], pose], halvings - 1, poses);
            poses.push(pose);
            self.halve([pose, ends[1]], halvings - 1, poses);
        }
    }
}

/// The keys of one part of the poses (translation, rotation or scale). There are none if the part is the same in all
/// poses.
fn keys(poses: &[(f32, Transform)], part: TransformPart, interpolation: Interpolation) -> Keys {
    let (times, values): (Vec<f32>, Vec<[f32; 4]>) =
        poses.iter().map(|(time, pose)| (*time, value(pose, part))).unzip();
    if values.windows(2).all(|pair| pair[0] == pair[1]) {
        return Keys { times: vec![], values: values[..1].to_vec(), interpolation: Interpolation::Step };
    }
    Keys { times, values, interpolation }
}

/// One part of a transform (translation, rotation or scale), in the form that tracks store.
fn value(transform: &Transform, part: TransformPart) -> [f32; 4] {
    let vector = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
    match part {
        TransformPart::Translation => vector(transform.translation),
        TransformPart::Rotation => transform.rotation,
        TransformPart::Scale => vector(transform.scale),
    }
}

/// The transform of a bone in its parent's space at a time.
fn local(clip: &Clip, bone: usize, time: f32, side: Side) -> Transform {
    let of = |part| {
        let track = clip.track(bone, part);
        let (times, interpolation) = (clip.times_of(track), track.interpolation);
        let cursor = match side {
            Side::Before => cursor_before(times, interpolation, time),
            Side::After => keyframe_cursor(times, time),
        };
        (&clip.values()[track.first_value as usize..], interpolation, cursor)
    };
    sample_parts(of, RotationPath::Slerp)
}

/// The keyframe cursor at a time that is approached from before. If the track jumps at a key at this time, the jump has
/// not happened yet.
fn cursor_before(times: &[f32], interpolation: Interpolation, time: f32) -> KeyframeCursor {
    let first = times.partition_point(|other| *other < time);
    if times.get(first) != Some(&time) {
        return keyframe_cursor(times, time);
    }
    let key = if interpolation == Interpolation::Step { first.saturating_sub(1) } else { first };
    KeyframeCursor { key: key as u32, fraction: 0.0 }
}

fn between(part: TransformPart, start: [f32; 4], end: [f32; 4], fraction: f32) -> [f32; 4] {
    if part != TransformPart::Rotation {
        return std::array::from_fn(|i| start[i] + (end[i] - start[i]) * fraction);
    }
    let dot: f32 = start.iter().zip(end).map(|(a, b)| a * b).sum();
    slerp(start, if dot < 0.0 { end.map(|x| -x) } else { end }, fraction)
}

/// The distance between two values of a transform part. It is Euclidean for translation, an angle in radians for
/// rotation, and the largest difference of a component for scale.
fn distance(part: TransformPart, a: [f32; 4], b: [f32; 4]) -> f64 {
    let [a, b] = [a, b].map(|value| glam::DVec4::from_array(value.map(f64::from)));
    match part {
        TransformPart::Translation => a.distance(b),
        // The angle follows from the chord between a and the nearer of b and −b.
        TransformPart::Rotation => {
            let (near, far) = (a.distance(b).min((a + b).length()), a.distance(b).max((a + b).length()));
            4.0 * near.atan2(far)
        }
        TransformPart::Scale => (a - b).abs().max_element(),
    }
}
