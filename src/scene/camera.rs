//! The camera of a view, from the caller's own matrices.

use std::f32::consts::PI;

use glam::camera::rh::proj::directx;
use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::InputError;
pub use crate::lod::Depth;
use crate::lod::is_mirrored;
use crate::scene::placement::{Placement, check_world};

/// A camera: perspective (with a finite or infinite far plane, off-axis or jittered) or parallel.
///
/// # Examples
///
/// A camera from an engine's own matrices. For a simple camera, [`Camera::looking_at`] is shorter.
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
    /// The cell whose corner is the origin of `view_from_cell` ([`Placement::corner`](crate::scene::Placement::corner)).
    /// Near the origin of the world, use (0, 0, 0). Kilometres away, use the eye's own cell, or the picture trembles.
    pub cell: [i32; 3],
    /// The matrix from cell space to view space: a rotation and a translation. Cell space is world space moved to the cell's
    /// corner. With cell (0, 0, 0), `view_from_cell` equals the engine's own view matrix. The matrix may mirror, for example
    /// for a reflection in water.
    pub view_from_cell: Mat4,
    /// The projection to clip space: +X to the right, +Y up, depth 0 to 1. The projection also decides the viewing
    /// direction. Right-handed projections, such as those in glam's `camera::rh::proj::directx`, look along −Z. For
    /// [`Depth::Reversed`], use `perspective_infinite_reverse` from that module.
    pub clip_from_view: Mat4,
    /// Width and height of the picture in physical pixels, the unit of [`Quality::pixels`](crate::scene::Quality::pixels).
    /// They must equal the size of the viewport set in the caller's pass. This viewport may be a part of the target.
    pub viewport: [u32; 2],
    /// The direction of depth: whether it grows or falls with distance. It must match the projection and the renderer's
    /// [`TargetFormat`](crate::render::TargetFormat).
    pub depth: Depth,
}

impl Camera {
    /// A perspective camera at `eye` that looks at `target`, both in world coordinates, with +Y up. The camera's cell is
    /// (0, 0, 0). Kilometres from the origin, use [`Camera::looking_at_world`], or the picture trembles.
    ///
    /// - `field_of_view` is the vertical angle in radians, between 0 and π.
    /// - `near_far` are the distances of the near and far planes in world units, where depth is 0 and 1. The far distance
    ///   may be infinite.
    /// - `viewport` is width and height in pixels.
    ///
    /// When the camera looks straight up or down, the top of the picture is north. If an argument is out of range, or `eye`
    /// equals `target`, the matrices hold NaN. [`View::set`](crate::scene::View::set) then refuses the camera and names the
    /// argument.
    pub fn looking_at(
        eye: Vec3,
        target: Vec3,
        field_of_view: f32,
        near_far: [f32; 2],
        viewport: [u32; 2],
    ) -> Self {
        // If the camera looks straight up or down, +Y is no usable up vector, so north replaces it.
        let up = |forward: Vec3| if forward.y.abs() > 0.9999 { Vec3::NEG_Z } else { Vec3::Y };
        let look = |forward| glam::camera::rh::view::look_at_mat4(eye, eye + forward, up(forward));
        let view_from_cell = (target - eye).try_normalize().map(look);
        let aspect = viewport[0] as f32 / viewport[1].max(1) as f32;
        let [near, far] = near_far;
        let is_frustum = field_of_view > 0.0 && field_of_view < PI && near > 0.0 && far > near;
        let clip_from_view = match (is_frustum, far == f32::INFINITY) {
            (false, _) => unusable(LOOKING, [Vec3::new(field_of_view, near, far), Vec3::NAN]),
            (true, true) => directx::perspective_infinite(field_of_view, aspect, near),
            (true, false) => directx::perspective(field_of_view, aspect, near, far),
        };
        Self {
            cell: [0; 3],
            view_from_cell: match view_from_cell.filter(Mat4::is_finite) {
                Some(matrix) => matrix,
                None => unusable(LOOKING, [eye, target]),
            },
            clip_from_view,
            viewport,
            depth: Depth::Forward,
        }
    }

    /// Like [`Camera::looking_at`], but precise anywhere in the world: the camera's cell is the cell that contains `eye`.
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

