//! A crowd at the limits of what clips may contain, with poses that are known without a reference: a bone
//! without tracks, tracks of one key, equal times, q and −q, keys that begin late and end early, and a clip of
//! 0 seconds.

use std::f32::consts::{FRAC_1_SQRT_2, PI};

use relievo::InputError;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::keyframe::KeyframeCursor;
use relievo::asset::skeleton::{Bone, Skeleton};
use relievo::asset::transform::Transform;
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::instance::{Instance, Wrap};

/// The crowd, with the time of each instance in the first clip, or `None` if it plays the second.
pub(crate) struct Edges {
    /// The clips.
    pub set: ClipSet,
    /// The instances.
    pub instances: Vec<Instance>,
    /// Times inside the clip, in seconds.
    pub times: Vec<Option<f32>>,
}

const REST: Transform =
    Transform { translation: [1.0, 2.0, 3.0], rotation: [0.0, 0.6, 0.0, 0.8], scale: [1.0, -2.0, 0.0] };

fn along(times: &[f32], x: &[f32]) -> Option<Keys> {
    let values = x.iter().map(|x| [*x, 0.0, 0.0, 0.0]).collect();
    Some(Keys { times: times.to_vec(), values, interpolation: Interpolation::Linear })
}

fn turning(last: [f32; 4]) -> Option<Keys> {
    let values = vec![[0.0, 0.0, 0.0, 1.0], last];
    Some(Keys { times: vec![0.0, 1.0], values, interpolation: Interpolation::Linear })
}

/// The time at which the poses are those of [`Edges::poses`], in seconds since the starts of the instances.
pub(crate) const ELAPSED: f32 = 0.25;

/// A clip of six bones that lasts a second and one that lasts 0 seconds; then both again with the keys of all
/// rotations negated, which are the same rotations.
fn clips(skeleton: &Skeleton) -> Result<[Clip; 4], InputError> {
    let one = |values: Vec<[f32; 4]>, interpolation| Some(Keys { times: vec![0.25], values, interpolation });
    let tangent = [9.0; 4];
    let only = BoneKeys {
        translation: one(vec![[7.0, 0.0, 0.0, 0.0]], Interpolation::Step),
        rotation: one(vec![[0.0, 2.0, 0.0, 0.0]], Interpolation::Linear),
        scale: one(vec![tangent, [4.0, 5.0, 6.0, 0.0], tangent], Interpolation::CubicSpline),
    };
    let moves = |translation| BoneKeys { translation, ..BoneKeys::default() };
    let turns = |rotation| BoneKeys { rotation, ..BoneKeys::default() };
    let second = [
        BoneKeys::default(),
        only.clone(),
        moves(along(&[0.0, 0.5, 0.5, 1.0], &[0.0, 4.0, 8.0, 12.0])),
        turns(turning([0.0, 0.0, 0.0, -1.0])),
        turns(turning([0.0, 0.0, -FRAC_1_SQRT_2, -FRAC_1_SQRT_2])),
        moves(along(&[0.25, 0.75], &[1.0, 3.0])),
    ];
    let at_once = |mut keys: BoneKeys| {
        for keys in [&mut keys.translation, &mut keys.rotation, &mut keys.scale].into_iter().flatten() {
            keys.times.fill(0.0);
        }
        keys
    };
    let no_time: Vec<_> = second.iter().cloned().map(at_once).collect();
    let negated = |bones: &[BoneKeys]| {
        let mut bones = bones.to_vec();
        for keys in bones.iter_mut().filter_map(|bone| bone.rotation.as_mut()) {
            keys.values.iter_mut().flatten().for_each(|component| *component = -*component);
        }
        bones
    };
    let clip = |name, bones: &[BoneKeys]| Clip::new(name, skeleton, bones, 0.0);
    let (second_negated, no_time_negated) = (negated(&second), negated(&no_time));
    Ok([
        clip("a second", &second)?,
        clip("no time", &no_time)?,
        clip("a second, negated", &second_negated)?,
        clip("no time, negated", &no_time_negated)?,
    ])
}

