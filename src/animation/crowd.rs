//! What a crowd has on the device: the clips that it plays, and for each instance its places, local transforms and
//! palette.

use super::clip_set::{ClipEntry, ClipSet, SetTrack, Timeline};
use super::place::{Instance, Place};
use super::transform::{Affine, Transform};
use crate::gpu::{Buffer, Gpu, GpuError};

/// A local transform as kernels keep it: translation and scale x; rotation; scale y and z, and two words that mean
/// nothing.
pub type Local = [[f32; 4]; 3];

/// A transform as kernels keep it.
pub fn packed(transform: &Transform) -> Local {
    let ([x, y, z], [sx, sy, sz]) = (transform.translation, transform.scale);
    [[x, y, z, sx], transform.rotation, [sy, sz, 0.0, 0.0]]
}

/// The transform that kernels keep so.
pub fn unpacked(local: &Local) -> Transform {
    let [[x, y, z, sx], rotation, [sy, sz, ..]] = *local;
    Transform { translation: [x, y, z], rotation, scale: [sx, sy, sz] }
}

/// A set of clips on the device.
#[derive(Debug, Clone)]
pub struct ClipBuffers {
    /// One a clip.
    pub clips: Buffer<ClipEntry>,
    /// Three a bone and clip.
    pub tracks: Buffer<SetTrack>,
    /// Clip by clip.
    pub timelines: Buffer<Timeline>,
    /// Seconds.
    pub times: Buffer<f32>,
    /// Of all tracks.
    pub values: Buffer<[f32; 4]>,
    /// Room that an instance needs for its places.
    pub timelines_a_clip: usize,
    /// Whether any track is a cubic spline.
    pub has_splines: bool,
}

impl ClipBuffers {
    /// Uploads a set.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, set: &ClipSet) -> Result<Self, GpuError> {
        Ok(Self {
            clips: Buffer::from_slice(gpu, "clips", set.clips())?,
            tracks: Buffer::from_slice(gpu, "tracks", set.tracks())?,
            timelines: Buffer::from_slice(gpu, "timelines", set.timelines())?,
            times: Buffer::from_slice(gpu, "times", set.times())?,
            values: Buffer::from_slice(gpu, "values", set.values())?,
            timelines_a_clip: set.timelines_a_clip(),
            has_splines: set.has_splines(),
        })
    }
}

/// Instances of one skeleton on the device. All buffers may be read and bound by the caller.
#[derive(Debug, Clone)]
pub struct Crowd {
    /// What each plays. May be rewritten; clips must stay below the set's number.
    pub instances: Buffer<Instance>,
    /// Written by [`super::place::PlacePass`]: the set's [`ClipSet::timelines_a_clip`] an instance.
    pub places: Buffer<Place>,
    /// Written by [`super::sample::SamplePass`]: `instance · bones + bone`.
    pub locals: Buffer<Local>,
    /// Written by [`super::concat::ConcatPass`]: `instance · bones + bone`.
    pub models: Buffer<Affine>,
    /// Bones of the skeleton.
    pub bones: usize,
}

impl Crowd {
    /// Bones of all instances.
    pub fn pairs(&self) -> usize {
        self.instances.len() * self.bones
    }
}
