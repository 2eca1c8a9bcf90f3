//! Helpers of the parity and benchmark cases of `kernels/animation/`.

pub mod bounds;
pub mod budget;
pub mod clip_clock;
pub mod compact;
pub mod drive;
pub mod edges;
pub mod frame;
pub mod gate;
#[cfg(not(target_arch = "wasm32"))]
pub mod host;
pub mod keyframe_cursor;
pub mod local_to_model;
pub mod plain_soa;
pub mod sample;
pub mod scene;

use relievo::InputError;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::skeleton::{Bone, Skeleton};
use relievo::asset::transform::Transform;
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::instance::{Instance, Wrap};

use crate::cases::terrain::random_words;

/// Random numbers, the same on every machine.
pub struct Draw(std::vec::IntoIter<u32>, u32);

impl Draw {
    /// The random numbers of a test case.
    pub fn new(case: u32) -> Self {
        Self(Vec::new().into_iter(), case << 16)
    }

    /// A random word.
    pub fn word(&mut self) -> u32 {
        loop {
            if let Some(word) = self.0.next() {
                return word;
            }
            self.1 += 1;
            self.0 = random_words(self.1, 1024).into_iter();
        }
    }

    /// A number from −1 to 1, in steps that `f32` represents exactly.
    pub fn signed(&mut self) -> f32 {
        (self.word() >> 8) as f32 / 8_388_608.0 - 1.0
    }

    /// A random quaternion.
    pub fn rotation(&mut self) -> [f32; 4] {
        loop {
            let q = [0; 4].map(|_| self.signed());
            if q.iter().map(|x| x * x).sum::<f32>() > 0.01 {
                return q;
            }
        }
    }
}

/// A random skeleton: some bones form a chain, others have any bone before them as their parent.
///
/// # Errors
/// None in practice: the skeleton is checked like any other.
pub fn random_skeleton(case: u32, bones: usize) -> Result<Skeleton, InputError> {
    let mut draw = Draw::new(case);
    let bone = |index: usize| {
        let parent = match (index as u32, draw.word()) {
            (0, _) => None,
            (index, word) if word % 4 != 0 => Some(index - 1),
            (_, word) if word % 64 == 0 => None,
            (index, word) => Some((word >> 8) % index),
        };
        let translation = [0; 3].map(|_| draw.signed());
        let rest = Transform { translation, rotation: draw.rotation(), scale: [1.0, 1.25, -0.75] };
        Bone { name: format!("bone {index}"), parent, rest }
    };
    Skeleton::of_joints((0..bones).map(bone).collect())
}

/// Random clips with every interpolation; one key or many; shared times and own ones; even, uneven and repeated
/// times; parts without keys. The last clip lasts 0 seconds.
///
/// # Errors
/// None in practice: the clips are checked like any others.
pub fn random_clips(case: u32, skeleton: &Skeleton, clips: usize) -> Result<Vec<Clip>, InputError> {
    let mut draw = Draw::new(case ^ 0x0a11);
    let clip = |index: usize| {
        let shared = times(&mut draw, 0, index + 1 == clips);
        let bones: Vec<BoneKeys> = (0..skeleton.len())
            .map(|_| BoneKeys {
                translation: keys(&mut draw, &shared, false),
                rotation: keys(&mut draw, &shared, true),
                scale: keys(&mut draw, &shared, false),
            })
            .collect();
        Clip::new(format!("clip {index}"), skeleton, &bones, 0.0)
    };
    (0..clips).map(clip).collect()
}

/// Random key times, in steps of 1/64 s.
pub(crate) fn times(draw: &mut Draw, kind: u32, at_once: bool) -> Vec<f32> {
    let count = [2, 3, 17, 60][draw.word() as usize % 4];
    let mut time = 0;
    let steps = (0..count).map(|_| {
        let here = time;
        time += match kind {
            _ if at_once => 0,
            0 => 2,
            _ => [0, 1, 1, 3, 20][draw.word() as usize % 5],
        };
        here as f32 / 64.0
    });
    steps.collect()
}

