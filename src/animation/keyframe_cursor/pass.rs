//! The GPU pass of `kernels/animation/keyframe_cursor.wgsl`.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::gate_state::GateState;
use crate::animation::instance::check_elapsed;
use crate::asset::keyframe::KeyframeCursor;
use crate::gpu::bind::SeenAs;
use crate::gpu::bindings::animation::keyframe_cursor as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Kernel, ParamsJob, Step, Uniform, Upload};
use crate::shared::animation::clip;
use crate::shared::animation::keyframe_cursor::KeyframeCursorParams;

impl SeenAs<clip::KeyframeCursor> for KeyframeCursor {}

/// Finds the keyframe cursors of a crowd's instances on the GPU.
#[derive(Debug, Clone)]
pub struct KeyframeCursorPass {
    all: Kernel,
    compacted: Kernel,
}

impl KeyframeCursorPass {
    /// Compiles the compute pipelines of this pass.
    ///
    /// # Errors
    /// [`GpuError`] for shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |compacted| bindings::kernel(gpu, &bindings::Constants { compacted });
        Ok(Self { all: kernel(false)?, compacted: kernel(true)? })
    }

    /// Prepares a job that finds the cursors of all instances of a crowd.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn prepare(&self, gpu: &Gpu, clips: &ClipBuffers, crowd: &Crowd) -> Result<KeyframeCursorJob, Error> {
        let params = KeyframeCursorParams::new(clips, crowd);
        let uniform = Uniform::new(gpu, "keyframe cursor", &params)?;
        let words = Buffer::new(gpu, "nothing", 0)?;
        let (dispatches, history) = (Buffer::new(gpu, "nothing", 1)?, Buffer::new(gpu, "nothing", 1)?);
        let listed = Listed { instances: &words, dispatches: &dispatches, history: &history };
        let group = bind(&self.all, gpu, &uniform, clips, crowd, &listed)?;
        let threads = params.entries * params.timelines;
        let job = Job::spread(gpu, "animation/keyframe_cursor", &self.all, group, threads)?;
        Ok(ParamsJob { params, uniform, job })
    }

    /// Prepares a job that finds the cursors of the instances with an active bone, at the times that the gate used. Record the
    /// job after `animation/compact`.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        clips: &ClipBuffers,
        crowd: &Crowd,
        state: &GateState,
        active: &Active,
    ) -> Result<KeyframeCursorJob, Error> {
        let params = KeyframeCursorParams::new(clips, crowd);
        let uniform = Uniform::new(gpu, "keyframe cursor", &params)?;
        let listed =
            Listed { instances: &active.instances, dispatches: &active.dispatches, history: &state.history };
        let group = bind(&self.compacted, gpu, &uniform, clips, crowd, &listed)?;
        let offset = 16 * (active.dispatches.len() as u64 - 1);
        let step = Step::indirect(&self.compacted, group, active.dispatches.raw(), offset);
        let job = Job::new(gpu, "animation/keyframe_cursor", vec![step])?;
        Ok(ParamsJob { params, uniform, job })
    }
}

impl KeyframeCursorParams {
    fn new(clips: &ClipBuffers, crowd: &Crowd) -> Self {
        Self {
            entries: crowd.instances.len() as u32,
            instances: crowd.len() as u32,
            timelines: clips.timelines_a_clip as u32,
            elapsed: 0.0,
        }
    }
}

/// Buffers with the list of instances to process, for a job that handles active instances only.
struct Listed<'a> {
    instances: &'a Buffer<u32>,
    dispatches: &'a Buffer<[u32; 4]>,
    history: &'a Buffer<[u32; 4]>,
}

fn bind(
    kernel: &Kernel,
    gpu: &Gpu,
    uniform: &Uniform<KeyframeCursorParams>,
    clips: &ClipBuffers,
    crowd: &Crowd,
    listed: &Listed<'_>,
) -> Result<Group, GpuError> {
    let group = bindings::Group {
        params: uniform,
        instances: crowd.instances.slice(),
        clips: clips.clips.slice(),
        timelines: clips.timelines.slice(),
        times: clips.times.slice(),
        cursors: crowd.cursors.slice().cast(),
        updated_instances: listed.instances.slice(),
        dispatches: listed.dispatches.slice(),
        history: listed.history.slice(),
    };
    group.bind(gpu, kernel)
}

/// A prepared computation of cursors. In each frame, set the time, then record.
pub type KeyframeCursorJob = ParamsJob<KeyframeCursorParams>;

impl KeyframeCursorJob {
    /// Sets the time in seconds for the next submission. At `elapsed` 0, each instance is at the clip time `start`. Every few
    /// minutes, restart `elapsed` at 0 and give the instances new starts, because `f32` seconds lose precision.
    ///
    /// # Errors
    /// [`crate::InputError`] if `elapsed` is not within ±[`MAX_SECONDS`](crate::animation::instance::MAX_SECONDS); [`GpuError`]
    /// for errors of the device.
    pub fn set(&self, gpu: &Gpu, elapsed: f32) -> Result<(), Error> {
        self.set_through(&mut &*gpu, elapsed)
    }

    /// Does the same as [`KeyframeCursorJob::set`], but writes through `upload`. With [`Staged`](crate::gpu::Staged) writes, one
    /// submission may contain several frames.
    ///
    /// # Errors
    /// Same as [`KeyframeCursorJob::set`].
    pub fn set_through(&self, upload: &mut impl Upload, elapsed: f32) -> Result<(), Error> {
        check_elapsed(elapsed)?;
        Ok(upload.uniform(&self.uniform, &KeyframeCursorParams { elapsed, ..self.params })?)
    }
}
