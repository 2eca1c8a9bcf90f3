//! What chooses the level of an instance: a metric, and a threshold for each level. The CPU reference of
//! `wgsl/lod/criterion.wgsl`.

use glam::Vec3;

use super::{LodCamera, LodObject};
use crate::shared::lod::criterion::{CRITERION_DISTANCE, CRITERION_ERROR};
use crate::shared::lod::object::object_flags_criterion;

/// What chooses the levels of an object.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Criterion {
    /// The projected error: the coarsest level whose error a view allows. It alone keeps the promise of
    /// [`Quality::pixels`](crate::scene::Quality).
    #[default]
    Error,
    /// The distance from the eye: each level from so many world units on, ascending from 0.
    Distance([f32; 8]),
}

impl Criterion {
    /// Its code in an object's flags.
    pub fn code(self) -> u32 {
        match self {
            Self::Error => CRITERION_ERROR,
            Self::Distance(_) => CRITERION_DISTANCE,
        }
    }

    /// The metric from which on each level is drawn, from the errors of the levels, ascending from 0.
    pub fn thresholds(self, errors: &[f32]) -> Vec<f32> {
        match self {
            Self::Error => errors.to_vec(),
            Self::Distance(from) => from[..errors.len()].to_vec(),
        }
    }
}

/// The metric of an instance in a camera that allows it a displacement in the model's units; `center` is that of its sphere.
pub fn metric(object: &LodObject, camera: &LodCamera, center: Vec3, allowed: f32) -> f32 {
    if object_flags_criterion(object.flags) == CRITERION_DISTANCE {
        return center.distance(camera.eye);
    }
    object.mesh_fraction * allowed
}
