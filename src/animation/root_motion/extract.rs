//! Extraction of root motion from a clip.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::{PIECE, RootMotion, SPLINE_PIECES, Taken, rigid::Rigid};
use crate::InputError;
use crate::animation::sample::reference::{rotation_at, sample_bone};
use crate::asset::clip::{Clip, Interpolation, Keys, Track, TransformPart};
use crate::asset::keyframe::KeyframeCursor;
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;

/// Largest relative unevenness or shear of the ancestors' scale that is accepted if the yaw is taken.
const UNEVEN: f64 = 1e-4;

/// Smallest squared length of a quaternion's twist at which its yaw is defined. Below it, the previous yaw is kept.
const UPSIDE_DOWN: f64 = 1e-12;

pub(super) fn extract(
    skeleton: &Skeleton,
    clip: &Clip,
    bone: usize,
    taken: Taken,
) -> Result<(Clip, RootMotion), InputError> {
    InputError::check_same("clip.bones", clip.bones(), skeleton.len(), "as the skeleton's")?;
    InputError::check_below("bone", bone, skeleton.len())?;
    if !(taken.horizontal || taken.vertical && !taken.yaw) {
        let bound = "must be true unless taken.vertical is, and taken.yaw is not";
        return Err(InputError::new("taken.horizontal", taken.horizontal, bound));
    }
    let above = above(skeleton, clip, bone)?;
    let start = sample_bone(clip, bone, 0.0, RotationPath::Slerp);
    let origin = DVec3::from(start.translation.map(f64::from));
    let (path, translation) = split_path(clip, bone, origin, &above.matrix3, taken);
    let turning =
        taken.yaw.then(|| split_turn(skeleton, clip, bone, start.rotation, &above)).transpose()?.flatten();
    let (turn_times, turns, rotation) = match turning {
        None => (Vec::new(), Vec::new(), None),
        Some((turns, keys)) => (keys.times.clone(), turns, Some(keys)),
    };
    let (pivot, duration) = (above.transform_point3(origin).to_array(), f64::from(clip.duration()));
    let whole = Rigid::about(pivot, 0.0, [0.0; 3]);
    let mut motion = RootMotion { duration, path, turn_times, turns, pivot, whole };
    motion.whole = motion.since_start(duration);
    Ok((clip.replaced(bone, translation, rotation)?, motion))
}

/// Returns the transform from the space of the bone's parent to model space. Returns an error if an ancestor moves.
fn above(skeleton: &Skeleton, clip: &Clip, bone: usize) -> Result<DAffine3, InputError> {
    let mut above = DAffine3::IDENTITY;
    let parent = |bone: u32| skeleton.bones()[bone as usize].parent;
    for ancestor in std::iter::successors(parent(bone as u32), |bone| parent(*bone)) {
        let ancestor = ancestor as usize;
        if TransformPart::ALL.iter().any(|part| moves(clip, clip.track(ancestor, *part))) {
            let bound = format!("must not move: it is above bone {bone}, whose motion is taken");
            return Err(InputError::new(
                format!("clip.bones[{ancestor}]"),
                &skeleton.bones()[ancestor].name,
                bound,
            ));
        }
        above = sample_bone(clip, ancestor, 0.0, RotationPath::Slerp).wide() * above;
    }
    let matrix = above.matrix3;
    // Also refuses determinants that would be zero without rounding.
    let size = matrix.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    if matrix.determinant().abs() <= 1e-9 * size.powi(3) {
        return Err(wrong_scale(skeleton, clip, bone, "must not make the bones below it flat"));
    }
    Ok(above)
}

/// Returns the error for a bad scale above `bone`. It names the ancestor that mirrors or, if there is none, the ancestor with the
/// most uneven scale.
fn wrong_scale(skeleton: &Skeleton, clip: &Clip, bone: usize, bound: &str) -> InputError {
    let parent = |bone: u32| skeleton.bones()[bone as usize].parent;
    let above = std::iter::successors(parent(bone as u32), |bone| parent(*bone));
    let scales: Vec<(u32, [f32; 3])> =
        above.map(|bone| (bone, sample_bone(clip, bone as usize, 0.0, RotationPath::Slerp).scale)).collect();
    let mirrors = |scale: &[f32; 3]| scale.iter().product::<f32>() < 0.0;
    // Ratio of the smallest to the largest scale factor: 0 for a flat scale, 1 for a uniform scale.
    let evenness = |scale: &[f32; 3]| {
        let sizes = scale.map(f32::abs);
        sizes.into_iter().fold(f32::MAX, f32::min) / sizes.into_iter().fold(f32::MIN_POSITIVE, f32::max)
    };
    let worst = scales
        .iter()
        .min_by(|(_, a), (_, b)| (!mirrors(a)).cmp(&!mirrors(b)).then(evenness(a).total_cmp(&evenness(b))));
    let (above, scale) = worst.map_or((bone as u32, [1.0; 3]), |found| *found);
    InputError::new(format!("clip.bones[{above}].scale"), format!("{scale:?}"), bound)
}

fn moves(clip: &Clip, track: &Track) -> bool {
    let keys = clip.stored_keys(track);
    let each = keys.values.len() / (track.keys.max(1) as usize);
    let is_spline = keys.interpolation == Interpolation::CubicSpline;
    let bends = is_spline
        && keys.values.chunks(each).any(|key| [key[0], key[2]].as_flattened().iter().any(|x| *x != 0.0));
    let differ = (1..track.keys as usize).any(|key| clip.key(track, key) != clip.key(track, 0));
    track.keys > 1 && (bends || differ)
}

