//! Sampling of clips: the CPU reference of `kernels/animation/sample.wgsl`.

use crate::animation::clip_set::{ClipSet, SetTrack};
use crate::animation::instance::Instance;
use crate::animation::layers::{AnimationLayer, all_instances};
use crate::animation::sample::{SLERP_U, SLERP_V};
use crate::asset::clip::{Clip, Interpolation, TransformPart};
use crate::asset::keyframe::{KeyframeCursor, RotationPath, keyframe_cursor};
use crate::asset::transform::Transform;
use crate::shared::animation::sample::VANISHING;

/// Local transform of every bone at a time inside the clip, in seconds.
pub fn sample(clip: &Clip, time: f32, path: RotationPath) -> Vec<Transform> {
    (0..clip.bones()).map(|bone| sample_bone(clip, bone, time, path)).collect()
}

/// Local transform of one bone at a time inside the clip, in seconds.
pub fn sample_bone(clip: &Clip, bone: usize, time: f32, path: RotationPath) -> Transform {
    let of = |part| {
        let track = clip.track(bone, part);
        let values = &clip.values()[track.first_value as usize..];
        (values, track.interpolation, keyframe_cursor(clip.times_of(track), time))
    };
    sample_parts(of, path)
}

/// A track with a cursor: the values from the track's first value on, their interpolation, and the cursor.
pub(crate) type Found<'a> = (&'a [[f32; 4]], Interpolation, KeyframeCursor);

/// Samples the three tracks of a bone into a transform.
pub(crate) fn sample_parts<'a>(track: impl Fn(TransformPart) -> Found<'a>, path: RotationPath) -> Transform {
    let vector = |part| {
        let (values, interpolation, cursor) = track(part);
        let [x, y, z, _] = vector_at(values, interpolation, cursor);
        [x, y, z]
    };
    let (values, interpolation, cursor) = track(TransformPart::Rotation);
    let rotation = rotation_at(values, interpolation, cursor, path);
    Transform {
        translation: vector(TransformPart::Translation),
        rotation,
        scale: vector(TransformPart::Scale),
    }
}

pub(crate) fn vector_at(
    values: &[[f32; 4]],
    interpolation: Interpolation,
    cursor: KeyframeCursor,
) -> [f32; 4] {
    let key = cursor.key as usize;
    match interpolation {
        Interpolation::CubicSpline => spline(values, cursor),
        Interpolation::Linear if cursor.fraction > 0.0 => lerp(values[key], values[key + 1], cursor.fraction),
        _ => values[key],
    }
}

pub(crate) fn rotation_at(
    values: &[[f32; 4]],
    interpolation: Interpolation,
    cursor: KeyframeCursor,
    path: RotationPath,
) -> [f32; 4] {
    let key = cursor.key as usize;
    match interpolation {
        Interpolation::CubicSpline => {
            let between = spline(values, cursor);
            normalized(if dot(between, between) < VANISHING { values[3 * key + 1] } else { between })
        }
        Interpolation::Linear if cursor.fraction > 0.0 => match path {
            RotationPath::Slerp => slerp(values[key], values[key + 1], cursor.fraction),
            RotationPath::Nlerp => normalized(lerp(values[key], values[key + 1], cursor.fraction)),
        },
        _ => values[key],
    }
}

