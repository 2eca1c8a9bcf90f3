//! Selection of an instance's level of detail by a metric and a threshold per level. CPU reference of
//! `wgsl/lod/criterion.wgsl`.

use glam::Vec3;

use super::{LodCamera, LodObject};
#[cfg(feature = "gpu")]
use crate::shared::lod::criterion::CRITERION_ERROR;

/// The metric by which an object's levels are chosen.
#[cfg(feature = "gpu")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Criterion {
    /// The projected error: the coarsest level whose error the view allows. Only this criterion keeps the promise of
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

    /// Threshold per level: the smallest metric at which the level is drawn. Input: errors per level, ascending from 0.
    pub fn thresholds(self, errors: &[f32]) -> Vec<f32> {
        match self {
            Self::Error => errors.to_vec(),
        }
    }
}

/// The metric of an instance in a camera. `allowed` is the allowed displacement in the model's units, `center` the
/// center of its sphere.
pub fn metric(object: &LodObject, _camera: &LodCamera, _center: Vec3, allowed: f32) -> f32 {
    object.mesh_fraction * allowed
}
