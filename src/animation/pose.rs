//! Where every bone is at a moment of a clip, on the host or, as a crowd of one, on the device.

use super::local_to_model::reference::local_to_model;
use super::sample::reference::sample;
use crate::InputError;
use crate::asset::keyframe::RotationPath;
use crate::asset::{Affine, Clip, Skeleton, Transform};
#[cfg(feature = "gpu")]
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

/// The transforms of all bones at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    /// In the space of each bone's parent.
    pub locals: Vec<Transform>,
    /// In the model's space.
    pub model_matrices: Vec<Affine>,
}

impl Pose {
    /// The pose at a time inside a clip ([`Wrap::inside`](super::Wrap::inside)).
    pub fn on_host(skeleton: &Skeleton, clip: &Clip, time: f32) -> Self {
        let locals = sample(clip, time, RotationPath::Slerp);
        Self { model_matrices: local_to_model(skeleton, &locals), locals }
    }

    /// The same, equal within rounding. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for a clip of another skeleton; [`crate::gpu::GpuError`].
    #[cfg(feature = "gpu")]
    pub fn on_device(gpu: &Gpu, skeleton: &Skeleton, clip: &Clip, time: f32) -> Result<Self, Error> {
        let crowd = posed(gpu, skeleton, clip, time)?;
        let locals = crowd.locals.read_blocking(gpu)?.iter().map(unpacked).collect();
        Ok(Self { locals, model_matrices: crowd.model_matrices().read_blocking(gpu)? })
    }

    /// Refuses model matrices that chains of large scales have driven out of the range of `f32`.
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

/// A crowd of one, sampled and concatenated at a time inside a clip.
#[cfg(feature = "gpu")]
pub(crate) fn posed(gpu: &Gpu, skeleton: &Skeleton, clip: &Clip, time: f32) -> Result<Crowd, Error> {
    let set = ClipSet::new(&[clip])?;
    let clips = ClipBuffers::new(gpu, &set)?;
    // The time is inside the clip already, and its end is not its start here.
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
