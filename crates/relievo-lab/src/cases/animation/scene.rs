//! The crowds of the benchmarks of `kernels/animation/`: instances of the creature, with 153 bones, that play a clip
//! with 60 keys for each part of each bone, every instance at a time of its own.

use relievo::Error;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::keyframe::{KeyframeCursor, RotationPath};
use relievo::asset::skeleton::Skeleton;
use relievo::gpu::{Gpu, Job};
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::instance::{Instance, Wrap};
use relievo::ops::animation::keyframe_cursor::reference::cursors;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::sample::reference::sample;
use relievo_samples::creature;

use crate::baseline::gather::{GatherPass, Reads};
use crate::cases::terrain::copy_of;

/// Numbers of instances of the cases.
pub(crate) const CROWDS: [usize; 3] = [100, 1000, 10_000];

/// Number of keys of each part.
pub(crate) const KEYS: usize = 60;

/// The time of the frames, in seconds.
pub(crate) const ELAPSED: f32 = 0.4;

/// A crowd on the host and on the device, with its cursors.
pub(crate) struct Scene {
    pub skeleton: Skeleton,
    pub clip: Clip,
    pub set: ClipSet,
    pub instances: Vec<Instance>,
    pub cursors: Vec<KeyframeCursor>,
    pub clips: ClipBuffers,
    pub crowd: Crowd,
}

impl Scene {
    pub(crate) fn new(gpu: &Gpu, count: usize) -> Result<Self, Error> {
        let (skeleton, clip, set) = dense_creature()?;
        let instances = crowd(count);
        let cursors = cursors(&set, &instances, ELAPSED);
        let (clips, crowd) = (ClipBuffers::new(gpu, &set)?, Crowd::new(gpu, &set, &instances)?);
        crowd.cursors.write(gpu, &cursors)?;
        Ok(Self { skeleton, clip, set, instances, cursors, clips, crowd })
    }

    pub(crate) fn pairs(&self) -> usize {
        self.crowd.pairs()
    }

    pub(crate) fn order(&self) -> Order {
        Order::new(&self.skeleton)
    }

    /// A job that moves what sampling reads and writes.
    pub(crate) fn gathered(&self, gpu: &Gpu, reads: Reads) -> Result<Job, Error> {
        GatherPass::new(gpu, reads)?.prepare(gpu, &self.clips, &self.crowd)
    }

    /// A job that moves the words of concatenation: it reads 10 and writes 12 per bone.
    pub(crate) fn copied(&self, gpu: &Gpu) -> Result<Job, Error> {
        copy_of(gpu, 11 * self.pairs())
    }
}

/// Instances that play the first clip, no two at the same time: their offsets are multiples of the golden
/// ratio.
pub(crate) fn crowd(count: usize) -> Vec<Instance> {
    let start = |index: usize| (index as f32 * 0.618_034).fract();
    (0..count).map(|i| Instance::new(0, Wrap::Loop, start(i), 1.0)).collect()
}

/// The creature, its first clip with keys on every part, and a set with that clip.
pub(crate) fn dense_creature() -> Result<(Skeleton, Clip, ClipSet), Error> {
    let model = creature()?;
    let clip = dense(&model.skeleton, &model.clips[0])?;
    let set = ClipSet::new(&[&clip])?;
    Ok((model.skeleton, clip, set))
}

/// The clip resampled so that every part of every bone has keys.
pub(crate) fn dense(skeleton: &Skeleton, clip: &Clip) -> Result<Clip, Error> {
    let times: Vec<f32> = (0..KEYS).map(|key| clip.duration() * key as f32 / (KEYS - 1) as f32).collect();
    let poses: Vec<_> = times.iter().map(|time| sample(clip, *time, RotationPath::Slerp)).collect();
    let bones = (0..skeleton.len()).map(|bone| {
        let keys = |value: &dyn Fn(usize) -> [f32; 4]| {
            let values = (0..KEYS).map(value).collect();
            Some(Keys { times: times.clone(), values, interpolation: Interpolation::Linear })
        };
        let vector = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        BoneKeys {
            translation: keys(&|key| vector(poses[key][bone].translation)),
            rotation: keys(&|key| poses[key][bone].rotation),
            scale: keys(&|key| vector(poses[key][bone].scale)),
        }
    });
    Ok(Clip::new("dense", skeleton, &bones.collect::<Vec<_>>(), 0.0)?)
}