pub(crate) fn keys(draw: &mut Draw, shared: &[f32], is_rotation: bool) -> Option<Keys> {
    let at_once = shared.last() == Some(&0.0);
    let times = match draw.word() % 8 {
        0 => return None,
        1 => vec![0.25 * f32::from(!at_once)],
        2 => times(draw, 1, at_once),
        _ => shared.to_vec(),
    };
    let interpolation =
        [Interpolation::Step, Interpolation::Linear, Interpolation::Linear, Interpolation::CubicSpline]
            [draw.word() as usize % 4];
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let value =
        |_| if is_rotation { draw.rotation() } else { [draw.signed(), draw.signed(), draw.signed(), 0.0] };
    let values = (0..each * times.len()).map(value).collect();
    Some(Keys { times, values, interpolation })
}

/// Random instances, forwards and backwards, at times from −64 to 64 s in steps of 2⁻²⁰ s. These take 26 bits,
/// so that not all are exact.
pub fn random_instances(case: u32, set: &ClipSet, count: usize) -> Vec<Instance> {
    let mut draw = Draw::new(case ^ 0x1257);
    let instance = |_| {
        let clip = draw.word() % set.clips().len() as u32;
        let wrap = if draw.word().is_multiple_of(2) { Wrap::Loop } else { Wrap::Clamp };
        // Half of them start close to the clip.
        let latest = if draw.word().is_multiple_of(2) { 60.0 } else { 2.0 };
        let rate = [1.0, -1.0, 0.5, 1.75][draw.word() as usize % 4];
        Instance::new(clip, wrap, draw.signed() * latest, rate)
    };
    (0..count).map(instance).collect()
}

/// A random skeleton, a set of three random clips, and instances that play them.
///
/// # Errors
/// None in practice: they are checked like any others.
pub fn random_crowd(
    case: u32,
    bones: usize,
    instances: usize,
) -> Result<(Skeleton, ClipSet, Vec<Instance>), InputError> {
    crowd_of(case, random_skeleton(case, bones)?, instances)
}

/// The crowd of [`random_crowd`], with a skeleton of two tiers in odd cases.
///
/// # Errors
/// None in practice.
pub(crate) fn tiered_crowd(
    case: u32,
    bones: usize,
    instances: usize,
) -> Result<(Skeleton, ClipSet, Vec<Instance>), InputError> {
    crowd_of(case, tiered_skeleton(case, bones)?, instances)
}

/// A skeleton, a set of three random clips, and instances that play them.
fn crowd_of(
    case: u32,
    skeleton: Skeleton,
    instances: usize,
) -> Result<(Skeleton, ClipSet, Vec<Instance>), InputError> {
    let clips = random_clips(case, &skeleton, 3)?;
    let set = ClipSet::new(&clips.iter().collect::<Vec<_>>())?;
    let instances = random_instances(case, &set, instances);
    Ok((skeleton, set, instances))
}

/// A random skeleton; in odd cases with a second tier, which has half of the bones.
///
/// # Errors
/// None in practice.
pub(crate) fn tiered_skeleton(case: u32, bones: usize) -> Result<Skeleton, InputError> {
    if bones < 2 || case.is_multiple_of(2) {
        return random_skeleton(case, bones);
    }
    random_skeleton(case, bones - bones / 2)?.with_tier(&random_skeleton(case + 1, bones / 2)?)
}

/// Numbers of bones and instances around every workgroup boundary.
pub(crate) const SIZES: [[usize; 2]; 16] = [
    [1, 1],
    [1, 64],
    [1, 65],
    [2, 31],
    [7, 9],
    [63, 1],
    [64, 3],
    [65, 2],
    [153, 40],
    [1000, 3],
    [3, 63],
    [2, 64],
    [3, 65],
    [1, 127],
    [2, 128],
    [3, 129],
];
