//! A directional light, and Lambertian shading with it (`wgsl/light.wgsl`).

use glam::Vec3;

use crate::InputError;

/// A directional light with linear colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Direction towards the light, in world space, of any non-zero length.
    pub direction: Vec3,
    /// Linear red, green and blue of the light, each at least 0. The colour scales all reflected light, including the ambient
    /// part. Under white light (1, 1, 1), a surface that faces the light shows its own colour.
    pub color: Vec3,
    /// Fraction of the light that surfaces receive when they face away, 0 to 1.
    pub ambient: f32,
}

impl Default for Light {
    fn default() -> Self {
        Self { direction: Vec3::new(-0.4, 0.8, 0.6), color: Vec3::ONE, ambient: 0.12 }
    }
}

impl Light {
    /// Checks that all fields are in their ranges.
    ///
    /// # Errors
    /// [`InputError`] that names the first field out of range.
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

/// Light that a Lambertian surface reflects to the eye, as a fraction of the surface's albedo. `direct`, 0 to 1, is the cosine
/// of the light's angle of incidence, reduced in shadow. `ambient`, 0 to 1, is the result for a `direct` of 0.
pub fn lambert(ambient: f32, direct: f32) -> f32 {
    ambient + (1.0 - ambient) * direct
}
