//! Shading of points of a relief: hard and soft self-shadow, and the depth that is written for them (B section
//! 3.1.2).
//!
//! Material shaders import the functions from `wgsl/surface/`; `relievo shaders` writes them as flat WGSL. The
//! kernel of this folder runs them on lists of points.

pub use pass::ShadePass;
pub use relievo::shared::surface::shade::{Shade, ShadePoint, ShadeView};

use glam::{Mat4, Vec3, Vec4};
use relievo::InputError;
use relievo::ops::surface::ReliefMaterial;
use relievo::ops::surface::relief::MAX_STEPS;

mod pass;
pub mod reference;
pub mod shadow;

/// A parallel view straight from above, in which the depth of a point is −z, with the shadows of
/// [`ReliefMaterial`]'s default.
pub fn from_above() -> ShadeView {
    let material = ReliefMaterial::default();
    ShadeView {
        clip_from_world: Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0)),
        eye: Vec4::Z,
        shadow_steps: material.shadow_steps,
        softness: material.softness,
    }
}

/// Refuses values out of bounds.
///
/// # Errors
/// [`InputError`].
pub fn validate(view: &ShadeView) -> Result<(), InputError> {
    if !view.clip_from_world.is_finite() {
        let value = format!("{:?}", view.clip_from_world.to_cols_array());
        return Err(InputError::new("clip_from_world", value, "must be finite"));
    }
    if !view.eye.is_finite() {
        return Err(InputError::new("eye", view.eye, "must be finite"));
    }
    if !(1..=MAX_STEPS).contains(&view.shadow_steps) {
        let bound = format!("must be in 1..={MAX_STEPS}");
        return Err(InputError::new("shadow_steps", view.shadow_steps, bound));
    }
    if !(1e-3..=1e3).contains(&view.softness) {
        return Err(InputError::new("softness", view.softness, "must be in 0.001..=1000"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_out_of_bounds_are_refused() {
        let good = from_above();
        let field = |view: ShadeView| validate(&view).expect_err("refused").path;
        assert_eq!(field(ShadeView { clip_from_world: Mat4::NAN, ..good }), "clip_from_world");
        assert_eq!(field(ShadeView { eye: Vec4::INFINITY, ..good }), "eye");
        for shadow_steps in [0, MAX_STEPS + 1] {
            assert_eq!(field(ShadeView { shadow_steps, ..good }), "shadow_steps");
        }
        for softness in [0.0, 2e3, f32::NAN] {
            assert_eq!(field(ShadeView { softness, ..good }), "softness");
        }
        assert_eq!(validate(&good), Ok(()));
    }
}
