//! Reads of keys as sampling reads them, and its writes (`kernels/baseline/gather.wgsl`).

#[cfg(feature = "verify")]
pub mod bench;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::gpu::bindings::baseline::gather as bindings;
use crate::gpu::{Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::baseline::gather::GatherParams;
use crate::{Error, InputError};

/// What a copy of sampling's bytes reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reads {
    /// What sampling reads: 20 words of keys a bone, and the 9 that tell where they lie (the instance's clip, three
    /// tracks, a place).
    Everything,
    /// The keys, and the place: tracks lie evenly, this many values each.
    Keys(u32),
}

/// Moves the bytes of sampling: of each bone of each instance the two keys of three tracks around the instance's
/// place, tracks shared by instances as a clip's are, and a local transform (12 words).
#[derive(Debug, Clone)]
pub struct GatherPass {
    kernel: Kernel,
    reads: Reads,
}

impl GatherPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, reads: Reads) -> Result<Self, GpuError> {
        let constants = bindings::Constants { tables: reads == Reads::Everything };
        Ok(Self { kernel: bindings::kernel(gpu, &constants)?, reads })
    }

    /// Prepares a crowd that stands at its places, before the last keys. Overwrites its local transforms.
    ///
    /// # Errors
    /// [`InputError`] for a set whose clips have more than one timeline, and for fewer values than
    /// [`Reads::Keys`] needs; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, clips: &ClipBuffers, crowd: &Crowd) -> Result<Job, Error> {
        if clips.timelines_a_clip != 1 {
            let bound = "must be 1: a place an instance";
            return Err(InputError::new("clips.timelines_a_clip", clips.timelines_a_clip, bound).into());
        }
        let keys = if let Reads::Keys(keys) = self.reads { keys } else { 0 };
        clips.values.check_holds("clips.values", 3 * crowd.bones * keys as usize)?;
        let params = GatherParams { pairs: crowd.pairs() as u32, bones: crowd.bones as u32, keys };
        let uniform = Uniform::new(gpu, "gather", &params)?;
        let group = bindings::Group {
            params: &uniform,
            instances: crowd.instances.slice(),
            tracks: clips.tracks.slice().cast(),
            cursors: crowd.cursors.slice().cast(),
            values: clips.values.slice().cast(),
            gathered: crowd.locals.slice().cast(),
        };
        let step = Step {
            groups: vec![group.bind(gpu, &self.kernel)?],
            workgroups: self.kernel.spread(gpu, params.pairs),
            kernel: self.kernel.clone(),
        };
        Ok(Job::new(gpu, "baseline/gather", vec![step])?)
    }
}
