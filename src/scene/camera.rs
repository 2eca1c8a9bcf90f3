//! The camera of a view: the caller's own matrices.

use std::f32::consts::PI;

use glam::camera::rh::proj::directx;
use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::InputError;
use crate::scene::placement::Placement;
use crate::skinning::picture::is_mirrored;

/// The direction of depth in clip space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Depth {
    /// 0 at the near plane, 1 at the far plane.
    #[default]
    Forward,
    /// 1 at the near plane, 0 at the far plane or at infinity.
    Reversed,
}

/// A camera: perspective (with a finite or infinite far plane, off-axis or jittered) or parallel.
///
/// # Examples
///
/// [`Camera::looking_at`] is a shortcut. An engine has matrices of its own:
///
/// ```
/// use glam::{DVec3, Mat4, Quat, Vec3};
/// use relievo::scene::{Camera, Depth};
///
/// // Two units above the ground, looking north-west (0.8 to the left of −Z), 0.1 downwards.
/// let turn = Quat::from_rotation_y(0.8) * Quat::from_rotation_x(-0.1);
/// let world_from_view = Mat4::from_rotation_translation(turn, Vec3::new(0.0, 2.0, 0.0));
/// let camera = Camera {
///     cell: [0; 3],
///     view_from_cell: world_from_view.inverse(), // the corner of cell (0, 0, 0) is the world's origin
///     // Reversed depth: 1 at 0.1 units ahead, 0 at infinity. The renderer's format says so too.
///     clip_from_view: glam::camera::rh::proj::directx::perspective_infinite_reverse(1.0, 16.0 / 9.0, 0.1),
///     viewport: [1920, 1080],
///     depth: Depth::Reversed,
/// };
/// assert!(camera.world().distance(DVec3::new(0.0, 2.0, 0.0)) < 1e-5);
/// camera.validate()?;
/// # Ok::<(), relievo::InputError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The cell from whose corner `view_from_cell` leads ([`Placement::corner`](crate::scene::Placement::corner)). Near the
    /// origin of the world, (0, 0, 0) will do; kilometres away, the eye's own cell keeps the picture from trembling.
    pub cell: [i32; 3],
    /// The matrix from the cell's space, which is the world's moved to the cell's corner, to the camera's space: a rotation and
    /// a translation. With cell (0, 0, 0) it is the engine's own matrix from the world. It may mirror, as for a reflection in
    /// water.
    pub view_from_cell: Mat4,
    /// The projection, to clip space: +X to the right, +Y up, depth 0 to 1. It says which way the camera looks: along −Z if it
    /// is made for right-handed spaces, as those of glam's `camera::rh::proj::directx` are, among them
    /// `perspective_infinite_reverse` for [`Depth::Reversed`].
    pub clip_from_view: Mat4,
    /// Width and height of the picture in physical pixels: those that [`Quality::pixels`](crate::scene::Quality::pixels)
    /// counts, and those of the viewport that the caller sets in its pass, which may be a part of the target.
    pub viewport: [u32; 2],
    /// The direction of depth, which must be that of the projection, and of the renderer's
    /// [`TargetFormat`](crate::render::TargetFormat).
    pub depth: Depth,
}

impl Camera {
    /// A perspective camera at `eye` that looks at `target`, both in world coordinates, with +Y up. Its cell is (0, 0, 0);
    /// kilometres from the origin, [`Camera::looking_at_world`] keeps the picture from trembling.
    /// `field_of_view` is the vertical one, in radians, between 0 and π; `near_far` are the distances of the near and the far
    /// plane in world units, where depth is 0 and 1, and the far one may be infinite; `viewport` is width and height in pixels.
    /// Straight up and down, the top of the picture is north.
    ///
    /// For arguments out of these ranges, and an `eye` at its `target`, the matrices hold NaN, which
    /// [`View::set`](crate::scene::View::set) refuses.
    pub fn looking_at(
        eye: Vec3,
        target: Vec3,
        field_of_view: f32,
        near_far: [f32; 2],
        viewport: [u32; 2],
    ) -> Self {
        let forward = (target - eye).try_normalize().unwrap_or(Vec3::NAN);
        // Straight up and down, north replaces the undefined up vector.
        let up = if forward.y.abs() > 0.9999 { Vec3::NEG_Z } else { Vec3::Y };
        let aspect = viewport[0] as f32 / viewport[1].max(1) as f32;
        let [near, far] = near_far;
        let is_frustum = field_of_view > 0.0 && field_of_view < PI && near > 0.0 && far > near;
        let clip_from_view = match (is_frustum, far == f32::INFINITY) {
            (false, _) => Mat4::NAN,
            (true, true) => directx::perspective_infinite(field_of_view, aspect, near),
            (true, false) => directx::perspective(field_of_view, aspect, near, far),
        };
        Self {
            cell: [0; 3],
            view_from_cell: glam::camera::rh::view::look_at_mat4(eye, eye + forward, up),
            clip_from_view,
            viewport,
            depth: Depth::Forward,
        }
    }