/// Evaluates the cubic spline of glTF. Each key has an in-tangent, a value and an out-tangent.
fn spline(values: &[[f32; 4]], cursor: KeyframeCursor) -> [f32; 4] {
    let (at, t) = (3 * cursor.key as usize, cursor.fraction);
    let start = values[at + 1];
    if t <= 0.0 {
        return start;
    }
    let (leaving, arriving, end) = (values[at + 2], values[at + 3], values[at + 4]);
    let (square, cube) = (t * t, t * t * t);
    let of_end = 3.0 * square - 2.0 * cube;
    let of_start = 1.0 - of_end;
    let of_leaving = cube - 2.0 * square + t;
    let of_arriving = cube - square;
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

/// Rotation at the fraction `t` (0 to 1) of the arc from `a` to `b`. Both must be unit quaternions with `dot(a, b) ≥ 0`, as clips
/// store them. The function halves the arc: it interpolates from the nearer end to the unit quaternion in the middle, `(a +
/// b)·inverse`.
pub fn slerp(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    let cosine = dot(a, b);
    let inverse = 1.0 / (2.0 + 2.0 * cosine).sqrt();
    let less_one = (1.0 + cosine) * inverse - 1.0;
    let (nearer, farther, way) = if t < 0.5 { (a, b, 2.0 * t) } else { (b, a, 2.0 - 2.0 * t) };
    let of_middle = slerp_weight(way, less_one) * inverse;
    let of_nearer = slerp_weight(1.0 - way, less_one) + of_middle;
    std::array::from_fn(|i| nearer[i] * of_nearer + farther[i] * of_middle)
}

/// Returns `sin(t·θ) / sin(θ)`, where `less_one` is cos θ − 1.
fn slerp_weight(t: f32, less_one: f32) -> f32 {
    let terms = SLERP_U.iter().zip(SLERP_V).rev();
    t * terms.fold(1.0, |sum, (u, v)| 1.0 + (u * (t * t) - v) * less_one * sum)
}

/// Local transform of every bone of every instance, at the instances' cursors. The function follows the kernel's computation.
///
/// # Panics
/// If there are fewer than [`ClipSet::timelines_a_clip`] cursors per instance.
pub fn sample_set(
    set: &ClipSet,
    instances: &[Instance],
    cursors: &[KeyframeCursor],
    path: RotationPath,
) -> Vec<Transform> {
    let mut transforms = vec![Transform::IDENTITY; instances.len() * set.bones()];
    sample_set_into(set, instances, cursors, path, &mut transforms);
    transforms
}

/// Computes the same as [`sample_set`], but into an existing slice, without allocation.
///
/// # Panics
/// If there are fewer cursors or transforms than the instances need.
pub fn sample_set_into(
    set: &ClipSet,
    instances: &[Instance],
    cursors: &[KeyframeCursor],
    path: RotationPath,
    transforms: &mut [Transform],
) {
    let (bones, room) = (set.bones(), set.timelines_a_clip());
    for (index, instance) in instances.iter().enumerate() {
        let cursors = &cursors[index * room..][..room];
        for (bone, transform) in transforms[index * bones..][..bones].iter_mut().enumerate() {
            *transform = sample_pair(set, instance, cursors, bone, path);
        }
    }
}

/// Local transform of one bone of one instance, at the instance's cursors.
///
/// # Panics
/// If there are fewer cursors than the clip needs.
pub fn sample_pair(
    set: &ClipSet,
    instance: &Instance,
    cursors: &[KeyframeCursor],
    bone: usize,
    path: RotationPath,
) -> Transform {
    let tracks = &set.tracks()[3 * (set.bones() * instance.clip as usize + bone)..][..3];
    sample_parts(|part| find(set, tracks[part as usize], cursors), path)
}

/// Local transform of every bone of every instance, blended over its layers. `cursors` are the cursors of [`all_instances`]. The
/// function follows the kernel's computation for a layered crowd.
///
/// # Panics
/// If there are fewer cursors than the set needs, or if a layer does not match the base.
pub fn sample_layers(
    set: &ClipSet,
    base: &[Instance],
    layers: &[AnimationLayer],
    cursors: &[KeyframeCursor],
    path: RotationPath,
) -> Vec<Transform> {
    let all = sample_set(set, &all_instances(base, layers), cursors, path);
    let (below, above) = all.split_at(base.len() * set.bones());
    let mut poses = below.to_vec();
    for (layer, over) in layers.iter().zip(above.chunks(below.len())) {
        for (pair, (pose, over)) in poses.iter_mut().zip(over).enumerate() {
            let weight = layer.weight(pair / set.bones(), pair % set.bones());
            if weight > 0.0 {
                *pose = blend(pose, over, weight);
            }
        }
    }
    poses
}

/// Blends two transforms: `below` at weight 0, `over` at weight 1. Rotations are blended along the chord to the nearer of q and
/// −q.
pub fn blend(below: &Transform, over: &Transform, weight: f32) -> Transform {
    let rest = 1.0 - weight;
    let vector =
        |below: [f32; 3], over: [f32; 3]| std::array::from_fn(|i| below[i] * rest + over[i] * weight);
    let nearer = if dot(below.rotation, over.rotation) < 0.0 { -weight } else { weight };
    let rotation = std::array::from_fn(|i| below.rotation[i] * rest + over.rotation[i] * nearer);
    Transform {
        translation: vector(below.translation, over.translation),
        rotation: normalized(rotation),
        scale: vector(below.scale, over.scale),
    }
}

fn find<'a>(set: &'a ClipSet, track: SetTrack, cursors: &[KeyframeCursor]) -> Found<'a> {
    let first = track.first_value as usize;
    let start = KeyframeCursor::default();
    match (track.timeline, track.interpolation) {
        // `first` is the index of the middle of three values. Sampling starts at the value before it.
        (None, Interpolation::CubicSpline) => (&set.values()[first - 1..], Interpolation::CubicSpline, start),
        (None, _) => (&set.values()[first..], Interpolation::Step, start),
        (Some(timeline), between) => (&set.values()[first..], between, cursors[timeline as usize]),
    }
}
