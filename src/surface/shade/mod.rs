//! Shading of points of a relief: hard and soft self-shadow, and the depth that is written for them (B section
//! 3.1.2).
//!
//! Material shaders import the functions from `wgsl/surface/`; `relievo shaders` writes them as flat WGSL. The
//! kernel of this folder runs them on lists of points.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::ShadePass;

use glam::{Mat4, Vec4};

use crate::InputError;
use crate::surface::relief::{Hit, MAX_STEPS, Ray};

/// The view and shadow parameters that all points of a list share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadeView {
    /// The matrix from world space to clip space, depth 0 to 1.
    pub clip_from_world: Mat4,
    /// The position of the eye with w = 1, or for a parallel projection the direction towards it with w = 0;
    /// world space.
    pub eye: Vec4,
    /// Number of heights that a soft shadow samples on the way to the light, 1 to [`MAX_STEPS`].
    pub shadow_steps: u32,
    /// The ratio of the surface's height above the way to the light to its distance at which a soft shadow is
    /// full; 0.001 to 1000.
    pub softness: f32,
}

impl Default for ShadeView {
    /// A parallel view straight from above, in which the depth of a point is −z, with the shadows of
    /// [`Material`](super::Material)'s default.
    fn default() -> Self {
        let clip_from_world = Mat4::from_scale(glam::Vec3::new(1.0, 1.0, -1.0));
        let material = super::Material::default();
        Self {
            clip_from_world,
            eye: Vec4::Z,
            shadow_steps: material.shadow_steps,
            softness: material.softness,
        }
    }
}

impl ShadeView {
    /// Refuses values out of bounds.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn validate(&self) -> Result<(), InputError> {
        if !self.clip_from_world.is_finite() {
            let value = format!("{:?}", self.clip_from_world.to_cols_array());
            return Err(InputError::new("clip_from_world", value, "must be finite"));
        }
        if !self.eye.is_finite() {
            return Err(InputError::new("eye", self.eye, "must be finite"));
        }
        if !(1..=MAX_STEPS).contains(&self.shadow_steps) {
            let bound = format!("must be in 1..={MAX_STEPS}");
            return Err(InputError::new("shadow_steps", self.shadow_steps, bound));
        }
        if !(1e-3..=1e3).contains(&self.softness) {
            return Err(InputError::new("softness", self.softness, "must be in 0.001..=1000"));
        }
        Ok(())
    }
}

/// A point of a relief where an eye's ray met it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct ShadePoint {
    /// Unit vector towards the light, in tangent space.
    pub light: [f32; 3],
    /// Depth of the relief in uv units.
    pub scale: f32,
    /// The point where the eye's ray meets the polygon, in world space.
    pub position: [f32; 3],
    /// World units per uv unit.
    pub world: f32,
    /// The eye's ray.
    pub ray: Ray,
    /// The hit of that ray.
    pub hit: Hit,
}

/// The shading of a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Shade {
    /// 1 if the light's ray ends in the point, else 0.
    pub hard: f32,
    /// Light with penumbras, 0 in full shadow to 1 in full light.
    pub soft: f32,
    /// Depth of the relief at the point, 0 (near) to 1 (far).
    pub depth: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_out_of_bounds_are_refused() {
        let good = ShadeView::default();
        let field = |view: ShadeView| view.validate().expect_err("refused").path;
        assert_eq!(field(ShadeView { clip_from_world: Mat4::NAN, ..good }), "clip_from_world");
        assert_eq!(field(ShadeView { eye: Vec4::INFINITY, ..good }), "eye");
        for shadow_steps in [0, MAX_STEPS + 1] {
            assert_eq!(field(ShadeView { shadow_steps, ..good }), "shadow_steps");
        }
        for softness in [0.0, 2e3, f32::NAN] {
            assert_eq!(field(ShadeView { softness, ..good }), "softness");
        }
        assert_eq!(good.validate(), Ok(()));
    }
}
