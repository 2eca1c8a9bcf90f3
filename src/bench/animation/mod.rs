//! Benchmarks of `kernels/animation/`: crowds of the creature's 153 bones that play a clip with 60 keys for each
//! part of each bone, every instance at a time of its own.

pub mod bounds;
pub mod budget;
pub mod compact;
pub mod concat;
pub mod gate;
pub mod phase;
pub mod place;
pub mod sample;

use crate::Error;
use crate::animation::clip::{BoneKeys, Clip, Interpolation, Keys};
use crate::animation::clip_set::ClipSet;
use crate::animation::concat::Order;
use crate::animation::creature;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::place::Instance;
use crate::animation::priority::{Priorities, USER_DEFAULT, Weights};
use crate::animation::sample::{RotationPath, Wrap};
use crate::animation::skeleton::Skeleton;
use crate::gpu::Gpu;
use crate::reference::animation::sample::sample;

/// Instances of the cases.
const CROWDS: [usize; 3] = [100, 1000, 10_000];

/// Keys of each part.
const KEYS: usize = 60;

/// A crowd, on the host and the device.
struct Scene {
    skeleton: Skeleton,
    clip: Clip,
    set: ClipSet,
    instances: Vec<Instance>,
    clips: ClipBuffers,
    crowd: Crowd,
}

impl Scene {
    fn new(gpu: &Gpu, count: usize) -> Result<Self, Error> {
        let model = creature()?;
        let clip = dense(&model.skeleton, &model.clips[0])?;
        let set = ClipSet::new(&[&clip])?;
        // Fractions of the golden ratio: never two the same.
        let start = |index: usize| (index as f32 * 0.618_034).fract();
        let instances: Vec<_> = (0..count).map(|i| Instance::new(0, Wrap::Loop, start(i), 1.0)).collect();
        let (clips, crowd) = (ClipBuffers::new(gpu, &set)?, Crowd::new(gpu, &set, &instances)?);
        Ok(Self { skeleton: model.skeleton, clip, set, instances, clips, crowd })
    }

    fn pairs(&self) -> usize {
        self.crowd.pairs()
    }

    fn order(&self) -> Order {
        Order::new(&self.skeleton)
    }

    fn priorities(&self) -> Result<Priorities, Error> {
        let user = vec![USER_DEFAULT; self.skeleton.len()];
        Ok(Priorities::new(&self.skeleton, &self.clip, true, &Weights::default(), &user)?)
    }
}

/// The clip with keys on every part of every bone.
fn dense(skeleton: &Skeleton, clip: &Clip) -> Result<Clip, Error> {
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