/// Returns the keys of two translations: the taken translation since the clip's start, in model space, and the remaining
/// translation. Both are linear in the original values, so they keep the interpolation of the track.
fn split_path(clip: &Clip, bone: usize, origin: DVec3, above: &DMat3, taken: Taken) -> (Keys, Option<Keys>) {
    let part = |is_taken: bool| f64::from(u8::from(is_taken));
    let (horizontal, vertical) = (part(taken.horizontal), part(taken.vertical));
    let into_model = DMat3::from_diagonal(DVec3::new(horizontal, vertical, horizontal)) * *above;
    let into_parent = above.inverse() * into_model;
    let keys = clip.stored_keys(clip.track(bone, TransformPart::Translation));
    let is_spline = keys.interpolation == Interpolation::CubicSpline;
    let (mut path, mut rest) = (keys.clone(), keys.clone());
    for (at, [x, y, z, _]) in keys.values.into_iter().enumerate() {
        let value = DVec3::new(x.into(), y.into(), z.into());
        let is_tangent = is_spline && at % 3 != 1;
        let moved = if is_tangent { value } else { value - origin };
        let store = |v: DVec3| [v.x as f32, v.y as f32, v.z as f32, 0.0];
        path.values[at] = store(into_model * moved);
        rest.values[at] = store(value - into_parent * moved);
    }
    let moves = path.times.len() > 1;
    (path, moves.then_some(rest))
}

/// Returns the yaw in radians since the clip's start, and the keys of the remaining rotation. Returns `None` if the track has no
/// two different key times.
fn split_turn(
    skeleton: &Skeleton,
    clip: &Clip,
    bone: usize,
    start: [f32; 4],
    above: &DAffine3,
) -> Result<Option<(Vec<f64>, Keys)>, InputError> {
    let matrix = above.matrix3;
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let size = x.length_squared();
    let off = [y.length_squared() - size, z.length_squared() - size, x.dot(y), y.dot(z), z.dot(x)];
    if matrix.determinant() <= 0.0 || off.into_iter().any(|off| off.abs() > UNEVEN * size) {
        let bound = "must be even and not mirror, since a yaw is taken below it";
        return Err(wrong_scale(skeleton, clip, bone, bound));
    }
    let up = (matrix.inverse() * DVec3::Y).normalize();
    let samples = samples(&clip.stored_keys(clip.track(bone, TransformPart::Rotation)));
    if samples.is_empty() {
        return Ok(None);
    }
    let quaternion = |q: [f32; 4]| DQuat::from_array(q.map(f64::from)).normalize();
    let back = quaternion(start).inverse();
    let (mut turns, mut times, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = 0.0_f64;
    for (time, value) in samples {
        let since = quaternion(value) * back;
        let about = DVec3::new(since.x, since.y, since.z).dot(up);
        if about * about + since.w * since.w > UPSIDE_DOWN {
            let turn = 2.0 * about.atan2(since.w);
            last = turn + std::f64::consts::TAU * ((last - turn) / std::f64::consts::TAU).round();
        }
        let left = DQuat::from_axis_angle(up, -last) * quaternion(value);
        turns.push(last);
        times.push(time);
        values.push(left.to_array().map(|component| component as f32));
    }
    Ok(Some((turns, Keys { times, values, interpolation: Interpolation::Linear })))
}

/// Samples of a rotation track: at all keys, on both sides of jumps, and between keys where the interpolation needs it.
fn samples(keys: &Keys) -> Vec<(f32, [f32; 4])> {
    let is_spline = keys.interpolation == Interpolation::CubicSpline;
    let mut samples: Vec<(f32, [f32; 4])> = Vec::new();
    let mut add = |time, key: usize, fraction| {
        let cursor = KeyframeCursor { key: key as u32, fraction };
        let value = rotation_at(&keys.values, keys.interpolation, cursor, RotationPath::Slerp);
        if samples.last() != Some(&(time, value)) {
            samples.push((time, value));
        }
    };
    let Some(last) = keys.times.len().checked_sub(1).filter(|last| keys.times[*last] > keys.times[0]) else {
        return samples;
    };
    add(keys.times[0], 0, 0.0);
    for (key, pair) in keys.times.windows(2).enumerate() {
        let seconds = pair[1] - pair[0];
        if seconds <= 0.0 {
            add(pair[1], key + 1, 0.0);
        } else if keys.interpolation == Interpolation::Step {
            add(pair[0], key, 0.0);
            add(pair[1], key, 0.0);
        } else {
            let pieces =
                if is_spline { SPLINE_PIECES } else { pieces(keys.values[key], keys.values[key + 1]) };
            for piece in 0..pieces {
                let fraction = piece as f32 / pieces as f32;
                add((pair[0] + seconds * fraction).min(pair[1]), key, fraction);
            }
            add(pair[1], key + 1, 0.0);
        }
    }
    add(keys.times[last], last, 0.0);
    samples
}

/// Number of pieces of a segment such that no piece rotates by more than [`PIECE`].
fn pieces(before: [f32; 4], after: [f32; 4]) -> u32 {
    let cosine: f64 = before.iter().zip(after).map(|(a, b)| f64::from(*a) * f64::from(b)).sum();
    ((2.0 * cosine.abs().min(1.0).acos() / PIECE).ceil() as u32).max(1)
}