/// The crowd of all these cases.
///
/// # Errors
/// None in practice: the clips are checked like any others.
pub(crate) fn edges() -> Result<Edges, InputError> {
    let bone = |at: u32| Bone { name: format!("bone {at}"), parent: at.checked_sub(1), rest: REST };
    let skeleton = Skeleton::of_joints((0..6).map(bone).collect())?;
    let clips = clips(&skeleton)?;
    let set = ClipSet::new(&clips.iter().collect::<Vec<_>>())?;
    let mut edges = Edges { set, instances: vec![], times: vec![] };
    let mut add = |instance, time| {
        edges.instances.push(instance);
        edges.times.push(time);
    };
    for (start, looped, clamped) in [
        (0.0, 0.0, 0.0),
        (0.125, 0.125, 0.125),
        (0.25, 0.25, 0.25),
        (0.5, 0.5, 0.5),
        (0.625, 0.625, 0.625),
        (0.75, 0.75, 0.75),
        (1.0, 0.0, 1.0),
        (1.5, 0.5, 1.0),
        (-0.25, 0.75, 0.0),
        (-1.0, 0.0, 0.0),
        (64.375, 0.375, 1.0),
    ] {
        add(Instance::new(0, Wrap::Loop, start - ELAPSED, 1.0), Some(looped));
        add(Instance::new(0, Wrap::Clamp, start + ELAPSED, -1.0), Some(clamped));
        add(Instance::new(1, [Wrap::Loop, Wrap::Clamp][usize::from(start > 0.5)], start, 1.0), None);
    }
    Ok(edges)
}

impl Edges {
    /// The cursors of each instance, one per timeline of its clip.
    pub(crate) fn cursors(&self) -> Vec<Vec<KeyframeCursor>> {
        let cursor = |key, fraction| KeyframeCursor { key, fraction };
        let of = |time: &Option<f32>| match *time {
            // The timelines: the quarters, which are all tracks' times together; repeated, whole, and late
            // times.
            Some(t) => vec![
                cursor((4.0 * t) as u32, (4.0 * t).fract()),
                if t >= 1.0 { cursor(3, 0.0) } else { cursor(2 * u32::from(t >= 0.5), 2.0 * (t % 0.5)) },
                if t >= 1.0 { cursor(1, 0.0) } else { cursor(0, t) },
                if t >= 0.75 { cursor(1, 0.0) } else { cursor(0, 2.0 * (t - 0.25).max(0.0)) },
            ],
            // The timelines of the clip of 0 seconds: the only time; the last of four; the last of two.
            None => vec![cursor(0, 0.0), cursor(3, 0.0), cursor(1, 0.0)],
        };
        self.times.iter().map(of).collect()
    }

    /// The bones of each instance.
    pub(crate) fn poses(&self) -> Vec<Transform> {
        let at = |x: f32| Transform { translation: [x, 0.0, 0.0], ..REST };
        let turned =
            |angle: f32| Transform { rotation: [0.0, 0.0, (angle / 2.0).sin(), (angle / 2.0).cos()], ..REST };
        let only = Transform {
            translation: [7.0, 0.0, 0.0],
            rotation: [0.0, 1.0, 0.0, 0.0],
            scale: [4.0, 5.0, 6.0],
        };
        let of = |time: &Option<f32>| {
            let t = time.unwrap_or(1.0);
            let jumping = if t < 0.5 { 8.0 * t } else { 4.0 + 8.0 * t };
            let late = 1.0 + 4.0 * (t.clamp(0.25, 0.75) - 0.25);
            [REST, only, at(jumping), turned(0.0), turned(PI / 2.0 * t), at(late)]
        };
        self.times.iter().flat_map(of).collect()
    }
}