    /// As [`Camera::looking_at`], anywhere in the world: the cell is that of the eye.
    pub fn looking_at_world(
        eye: impl Into<DVec3>,
        target: impl Into<DVec3>,
        field_of_view: f32,
        near_far: [f32; 2],
        viewport: [u32; 2],
    ) -> Self {
        let Placement { cell, offset: eye, .. } = Placement::at_world(eye);
        let target = (target.into() - Placement::corner(cell)).as_vec3();
        Self { cell, ..Self::looking_at(eye, target, field_of_view, near_far, viewport) }
    }

    /// A perspective camera that sees a box along the axes of the world from the south at a low angle, as large as the picture
    /// allows. `low` and `high` are opposite corners in world coordinates
    /// ([`Bounds::world`](crate::scene::Bounds::world)); `viewport` is width and height in pixels.
    pub fn framing(low: DVec3, high: DVec3, viewport: [u32; 2]) -> Self {
        let (center, extent) = ((low + high) / 2.0, (high - low).max(DVec3::splat(1e-3)));
        let field_of_view: f32 = 0.7;
        // The circle around the box's footprint fills the height of the picture, since the view from above
        // foreshortens it.
        let radius = extent.length() / 2.0;
        let distance = 0.72 * radius / f64::from(field_of_view / 2.0).sin();
        let eye = center + distance * DVec3::new(-0.30, 0.52, 0.80).normalize();
        // The near edge takes more of the picture than the far edge, so the target is shifted.
        let target = center + radius * DVec3::new(-0.03, -0.10, 0.05);
        let Placement { cell, offset: eye, .. } = Placement::at_world(eye);
        let forward =
            (target - (Placement::corner(cell) + eye.as_dvec3())).normalize_or(DVec3::NEG_Z).as_vec3();
        let aspect = viewport[0] as f32 / viewport[1].max(1) as f32;
        let [near, far] = [distance / 1000.0, 2.0 * distance + 2.0 * radius].map(|plane| plane as f32);
        Self {
            cell,
            view_from_cell: glam::camera::rh::view::look_to_mat4(eye, forward, Vec3::Y),
            clip_from_view: directx::perspective(field_of_view, aspect, near, far),
            viewport,
            depth: Depth::Forward,
        }
    }

    /// The same camera with depth in the other direction.
    #[must_use]
    pub fn reversed(self) -> Self {
        let Self { clip_from_view, depth, .. } = self;
        let mut rows = clip_from_view.transpose();
        rows.z_axis = rows.w_axis - rows.z_axis;
        let depth = match depth {
            Depth::Forward => Depth::Reversed,
            Depth::Reversed => Depth::Forward,
        };
        Self { clip_from_view: rows.transpose(), depth, ..self }
    }

    /// Checks the matrices and the viewport.
    ///
    /// # Errors
    /// [`InputError`] for values that are not finite, a matrix without inverse, a `view_from_cell` that is no affine one,
    /// and an empty viewport.
    pub fn validate(&self) -> Result<(), InputError> {
        if self.viewport.contains(&0) {
            let value = format!("{:?}", self.viewport);
            return Err(InputError::new("camera.viewport", value, "must be at least 1 by 1"));
        }
        let looking = "an eye within 2^31 cells of the origin, and a target elsewhere";
        let projection = "a field of view above 0 and below π, near above 0, and far above near";
        for (path, matrix, needed) in [
            ("camera.view_from_cell", self.view_from_cell, looking),
            ("camera.clip_from_view", self.clip_from_view, projection),
        ] {
            let determinant = matrix.as_dmat4().determinant();
            if !matrix.is_finite() || determinant == 0.0 {
                let bound = format!("must be finite and have an inverse; Camera::looking_at needs {needed}");
                return Err(InputError::new(path, matrix, bound));
            }
        }
        if self.view_from_cell.row(3) != Vec4::W {
            let bound = "must have the last row (0, 0, 0, 1): the projection belongs into clip_from_view";
            return Err(InputError::new("camera.view_from_cell", self.view_from_cell, bound));
        }
        Ok(())
    }

    /// The matrix from the cell's space to clip space.
    pub fn clip_from_cell(&self) -> Mat4 {
        self.clip_from_view * self.view_from_cell
    }

    /// For a parallel camera, the unit vector along which distance grows and nothing moves in the picture.
    pub(crate) fn ahead(&self) -> Vec3 {
        let [right, up, depth] =
            [0, 1, 2].map(|row| self.clip_with_distance().row(row).truncate().as_dvec3());
        let along = right.cross(up);
        let ahead = if along.dot(depth) < 0.0 { -along } else { along };
        ahead.normalize_or(DVec3::NEG_Z).as_vec3()
    }

    /// Whether the picture is a mirror image: triangles that are counter-clockwise seen from outside run clockwise in it.
    pub(crate) fn is_mirrored(&self) -> bool {
        is_mirrored(&self.clip_with_distance())
    }