    /// A perspective camera that looks at an axis-aligned box from the south, at a low angle. The box appears as large as
    /// the picture allows. `low` and `high` are opposite corners in world coordinates
    /// ([`Bounds::world`](crate::scene::Bounds::world)). `viewport` is width and height in pixels. If a corner is not
    /// finite, [`View::set`](crate::scene::View::set) refuses the camera, as for [`Camera::looking_at`].
    pub fn framing(low: DVec3, high: DVec3, viewport: [u32; 2]) -> Self {
        let (center, extent) = ((low + high) / 2.0, (high - low).max(DVec3::splat(1e-3)));
        let field_of_view: f32 = 0.7;
        // The low angle foreshortens the circle around the box's footprint. At this distance, the circle fills the picture's
        // height.
        let radius = extent.length() / 2.0;
        let distance = 0.72 * radius / f64::from(field_of_view / 2.0).sin();
        let eye = center + distance * DVec3::new(-0.30, 0.52, 0.80).normalize();
        // The box's near edge takes more of the picture than its far edge, so the target is shifted.
        let target = center + radius * DVec3::new(-0.03, -0.10, 0.05);
        let Placement { cell, offset: eye, .. } = Placement::at_world(eye);
        let forward =
            (target - (Placement::corner(cell) + eye.as_dvec3())).normalize_or(DVec3::NEG_Z).as_vec3();
        let aspect = viewport[0] as f32 / viewport[1].max(1) as f32;
        let [near, far] = [distance / 1000.0, 2.0 * distance + 2.0 * radius].map(|plane| plane as f32);
        let view_from_cell = match eye.is_finite() {
            true => glam::camera::rh::view::look_to_mat4(eye, forward, Vec3::Y),
            false => {
                unusable(FRAMING, [low, high].map(|corner| (corner - Placement::corner(cell)).as_vec3()))
            }
        };
        Self {
            cell,
            view_from_cell,
            clip_from_view: directx::perspective(field_of_view, aspect, near, far),
            viewport,
            depth: Depth::Forward,
        }
    }

    /// The same camera with the opposite depth direction.
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
    /// [`InputError`] for values that are not finite, a matrix without inverse, a `view_from_cell` that is not affine, an
    /// eye beyond the last cell ([`Placement::checked`]), and an empty viewport.
    pub fn validate(&self) -> Result<(), InputError> {
        if self.viewport.contains(&0) {
            let value = format!("{:?}", self.viewport);
            return Err(InputError::new("camera.viewport", value, "must be at least 1 by 1"));
        }
        self.check_arguments()?;
        for (path, matrix) in
            [("camera.view_from_cell", self.view_from_cell), ("camera.clip_from_view", self.clip_from_view)]
        {
            let determinant = matrix.as_dmat4().determinant();
            if !matrix.is_finite() || determinant == 0.0 {
                return Err(InputError::new(path, matrix, "must be finite and have an inverse"));
            }
        }
        if self.view_from_cell.row(3) != Vec4::W {
            let bound = "must have the last row (0, 0, 0, 1): the projection belongs into clip_from_view";
            return Err(InputError::new("camera.view_from_cell", self.view_from_cell, bound));
        }
        check_world("camera.eye", self.cell, self.eye_offset())
    }

    /// Returns an error if the camera's constructor got arguments from which no matrix can be computed.
    fn check_arguments(&self) -> Result<(), InputError> {
        if let Some((kind, [first, second])) = arguments(&self.view_from_cell) {
            let paths =
                if kind == FRAMING { ["camera.low", "camera.high"] } else { ["camera.eye", "camera.target"] };
            check_world(paths[0], self.cell, first)?;
            check_world(paths[1], self.cell, second)?;
            let bound = match first == second {
                true => "must be elsewhere than the eye",
                false => "must be nearer to the corner of the eye's cell: use Camera::looking_at_world",
            };
            let target = Placement::corner(self.cell) + second.as_dvec3();
            return Err(InputError::new(paths[1], target, bound));
        }
        if let Some((_, [Vec3 { x: field_of_view, y: near, z: far }, _])) = arguments(&self.clip_from_view) {
            if !(field_of_view > 0.0 && field_of_view < PI) {
                let bound = "must be above 0 and below π: it is in radians";
                return Err(InputError::new("camera.field_of_view", field_of_view, bound));
            }
            let bound = "must be two distances, the first above 0, the second above the first";
            return Err(InputError::new("camera.near_far", format!("[{near}, {far}]"), bound));
        }
        Ok(())
    }

    /// The matrix from cell space to clip space.
    pub fn clip_from_cell(&self) -> Mat4 {
        self.clip_from_view * self.view_from_cell
    }

    /// The viewing direction of a parallel camera, a unit vector. Motion along this direction does not change the picture.
    pub(crate) fn ahead(&self) -> Vec3 {
        let [right, up, depth] =
            [0, 1, 2].map(|row| self.clip_with_distance().row(row).truncate().as_dvec3());
        let along = right.cross(up);
        let ahead = if along.dot(depth) < 0.0 { -along } else { along };
        ahead.normalize_or(DVec3::NEG_Z).as_vec3()
    }

    /// Whether the picture is a mirror image. In a mirror image, front faces appear clockwise instead of counter-clockwise.
    pub(crate) fn is_mirrored(&self) -> bool {
        is_mirrored(&self.clip_with_distance())
    }

