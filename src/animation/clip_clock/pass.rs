//! The GPU pass of `kernels/animation/clip_clock.wgsl`.

use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::gate_state::GateState;
use crate::animation::instance::{check_elapsed, check_seconds};
use crate::gpu::bindings::animation::clip_clock as bindings;
use crate::gpu::{Gpu, Job, ParamsJob, Uniform, Upload, pass};
use crate::shared::animation::clip_clock::ClipClockParams;
use crate::{Error, InputError};

pass! {
    /// Computes the clip clock of each instance on the GPU.
    pub struct ClipClockPass;
}

impl ClipClockPass {
    /// Prepares a job that computes the clip clocks of a crowd.
    ///
    /// # Errors
    /// [`InputError`] if the number of clips differs from the crowd's; [`crate::gpu::GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        clips: &ClipBuffers,
        crowd: &Crowd,
        state: &GateState,
    ) -> Result<ClipClockJob, Error> {
        InputError::check_same("clips.len", clips.clips.len(), crowd.clips, "as the crowd's")?;
        let params = ClipClockParams {
            instances: state.lods.len() as u32,
            elapsed: 0.0,
            layers: crowd.layers as u32 - 1,
            ahead: 0.0,
        };
        let uniform = Uniform::new(gpu, "clip_clock", &params)?;
        let group = bindings::Group {
            params: &uniform,
            instances: crowd.instances.slice(),
            clips: clips.clips.slice(),
            timelines: clips.timelines.slice(),
            times: clips.times.slice(),
            lods: state.lods.slice(),
            layer_weights: crowd.layer_weights.slice(),
            history: state.history.slice(),
            clip_clocks: state.clip_clocks.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        let job = Job::spread(gpu, "animation/clip_clock", &self.kernel, group, params.instances)?;
        Ok(ParamsJob { params, uniform, job })
    }
}

/// A prepared computation of clip clocks. In each frame, set the time, then record.
pub type ClipClockJob = ParamsJob<ClipClockParams>;

impl ClipClockJob {
    /// Sets the times for the next submission, in seconds. `elapsed` is the crowd's time, as in
    /// [`super::super::keyframe_cursor::KeyframeCursorJob::set`]. `ahead` is how far bones may be sampled beyond the time
    /// `elapsed` ([`Frame::ahead`](crate::animation::gate::Frame::ahead)).
    ///
    /// # Errors
    /// [`InputError`] if a time is not within ±[`MAX_SECONDS`](crate::animation::instance::MAX_SECONDS);
    /// [`crate::gpu::GpuError`] for errors of the device.
    pub fn set(&self, gpu: &Gpu, elapsed: f32, ahead: f32) -> Result<(), Error> {
        self.set_through(&mut &*gpu, elapsed, ahead)
    }

    /// Does the same as [`ClipClockJob::set`], but writes through `upload`. With [`Staged`](crate::gpu::Staged) writes, one
    /// submission may contain several frames.
    ///
    /// # Errors
    /// Same as [`ClipClockJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, elapsed: f32, ahead: f32) -> Result<(), Error> {
        check_elapsed(elapsed)?;
        check_seconds("frame.ahead", ahead)?;
        Ok(upload.uniform(&self.uniform, &ClipClockParams { elapsed, ahead, ..self.params })?)
    }
}
