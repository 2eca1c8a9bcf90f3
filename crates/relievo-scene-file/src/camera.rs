//! The camera of a scene file: a path over time, and the view's matrices at a moment.

use glam::{DVec3, Mat4, Vec4};
use relievo::scene::{Camera, Depth, Placement};

/// The range of vertical fields of view, in radians.
pub(super) const FIELDS_OF_VIEW: [f64; 2] = [0.01, 3.1];

/// A camera that moves on a smooth path over time, or stands still.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraPath {
    /// The keys of the path in ascending order; at least one.
    pub(super) keys: Vec<CameraKey>,
    /// The distance of the near plane in world units, above 0.
    pub(super) near: f64,
    /// The distance of the far plane in world units; `None` for infinity.
    pub(super) far: Option<f64>,
}

/// A key of a camera path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CameraKey {
    /// Time in seconds.
    pub time: f64,
    /// The eye's position in world units.
    pub at: DVec3,
    /// The point that the eye looks at, in world units.
    pub look: DVec3,
    /// Vertical field of view in radians.
    pub field_of_view: f64,
}

impl CameraPath {
    /// The time of the path's last key, in seconds. The camera stands still after this time, and before the first key.
    pub fn end(&self) -> f64 {
        self.keys[self.keys.len() - 1].time
    }

    /// The camera at `time` seconds, for a picture of `viewport` pixels. The camera's cell is the cell that contains the eye.
    pub fn camera(&self, time: f64, viewport: [u32; 2], depth: Depth) -> Camera {
        let CameraKey { at, look, field_of_view, .. } = self.key(time);
        let edge = f64::from(Placement::CELL);
        // The casts saturate.
        let cell = (at / edge).floor().to_array().map(|cell| cell as i32);
        let eye = (at - DVec3::from(cell.map(f64::from)) * edge).as_vec3();
        let forward = (look - at).normalize_or(DVec3::NEG_Z);
        // When the camera looks straight up or down, −Z replaces the undefined up vector.
        let up = if forward.y.abs() > 0.9999 { DVec3::NEG_Z } else { DVec3::Y };
        Camera {
            cell,
            view_from_cell: glam::camera::rh::view::look_to_mat4(eye, forward.as_vec3(), up.as_vec3()),
            clip_from_view: self.projection(field_of_view, viewport, depth),
            viewport,
            depth,
        }
    }

    /// Interpolates the path at `time` seconds by cubic Hermite curves through its keys. The velocity at a key is the mean
    /// velocity between the neighbouring keys (Catmull and Rom 1974, for uneven times).
    fn key(&self, time: f64) -> CameraKey {
        let keys = &self.keys;
        let (first, last) = (keys[0], keys[keys.len() - 1]);
        if time <= first.time || keys.len() == 1 {
            return CameraKey { time, ..first };
        }
        if time >= last.time {
            return CameraKey { time, ..last };
        }
        let next = keys.partition_point(|key| key.time <= time);
        let (from, to) = (keys[next - 1], keys[next]);
        let length = to.time - from.time;
        let t = (time - from.time) / length;
        let (square, cube) = (t * t, t * t * t);
        let [a, b] = [2.0 * cube - 3.0 * square + 1.0, 3.0 * square - 2.0 * cube];
        let [c, d] = [cube - 2.0 * square + t, cube - square].map(|weight| weight * length);
        let velocities = [next - 1, next].map(|at| {
            let (before, after) = (&keys[at.saturating_sub(1)], &keys[(at + 1).min(keys.len() - 1)]);
            let seconds = after.time - before.time;
            (
                (after.at - before.at) / seconds,
                (after.look - before.look) / seconds,
                (after.field_of_view - before.field_of_view) / seconds,
            )
        });
        let [u, v] = velocities;
        let field_of_view = a * from.field_of_view + b * to.field_of_view + c * u.2 + d * v.2;
        CameraKey {
            time,
            at: a * from.at + b * to.at + c * u.0 + d * v.0,
            look: a * from.look + b * to.look + c * u.1 + d * v.1,
            field_of_view: field_of_view.clamp(FIELDS_OF_VIEW[0], FIELDS_OF_VIEW[1]),
        }
    }