    /// The matrix from cell space to a clip space whose depth grows with distance. The range of this depth is
    /// arbitrary.
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

/// Tags of [`unusable`] matrices. A tag names the constructor that got the arguments: [`Camera::looking_at`] or
/// [`Camera::framing`].
const LOOKING: f32 = 0.0;
const FRAMING: f32 = 1.0;

/// Placeholder for a matrix that cannot be computed. It holds the tag `kind` and the constructor's arguments, and NaN
/// elsewhere. Tag and arguments survive [`Camera::reversed`], which changes only the third row.
fn unusable(kind: f32, [first, second]: [Vec3; 2]) -> Mat4 {
    let column = |Vec3 { x, y, z }| Vec4::new(x, y, f32::NAN, z);
    Mat4::from_cols(Vec4::NAN.with_x(kind), column(first), column(second), Vec4::NAN)
}

/// The tag and the arguments stored by [`unusable`]; `None` for an ordinary matrix.
fn arguments(matrix: &Mat4) -> Option<(f32, [Vec3; 2])> {
    let kind = matrix.x_axis.x;
    let rest = [matrix.x_axis.with_x(f32::NAN), matrix.w_axis];
    let is_unusable = rest.iter().all(|column| column.is_nan_mask().all());
    let of = |column: Vec4| Vec3::new(column.x, column.y, column.w);
    (is_unusable && !kind.is_nan()).then(|| (kind, [of(matrix.y_axis), of(matrix.z_axis)]))
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
        // The matrix has an entry of 1.01…, which is rounded by less than 1e-7.
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

    /// Invalid arguments of a camera are refused. The error has the argument's name and value.
    #[test]
    fn arguments_that_make_no_camera_are_named() {
        let refused = |target, field_of_view, near_far| {
            let camera = Camera::looking_at(Vec3::ONE, target, field_of_view, near_far, [3, 2]);
            let found = [camera, camera.reversed()].map(|camera| camera.validate().expect_err("refused"));
            assert_eq!(found[0], found[1]);
            (found[0].path.clone(), found[0].value.clone())
        };
        let planes = [0.1, 9.0];
        assert_eq!(refused(Vec3::ONE, 0.7, planes), ("camera.target".into(), "[1, 1, 1]".into()));
        assert_eq!(refused(Vec3::NAN, 0.7, planes), ("camera.target[0]".into(), "NaN".into()));
        assert_eq!(refused(Vec3::INFINITY, 0.7, planes).0, "camera.target[0]");
        for field_of_view in [4.0, std::f32::consts::PI, 0.0, -0.7, f32::NAN, f32::INFINITY] {
            let expected = ("camera.field_of_view".into(), field_of_view.to_string());
            assert_eq!(refused(Vec3::ZERO, field_of_view, planes), expected);
        }
        for [near, far] in [[0.0, 9.0], [-0.1, 9.0], [9.0, 0.1], [1.0, 1.0], [f32::NAN, 9.0], [0.1, f32::NAN]]
        {
            let expected = ("camera.near_far".into(), format!("[{near}, {far}]"));
            assert_eq!(refused(Vec3::ZERO, 0.7, [near, far]), expected);
        }
        let refused = |camera: Camera| camera.validate().expect_err("refused").to_string();
        let bound = "must be a number in -549755813888..549755813888, the world's coordinates";
        let eye = Camera::looking_at(Vec3::new(0.0, f32::NAN, 0.0), Vec3::ONE, 0.7, planes, [3, 2]);
        assert_eq!(refused(eye), format!("camera.eye[1] = NaN: {bound}"));
        let far = Camera::looking_at(Vec3::X * 1e10, Vec3::X * 1.1e10, 0.7, planes, [3, 2]);
        assert!(
            refused(far).starts_with("camera.target = [1100000")
                && refused(far).ends_with("looking_at_world")
        );
        let eye = |x: f64| Camera::looking_at_world([x, 0.0, 0.0], [0.0, 1.0, 0.0], 0.7, planes, [3, 2]);
        assert_eq!(refused(eye(1e300)), format!("camera.eye[0] = beyond ±3.4e38, the range of f32: {bound}"));
        assert_eq!(refused(eye(6e11)), format!("camera.eye[0] = 600000000000: {bound}"));
        assert_eq!(eye(5e11).validate(), Ok(()));
        let framed = |low: f64, high: f64| Camera::framing(DVec3::splat(low), DVec3::splat(high), [3, 2]);
        assert_eq!(refused(framed(f64::NAN, 1.0)), format!("camera.low[0] = NaN: {bound}"));
        assert_eq!(refused(framed(0.0, f64::NAN)), format!("camera.high[0] = NaN: {bound}"));
        assert!(refused(framed(0.0, 1e300)).starts_with("camera.high[0] = beyond"));
        assert!(refused(framed(0.0, 1e20)).starts_with("camera.eye[0] = "));
    }
}
