//! What chooses the level of an instance: a metric, and a threshold for each level. The CPU reference of
//! `wgsl/lod/criterion.wgsl`.

use glam::Vec3;

use super::{LodCamera, LodObject};
#[cfg(feature = "gpu")]
use crate::shared::lod::criterion::CRITERION_ERROR;

/// What chooses the levels of an object.
#[cfg(feature = "gpu")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Criterion {
    /// The projected error: the coarsest level whose error a view allows. It alone keeps the promise of
    /// [`Quality::pixels`](crate::scene::Quality).
    #[default]
    Error,
}

#[cfg(feature = "gpu")]
impl Criterion {
    /// Its code in an object's flags.
    pub fn code(self) -> u32 {
        match self {
            Self::Error => CRITERION_ERROR,
        }
    }

    /// The metric from which on each level is drawn, from the errors of the levels, ascending from 0.
    pub fn thresholds(self, errors: &[f32]) -> Vec<f32> {
        match self {
            Self::Error => errors.to_vec(),
        }
    }
}

/// The metric of an instance in a camera that allows it a displacement in the model's units; `center` is that of its sphere.
pub fn metric(object: &LodObject, _camera: &LodCamera, _center: Vec3, allowed: f32) -> f32 {
    object.mesh_fraction * allowed
}
