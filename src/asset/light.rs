//! A directional light, and what a matt surface makes of it (`wgsl/light.wgsl`).

use glam::Vec3;

use crate::InputError;

/// A directional light, in linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// The direction towards the light, in the world, of any length but 0.
    pub direction: Vec3,
    /// Its colour: red, green and blue in linear light, each at least 0. It is the factor of all that surfaces send back, of
    /// the ambient part too. White of 1 shows a surface that faces the light in its own colour.
    pub color: Vec3,
    /// Light that surfaces facing away still receive, 0 to 1.
    pub ambient: f32,
}

impl Default for Light {
    fn default() -> Self {
        Self { direction: Vec3::new(-0.4, 0.8, 0.6), color: Vec3::ONE, ambient: 0.12 }
    }
}

impl Light {
    /// Checks the ranges.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self) -> Result<(), InputError> {
        if self.direction.try_normalize().is_none() {
            let value = self.direction.to_string();
            return Err(InputError::new("light.direction", value, "must be finite and not 0"));
        }
        if !self.color.to_array().iter().all(|channel| (0.0..f32::INFINITY).contains(channel)) {
            let value = self.color.to_string();
            return Err(InputError::new("light.color", value, "must be finite and at least 0"));
        }
        InputError::check_within("light.ambient", self.ambient, 0.0..=1.0)
    }
}

/// The fraction of its albedo that a matt surface sends to the eye, after Lambert: `direct`, 0 to 1, is the cosine at
/// which the light falls on it, less where it lies in shadow; `ambient`, 0 to 1, is what it gets without.
pub fn lambert(ambient: f32, direct: f32) -> f32 {
    ambient + (1.0 - ambient) * direct
}
