//! The camera: what pointer and keys do to it.

use glam::{DVec3, Vec3};
use relievo::scene::{Camera, Placement};

/// The largest pitch, in radians: a little less than straight up and down, where the horizon is undefined.
const STEEPEST: f64 = 1.55;

/// Radians of a drag over the height of the picture.
const TURN: f64 = 3.0;

/// A camera that goes around a point.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Eye {
    /// The point that it goes around, in world units.
    pub focus: [f64; 3],
    /// The distance to that point in world units, above 0.
    pub distance: f64,
    /// The angle in radians from the north (−Z) to the left.
    pub yaw: f64,
    /// The angle in radians above the horizon.
    pub pitch: f64,
}

impl Eye {
    /// The eye of a camera whose focus is `distance` ahead.
    pub fn of(camera: &Camera, distance: f64) -> Self {
        let ahead = -camera.view_from_cell.row(2).truncate().as_dvec3();
        let focus = (camera.world() + distance * ahead).to_array();
        let pitch = ahead.y.clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST);
        Self { focus, distance, yaw: (-ahead.x).atan2(-ahead.z), pitch }
    }

    /// An eye at `at` that looks at `look`, which is another point.
    pub fn between(at: DVec3, look: DVec3) -> Self {
        let ahead = (look - at).normalize_or(DVec3::NEG_Z);
        let pitch = ahead.y.clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST);
        let (focus, distance) = (look.to_array(), at.distance(look).max(1e-6));
        Self { focus, distance, yaw: (-ahead.x).atan2(-ahead.z), pitch }
    }

    /// The point that it goes around.
    pub fn focus(&self) -> DVec3 {
        self.focus.into()
    }

    /// The unit vector ahead.
    pub fn ahead(&self) -> DVec3 {
        let (sin, cos) = self.yaw.sin_cos();
        let level = self.pitch.cos();
        DVec3::new(-sin * level, self.pitch.sin(), -cos * level)
    }

    /// The unit vector to the right, which is level.
    pub fn right(&self) -> DVec3 {
        let (sin, cos) = self.yaw.sin_cos();
        DVec3::new(cos, 0.0, -sin)
    }

    /// The position in world units.
    pub fn position(&self) -> DVec3 {
        self.focus() - self.distance * self.ahead()
    }

    /// A camera here, with the projection and the viewport of another one.
    pub fn camera(&self, projection: &Camera) -> Camera {
        let Placement { cell, offset, .. } = Placement::at_world(self.position());
        let view_from_cell = glam::camera::rh::view::look_to_mat4(offset, self.ahead().as_vec3(), Vec3::Y);
        Camera { cell, view_from_cell, ..*projection }
    }

    /// Goes around the focus by a drag, in heights of the picture.
    pub fn orbit(&mut self, [right, down]: [f64; 2]) {
        self.yaw -= TURN * right;
        self.pitch = (self.pitch - TURN * down).clamp(-STEEPEST, STEEPEST);
    }

    /// Looks around from where it is, by a drag in heights of the picture. The focus turns with it.
    pub fn look(&mut self, drag: [f64; 2]) {
        let position = self.position();
        self.orbit(drag.map(|part| -0.5 * part));
        self.focus = (position + self.distance * self.ahead()).to_array();
    }

    /// Moves sideways with the picture, by a drag in heights of the picture at the distance of the focus. `tangent` is that of half
    /// the field of view.
    pub fn pan(&mut self, [right, down]: [f64; 2], tangent: f64) {
        let unit = 2.0 * tangent * self.distance;
        let up = self.right().cross(self.ahead());
        self.focus = (self.focus() + unit * (down * up - right * self.right())).to_array();
    }

    /// Comes nearer to the focus, by a factor of its distance below 1; goes farther, by one above 1.
    pub fn zoom(&mut self, factor: f64) {
        self.distance = (self.distance * factor).clamp(1e-3, 1e8);
    }

    /// Moves with its focus: to the right, up and ahead, in world units.
    pub fn fly(&mut self, [right, up, ahead]: [f64; 3]) {
        let way = right * self.right() + up * DVec3::Y + ahead * self.ahead();
        self.focus = (self.focus() + way).to_array();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(at: [f64; 3], look: [f64; 3]) -> Camera {
        Camera::looking_at_world(at, look, 0.8, [0.1, 100.0], [300, 200])
    }

    #[test]
    fn an_eye_of_a_camera_gives_the_camera_back() {
        for (at, look) in
            [([1.0, 2.0, 3.0], [4.0, 1.0, -7.0]), ([-3e6, 10.0, 5e5], [-3e6 + 20.0, 0.0, 5e5 - 4.0])]
        {
            let given = camera(at, look);
            let distance = DVec3::from(at).distance(look.into());
            let eye = Eye::of(&given, distance);
            assert!(eye.focus().distance(look.into()) < 1e-4 * distance, "{eye:?}");
            assert!(eye.position().distance(at.into()) < 1e-4 * distance);
            let back = eye.camera(&given);
            assert_eq!(back.cell, given.cell);
            assert!((back.view_from_cell - given.view_from_cell).abs_diff_eq(glam::Mat4::ZERO, 1e-4));
            let between = Eye::between(at.into(), look.into());
            assert!((between.yaw - eye.yaw).abs() < 1e-5 && (between.pitch - eye.pitch).abs() < 1e-5);
        }
    }

    #[test]
    fn drags_move_what_they_say() {
        let start = Eye::between(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO);
        let mut eye = start;
        eye.orbit([0.1, 0.0]);
        assert!(eye.position().x < -1.0 && eye.focus() == DVec3::ZERO, "the scene turns with the pointer");
        let mut eye = start;
        eye.orbit([0.0, 0.1]);
        assert!(eye.position().y > 1.0);
        let mut eye = start;
        eye.look([0.1, 0.0]);
        assert!(eye.position().distance(start.position()) < 1e-9);
        assert!(eye.ahead().x < -0.1, "the picture moves with the pointer");
        let mut eye = start;
        eye.pan([0.5, 0.0], 0.4);
        // Half a picture at a distance of 10.
        assert!((eye.focus().x + 4.0).abs() < 1e-9 && eye.distance == 10.0);
        let mut eye = start;
        eye.zoom(0.5);
        assert!((eye.position().z - 5.0).abs() < 1e-9);
        eye.fly([1.0, 2.0, 3.0]);
        assert!(eye.focus().distance(DVec3::new(1.0, 2.0, -3.0)) < 1e-9);
    }
}
