//! Poses computed on the host: the transforms of a skeleton at one time of a clip.

use super::local_to_model::reference::local_to_model;
use super::sample::reference::sample;
use crate::InputError;
use crate::asset::keyframe::RotationPath;
use crate::asset::{Affine, Clip, Skeleton, Transform};

/// Transforms of all bones of a skeleton at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    /// Transform of each bone in its parent's space.
    pub locals: Vec<Transform>,
    /// Model matrix of each bone, which maps the bone's space to model space.
    pub model_matrices: Vec<Affine>,
}

impl Pose {
    /// Samples a clip on the host, with slerp between rotation keys. `time` is in seconds inside the clip
    /// ([`Wrap::inside`](super::Wrap::inside)).
    pub fn on_host(skeleton: &Skeleton, clip: &Clip, time: f32) -> Self {
        let locals = sample(clip, time, RotationPath::Slerp);
        Self { model_matrices: local_to_model(skeleton, &locals), locals }
    }

    /// Returns an error if a model matrix contains values that are not finite. Long chains of bones with large scales exceed the
    /// range of `f32`.
    ///
    /// # Errors
    /// [`InputError`] that names the first such bone.
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
