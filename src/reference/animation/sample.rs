//! Sampling of clips: twin of `kernels/animation/sample.wgsl`.

use crate::animation::clip::{Clip, Interpolation, Part, Track};
use crate::animation::sample::{RotationPath, SLERP_U, SLERP_V, Wrap};
use crate::animation::transform::Transform;

/// A spline of rotations that passes this close to zero keeps the key before: nothing has a direction there.
const VANISHING: f32 = 1e-12;

/// The time inside a clip, in the order of the shader. [`Wrap::inside`] is more exact where times are large.
pub fn wrapped(wrap: Wrap, duration: f32, time: f32) -> f32 {
    if duration <= 0.0 {
        return 0.0;
    }
    if wrap == Wrap::Clamp {
        return time.max(0.0).min(duration);
    }
    let mut inside = time - (time / duration).floor() * duration;
    if inside < 0.0 {
        inside += duration;
    }
    if inside >= duration {
        inside -= duration;
    }
    inside
}

/// Every bone's transform, in its parent's space, at a time inside the clip.
pub fn sample(clip: &Clip, time: f32, path: RotationPath) -> Vec<Transform> {
    (0..clip.bones()).map(|bone| sample_bone(clip, bone, time, path)).collect()
}

/// One bone's transform.
pub fn sample_bone(clip: &Clip, bone: usize, time: f32, path: RotationPath) -> Transform {
    let vector = |part| {
        let track = clip.track(bone, part);
        let [x, y, z, _] = vector_at(clip, track, place(clip.times_of(track), time));
        [x, y, z]
    };
    let track = clip.track(bone, Part::Rotation);
    let rotation = rotation_at(clip, track, place(clip.times_of(track), time), path);
    Transform { translation: vector(Part::Translation), rotation, scale: vector(Part::Scale) }
}

/// A place between two keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The key before.
    pub key: usize,
    /// The way to the key after it, 0 to below 1. 0 outside the keys.
    pub fraction: f32,
    /// Seconds between both.
    pub seconds: f32,
}

/// Where a time lies among key times. The last of equal times counts.
pub fn place(times: &[f32], time: f32) -> Place {
    let last = times.len().saturating_sub(1);
    if last == 0 || time < times[0] {
        return Place { key: 0, fraction: 0.0, seconds: 0.0 };
    }
    if time >= times[last] {
        return Place { key: last, fraction: 0.0, seconds: 0.0 };
    }
    // Most clips are sampled evenly: a guess hits.
    let evenly = (time - times[0]) / (times[last] - times[0]) * last as f32;
    let mut key = (evenly as usize).min(last - 1);
    if times[key] > time || times[key + 1] <= time {
        let mut end = last;
        key = 0;
        while end - key > 1 {
            let middle = (key + end) / 2;
            if times[middle] <= time {
                key = middle;
            } else {
                end = middle;
            }
        }
    }
    let seconds = times[key + 1] - times[key];
    Place { key, fraction: (time - times[key]) / seconds, seconds }
}

fn vector_at(clip: &Clip, track: &Track, place: Place) -> [f32; 4] {
    let value = |at: usize| clip.values()[track.first_value as usize + at];
    match track.interpolation() {
        Interpolation::CubicSpline => spline(&value, place),
        Interpolation::Linear if place.fraction > 0.0 => {
            lerp(value(place.key), value(place.key + 1), place.fraction)
        }
        _ => value(place.key),
    }
}

fn rotation_at(clip: &Clip, track: &Track, place: Place, path: RotationPath) -> [f32; 4] {
    let value = |at: usize| clip.values()[track.first_value as usize + at];
    match track.interpolation() {
        Interpolation::CubicSpline => {
            let between = spline(&value, place);
            let key = value(3 * place.key + 1);
            normalized(if dot(between, between) < VANISHING { key } else { between })
        }
        Interpolation::Linear if place.fraction > 0.0 => {
            let (before, after) = (value(place.key), value(place.key + 1));
            match path {
                RotationPath::Slerp => slerp(before, after, place.fraction),
                RotationPath::Nlerp => normalized(lerp(before, after, place.fraction)),
            }
        }
        _ => value(place.key),
    }
}

/// glTF's spline: values and tangents, three a key.
fn spline(value: &impl Fn(usize) -> [f32; 4], place: Place) -> [f32; 4] {
    let (at, t) = (3 * place.key, place.fraction);
    let start = value(at + 1);
    if t <= 0.0 {
        return start;
    }
    let (leaving, arriving, end) = (value(at + 2), value(at + 3), value(at + 4));
    let (square, cube) = (t * t, t * t * t);
    let of_end = 3.0 * square - 2.0 * cube;
    let of_start = 1.0 - of_end;
    let of_leaving = place.seconds * (cube - 2.0 * square + t);
    let of_arriving = place.seconds * (cube - square);
    std::array::from_fn(|i| {
        of_start * start[i] + of_leaving * leaving[i] + of_end * end[i] + of_arriving * arriving[i]
    })
}

fn lerp(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

fn dot(a: [f32; 4], b: [f32; 4]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

fn normalized(q: [f32; 4]) -> [f32; 4] {
    let scale = 1.0 / dot(q, q).sqrt();
    q.map(|component| component * scale)
}

/// The rotation `t` of the way from `a` to `b`, both unit, with `dot(a, b) ≥ 0` as clips store them.
pub fn slerp(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    let cosine = dot(a, b);
    // Halved: from the nearer end towards the unit quaternion in the middle, (a + b)·inverse.
    let inverse = 1.0 / (2.0 + 2.0 * cosine).sqrt();
    let less_one = (1.0 + cosine) * inverse - 1.0;
    let (nearer, farther) = if t < 0.5 { (a, b) } else { (b, a) };
    let way = if t < 0.5 { 2.0 * t } else { 2.0 - 2.0 * t };
    let of_middle = slerp_weight(way, less_one) * inverse;
    let of_nearer = slerp_weight(1.0 - way, less_one) + of_middle;
    std::array::from_fn(|i| nearer[i] * of_nearer + farther[i] * of_middle)
}

/// `sin(t·θ) / sin(θ)` for `less_one` = cos θ − 1.
fn slerp_weight(t: f32, less_one: f32) -> f32 {
    let square = t * t;
    let terms = SLERP_U.iter().zip(SLERP_V).rev();
    t * terms.fold(1.0, |sum, (u, v)| 1.0 + (u * square - v) * less_one * sum)
}
