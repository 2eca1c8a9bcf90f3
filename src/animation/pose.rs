//! Computes the pose of a skeleton at one time of a clip, on the host or, as a crowd of one instance, on the
//! device.

use super::local_to_model::reference::local_to_model;
use super::sample::reference::sample;
use crate::InputError;
use crate::asset::keyframe::RotationPath;
use crate::asset::{Affine, Clip, Skeleton, Transform};
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
use {
    super::clip_set::ClipSet,
    super::crowd::{ClipBuffers, Crowd, unpacked},
    super::instance::{Instance, Wrap},
    super::keyframe_cursor::KeyframeCursorPass,
    super::local_to_model::LocalToModelPass,
    super::sample::SamplePass,
    crate::Error,
    crate::gpu::Gpu,
};

/// The transforms of all bones at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    /// The transform of each bone in its parent's space.
    pub locals: Vec<Transform>,
    /// The model matrix of each bone: from the bone's space to the model's.
    pub model_matrices: Vec<Affine>,
}

impl Pose {
    /// Samples a clip at a time in seconds inside it ([`Wrap::inside`](super::Wrap::inside)), on the host.
    pub fn on_host(skeleton: &Skeleton, clip: &Clip, time: f32) -> Self {
        let locals = sample(clip, time, RotationPath::Slerp);
        Self { model_matrices: local_to_model(skeleton, &locals), locals }
    }

    /// As [`Pose::on_host`], on the device; the results are equal within rounding. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for a clip of another skeleton; [`crate::gpu::GpuError`] for errors of the device.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn on_device(gpu: &Gpu, skeleton: &Skeleton, clip: &Clip, time: f32) -> Result<Self, Error> {
        let crowd = posed(gpu, skeleton, clip, time)?;
        let locals = crowd.locals.read_blocking(gpu)?.iter().map(unpacked).collect();
        Ok(Self { locals, model_matrices: crowd.model_matrices().read_blocking(gpu)? })
    }

    /// Refuses model matrices with values outside the range of `f32`, as chains of large scales produce.
    ///
    /// # Errors
    /// [`InputError`] that names the bone.
    pub fn check_range(&self) -> Result<(), InputError> {
        let is_finite = |matrix: &Affine| matrix.iter().flatten().all(|value| value.is_finite());
        match self.model_matrices.iter().position(|matrix| !is_finite(matrix)) {
            None => Ok(()),
            Some(bone) => {
                let bound = "must fit f32: translations or scales are too large";
                let value = format!("{:?}", self.model_matrices[bone]);
                Err(InputError::new(format!("bones[{bone}].model"), value, bound))
            }
        }
    }
}

/// Samples and concatenates a crowd of one instance, at a time inside a clip.
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub(crate) fn posed(gpu: &Gpu, skeleton: &Skeleton, clip: &Clip, time: f32) -> Result<Crowd, Error> {
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
    Ok(crowd)
}
