//! The GPU pass of `kernels/baseline/gather.wgsl`: moves the bytes that sampling moves.

use relievo::gpu::bindings::baseline::gather as bindings;
use relievo::gpu::{Gpu, GpuError, Job, Kernel, Uniform};
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::shared::baseline::gather::GatherParams;
use relievo::{Error, InputError};

use crate::baseline::gather::Reads;

/// Moves the bytes of sampling: for each bone of each instance it reads the two keys of three tracks around the
/// instance's cursor, where instances share the tracks of a clip, and writes a local transform (12 words).
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

    /// Prepares a crowd whose instances have cursors before their last keys. The kernel overwrites the crowd's
    /// local transforms.
    ///
    /// # Errors
    /// [`InputError`] for a set with a clip that has more than one timeline, and for fewer values than
    /// [`Reads::Keys`] needs; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, clips: &ClipBuffers, crowd: &Crowd) -> Result<Job, Error> {
        if clips.timelines_a_clip != 1 {
            let bound = "must be 1: a cursor an instance";
            return Err(InputError::new("clips.timelines_a_clip", clips.timelines_a_clip, bound).into());
        }
        let keys = if let Reads::Keys(keys) = self.reads { keys } else { 0 };
        clips.values.check_holds("clips.values", 3 * crowd.bones * keys as usize)?;
        let params = GatherParams { pairs: crowd.pairs() as u32, bones: crowd.bones as u32, keys };
        let uniform = Uniform::new(gpu, "gather", &params)?;
        let group = bindings::Group {
            params: &uniform,
            instances: crowd.instances.slice(),
            tracks: clips.tracks.slice(),
            cursors: crowd.cursors.slice().cast(),
            values: clips.values.slice().cast(),
            gathered: crowd.locals.slice().cast(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "baseline/gather", &self.kernel, group, params.pairs)?)
    }
}
