//! Computes the pose of a skeleton on the device, as a crowd of one instance.

use relievo::Error;
use relievo::asset::{Clip, Skeleton};
use relievo::gpu::Gpu;
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd, unpacked};
use relievo::ops::animation::keyframe_cursor::KeyframeCursorPass;
use relievo::ops::animation::local_to_model::LocalToModelPass;
use relievo::ops::animation::sample::SamplePass;
use relievo::ops::animation::{Instance, Pose, RotationPath, Wrap};

/// As [`Pose::on_host`], on the device; the results are equal within rounding. Waits for the device.
///
/// # Errors
/// [`relievo::InputError`] for a clip of another skeleton; [`relievo::gpu::GpuError`] for errors of the device.
pub fn pose(gpu: &Gpu, skeleton: &Skeleton, clip: &Clip, time: f32) -> Result<Pose, Error> {
    let set = ClipSet::new(&[clip])?;
    let clips = ClipBuffers::new(gpu, &set)?;
    // The time is inside the clip already; clamping keeps the clip's end apart from its start.
    let crowd = Crowd::new(gpu, &set, &[Instance::new(0, Wrap::Clamp, time, 0.0)])?;
    let cursors = KeyframeCursorPass::new(gpu)?.prepare(gpu, &clips, &crowd)?;
    let sample = SamplePass::new(gpu, RotationPath::Slerp)?.prepare(gpu, &clips, &crowd)?;
    let local_to_model = LocalToModelPass::new(gpu)?.prepare(gpu, skeleton, &crowd)?;
    gpu.run("pose", |encoder| {
        cursors.record(encoder);
        sample.record(encoder);
        local_to_model.record(encoder);
    })?;
    let locals = crowd.locals.read_blocking(gpu)?.iter().map(unpacked).collect();
    Ok(Pose { locals, model_matrices: crowd.model_matrices().read_blocking(gpu)? })
}