    fn projection(&self, field_of_view: f64, [width, height]: [u32; 2], depth: Depth) -> Mat4 {
        let focal = 1.0 / libm::tan(0.5 * field_of_view);
        let aspect = f64::from(width) / f64::from(height.max(1));
        let near = self.near;
        // Depth is scale + offset / distance, with the distance ahead of the eye.
        let [scale, offset] = match (depth, self.far) {
            (Depth::Forward, None) => [1.0, -near],
            (Depth::Forward, Some(far)) => [far / (far - near), -near * far / (far - near)],
            (Depth::Reversed, None) => [0.0, near],
            (Depth::Reversed, Some(far)) => [-near / (far - near), near * far / (far - near)],
        };
        let [x, y, scale, offset] = [focal / aspect, focal, -scale, offset].map(|value| value as f32);
        Mat4::from_cols(
            Vec4::new(x, 0.0, 0.0, 0.0),
            Vec4::new(0.0, y, 0.0, 0.0),
            Vec4::new(0.0, 0.0, scale, -1.0),
            Vec4::new(0.0, 0.0, offset, 0.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn path(far: Option<f64>) -> CameraPath {
        let key = |time: f64, x: f64| CameraKey {
            time,
            at: DVec3::new(x, 2.0, 0.0),
            look: DVec3::new(x, 2.0, -10.0),
            field_of_view: 1.0,
        };
        CameraPath { keys: vec![key(0.0, 0.0), key(1.0, 1.0), key(3.0, 3.0), key(4.0, 3.0)], near: 0.5, far }
    }

    #[test]
    fn paths_pass_their_moments_smoothly_and_stop_at_their_ends() {
        let path = path(None);
        let x = |time: f64| path.key(time).at.x;
        for key in &path.keys {
            assert_eq!(path.key(key.time), *key);
        }
        // The first segment has a constant speed, because the velocities at its two keys are equal.
        for time in [0.25, 0.5, 0.75] {
            assert!((x(time) - time).abs() < 1e-12, "{}", x(time));
        }
        assert_eq!((x(-1.0), x(9.0), path.end()), (0.0, 3.0, 4.0));
        // The velocity is continuous between segments.
        let velocity = |time: f64| (x(time + 1e-6) - x(time - 1e-6)) / 2e-6;
        for time in [1.0, 3.0] {
            let [before, after] = [time - 1e-5, time + 1e-5].map(velocity);
            assert!((before - after).abs() < 1e-3, "{before}, {after}");
        }
    }

    #[test]
    fn depth_is_that_of_near_and_far_planes() {
        for (depth, far, expected) in [
            (Depth::Forward, Some(100.0), [0.0, 1.0]),
            (Depth::Reversed, Some(100.0), [1.0, 0.0]),
            (Depth::Forward, None, [0.0, 0.995]),
            (Depth::Reversed, None, [1.0, 0.005]),
        ] {
            let camera = path(far).camera(0.0, [320, 200], depth);
            let found = [0.5, 100.0]
                .map(|ahead| camera.clip_from_cell().project_point3(Vec3::new(0.0, 2.0, -ahead)).z);
            let off = found.iter().zip(expected).map(|(a, b): (&f32, f32)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off < 1e-5, "{depth:?} {far:?}: {found:?}");
        }
        let camera = path(None).camera(0.0, [320, 200], Depth::Forward);
        let top = Vec3::new(0.0, 2.0 + 10.0 * libm::tanf(0.5), -10.0);
        assert!((camera.clip_from_cell().project_point3(top).y - 1.0).abs() < 1e-5);
        let far = CameraPath {
            keys: vec![CameraKey { at: DVec3::new(1e6 + 0.25, -1.0, 0.0), ..path(None).keys[0] }],
            ..path(None)
        };
        let camera = far.camera(0.0, [320, 200], Depth::Forward);
        assert_eq!(camera.cell, [3906, -1, 0]);
        assert!(camera.eye_offset().distance(Vec3::new(64.25, 255.0, 0.0)) < 1e-4, "{}", camera.eye_offset());
    }
}
