//! A perspective camera: right-handed, +Y up, depth 0 (near) to 1 (far).

use glam::{Mat4, Vec3, camera};

use crate::InputError;

/// A perspective camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position in world units.
    pub eye: Vec3,
    /// The point at which the camera looks, in world units.
    pub target: Vec3,
    /// Vertical field of view in radians.
    pub field_of_view: f32,
    /// Distance of the near plane, > 0.
    pub near: f32,
    /// Distance of the far plane, > near.
    pub far: f32,
}

impl Camera {
    /// A camera that sees a box from the south, at a low angle.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn framing(low: Vec3, high: Vec3) -> Self {
        let (center, extent) = ((low + high) / 2.0, (high - low).max(Vec3::splat(1e-3)));
        let field_of_view: f32 = 0.7;
        // The circle around the box's footprint fills the height of the picture, since the view from above
        // foreshortens it.
        let radius = extent.length() / 2.0;
        let distance = 0.72 * radius / (field_of_view / 2.0).sin();
        let eye = center + Vec3::new(-0.30, 0.52, 0.80).normalize() * distance;
        // The near edge takes more of the picture than the far edge, so the target is shifted.
        let target = center + Vec3::new(-0.03, -0.10, 0.05) * radius;
        Self { eye, target, field_of_view, near: distance / 1000.0, far: 2.0 * distance + 2.0 * radius }
    }

    /// The matrix from world to clip space.
    ///
    /// # Errors
    /// [`InputError`] when eye and target coincide, or when the planes or the angle are out of range.
    pub fn clip_from_world(&self, aspect: f32) -> Result<Mat4, InputError> {
        let refuse = |field: &str, value: &dyn std::fmt::Debug, bound: &str| {
            Err(InputError::new(field, format!("{value:?}"), bound))
        };
        if !self.target.is_finite() {
            return refuse("camera.target", &self.target, "must be finite");
        }
        if !self.eye.is_finite() || self.eye == self.target {
            return refuse("camera.eye", &self.eye, "must be finite and differ from the target");
        }
        if !(self.near > 0.0 && self.near.is_finite()) {
            return refuse("camera.near", &self.near, "must be above 0 and finite");
        }
        if !(self.far > self.near && self.far.is_finite()) {
            return refuse("camera.far", &self.far, "must be above camera.near and finite");
        }
        if !(self.field_of_view > 0.0 && self.field_of_view < std::f32::consts::PI) {
            return refuse(
                "camera.field_of_view",
                &self.field_of_view,
                "must be above 0 and below π radians",
            );
        }
        if aspect.is_nan() || aspect <= 0.0 {
            return refuse("aspect", &aspect, "must be above 0");
        }
        let forward = (self.target - self.eye).normalize();
        // Straight down, the up vector is undefined; north replaces it.
        let up = if forward.y.abs() > 0.9999 { Vec3::NEG_Z } else { Vec3::Y };
        let view = camera::rh::view::look_at_mat4(self.eye, self.target, up);
        Ok(camera::rh::proj::directx::perspective(self.field_of_view, aspect, self.near, self.far) * view)
    }
}

#[cfg(test)]
mod tests {
    use super::Camera;
    use crate::InputError;
    use glam::Vec3;

    #[test]
    fn each_field_is_refused_by_its_own_path() {
        let camera = Camera { eye: Vec3::ZERO, target: Vec3::X, field_of_view: 1.0, near: 0.5, far: 8.0 };
        assert!(camera.clip_from_world(1.5).is_ok());
        let at_eye = "must be finite and differ from the target";
        let (of_near, of_far) = ("must be above 0 and finite", "must be above camera.near and finite");
        let of_view = "must be above 0 and below π radians";
        for (camera, aspect, path, value, bound) in [
            (Camera { eye: Vec3::X, ..camera }, 1.0, "camera.eye", "Vec3(1.0, 0.0, 0.0)", at_eye),
            (Camera { eye: Vec3::NAN, ..camera }, 1.0, "camera.eye", "Vec3(NaN, NaN, NaN)", at_eye),
            (
                Camera { target: Vec3::INFINITY, ..camera },
                1.0,
                "camera.target",
                "Vec3(inf, inf, inf)",
                "must be finite",
            ),
            (Camera { near: 0.0, ..camera }, 1.0, "camera.near", "0.0", of_near),
            (Camera { near: f32::INFINITY, ..camera }, 1.0, "camera.near", "inf", of_near),
            (Camera { far: 0.5, ..camera }, 1.0, "camera.far", "0.5", of_far),
            (Camera { far: f32::NAN, ..camera }, 1.0, "camera.far", "NaN", of_far),
            (Camera { field_of_view: 3.2, ..camera }, 1.0, "camera.field_of_view", "3.2", of_view),
            (camera, 0.0, "aspect", "0.0", "must be above 0"),
            (camera, f32::NAN, "aspect", "NaN", "must be above 0"),
        ] {
            assert_eq!(camera.clip_from_world(aspect), Err(InputError::new(path, value, bound)));
        }
    }
}
