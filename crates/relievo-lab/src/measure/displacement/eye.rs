//! Projection of points to pixels, in `f64`.

use glam::{DMat4, DVec2, DVec3, DVec4};
use relievo::InputError;
use relievo::ops::lod::LodCamera;
use relievo::scene::Camera;

/// A camera that projects points, which are relative to the corner of its cell.
pub(super) struct Eye {
    /// By the camera's matrices, multiplied in `f64`.
    pub right: DMat4,
    /// By the matrix of the vertex stage.
    pub drawn: DMat4,
    viewport: DVec2,
    eye: DVec3,
    ahead: DVec3,
    /// The distance of the near plane; none in a parallel view.
    near: Option<f64>,
}

impl Eye {
    pub fn new(camera: &Camera) -> Result<Self, InputError> {
        let Camera { view_from_cell, clip_from_view, viewport, depth, .. } = *camera;
        let own = LodCamera::new(view_from_cell, clip_from_view, viewport, depth, 0.0)?;
        Ok(Self {
            right: clip_from_view.as_dmat4() * view_from_cell.as_dmat4(),
            drawn: camera.clip_from_cell().as_dmat4(),
            viewport: DVec2::from(viewport.map(f64::from)),
            eye: own.eye.as_dvec3(),
            ahead: own.ahead.as_dvec3(),
            near: (own.perspective > 0.0).then_some(own.near.into()),
        })
    }

    /// The position in the picture, in pixels from its middle.
    pub fn pixel(&self, clip: DVec4) -> DVec2 {
        0.5 * self.viewport * clip.truncate().truncate() / clip.w
    }

    /// Whether a point that is off by `off` may lie before the near plane.
    pub fn is_too_near(&self, point: DVec3, off: f64) -> bool {
        self.near.is_some_and(|near| self.ahead.dot(point - self.eye) < near + off)
    }
}

/// Whether a point is inside the view volume.
pub(super) fn is_inside(clip: DVec4) -> bool {
    clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z)
}