    /// The matrix to clip space with depth that grows with distance, whatever its range.
    fn clip_with_distance(&self) -> Mat4 {
        let direction = if self.depth == Depth::Reversed { -1.0 } else { 1.0 };
        Mat4::from_scale(Vec3::new(1.0, 1.0, direction)) * self.clip_from_cell()
    }

    /// The position of the eye in world coordinates.
    pub fn world(&self) -> DVec3 {
        Placement::corner(self.cell) + self.eye_offset().as_dvec3()
    }

    /// The position of the eye relative to the cell's corner.
    pub fn eye_offset(&self) -> Vec3 {
        self.view_from_cell.inverse().w_axis.truncate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_infinite_camera_is_reversed_to_the_bit() {
        let (eye, size) = (Vec3::new(1.0, 2.0, 3.0), [300, 200]);
        let camera = Camera::looking_at(eye, Vec3::ZERO, 0.7, [0.1, f32::INFINITY], size);
        let reversed = camera.reversed();
        let expected = directx::perspective_infinite_reverse(0.7, 1.5, 0.1);
        assert_eq!((reversed.clip_from_view, reversed.depth), (expected, Depth::Reversed));
        assert_eq!(reversed.reversed(), camera);
        let finite = Camera::looking_at(eye, Vec3::ZERO, 0.7, [0.5, 40.0], size).reversed();
        let depth = |distance: f32| finite.clip_from_view.project_point3(Vec3::Z * -distance).z;
        // The matrix holds 1.01…, rounded by less than 1e-7.
        assert!(
            (depth(0.5) - 1.0).abs() < 1e-6 && depth(40.0).abs() < 1e-6,
            "{} {}",
            depth(0.5),
            depth(40.0)
        );
    }

    #[test]
    fn a_framed_box_is_in_the_picture_and_fills_it() {
        let corner = |at: usize| DVec3::new((at & 1) as f64, (at >> 1 & 1) as f64, (at >> 2 & 1) as f64);
        for origin in [DVec3::ZERO, DVec3::new(-3e6, 500.0, 7e5)] {
            for size in [DVec3::new(128.0, 30.0, 128.0), DVec3::new(4000.0, 900.0, 4000.0)] {
                let camera = Camera::framing(origin, origin + size, [1280, 720]);
                camera.validate().expect("a camera");
                let cell = DVec3::from(camera.cell.map(f64::from)) * 256.0;
                let places = (0..8).map(|at| {
                    let place = (origin + size * corner(at) - cell).as_vec3();
                    camera.clip_from_cell().project_point3(place)
                });
                let [low, high] = places
                    .fold([Vec3::MAX, Vec3::MIN], |[low, high], place| [low.min(place), high.max(place)]);
                assert!(low.min_element() > -1.0 && high.max_element() < 1.0, "{low} {high}");
                assert!(high.y - low.y > 1.4 && low.z > 0.0, "{low} {high}");
            }
        }
    }

    #[test]
    fn errors_name_what_the_caller_gave() {
        let path = |camera: Camera| camera.validate().expect_err("refused").path;
        let camera = |viewport| Camera::looking_at(Vec3::ONE, Vec3::ZERO, 0.7, [0.1, 9.0], viewport);
        assert_eq!(path(camera([0, 0])), "camera.viewport");
        let Camera { view_from_cell, clip_from_view, .. } = camera([3, 2]);
        let exchanged =
            Camera { view_from_cell: clip_from_view, clip_from_view: view_from_cell, ..camera([3, 2]) };
        assert_eq!(path(exchanged), "camera.view_from_cell");
        let collapsed = Camera { clip_from_view: Mat4::ZERO, ..camera([3, 2]) };
        assert_eq!(path(collapsed), "camera.clip_from_view");
        assert_eq!(camera([3, 2]).validate(), Ok(()));
    }

    #[test]
    fn looking_at_nothing_is_refused() {
        let refused = |target, field_of_view, near_far| {
            let camera = Camera::looking_at(Vec3::ONE, target, field_of_view, near_far, [3, 2]);
            camera.validate().expect_err("refused").path
        };
        for target in [Vec3::ONE, Vec3::NAN, Vec3::INFINITY] {
            assert_eq!(refused(target, 0.7, [0.1, 9.0]), "camera.view_from_cell", "{target}");
        }
        for field_of_view in [4.0, std::f32::consts::PI, 0.0, -0.7, f32::NAN, f32::INFINITY] {
            assert_eq!(
                refused(Vec3::ZERO, field_of_view, [0.1, 9.0]),
                "camera.clip_from_view",
                "{field_of_view}"
            );
        }
        for planes in [[0.0, 9.0], [-0.1, 9.0], [9.0, 0.1], [1.0, 1.0], [f32::NAN, 9.0], [0.1, f32::NAN]] {
            assert_eq!(refused(Vec3::ZERO, 0.7, planes), "camera.clip_from_view", "{planes:?}");
        }
    }
}
