//! The camera of a view: the caller's own matrices.

use glam::{DVec3, Mat4, Vec3};

use crate::InputError;
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The cell to whose corner the world of `view_from_world` is relative; see
    /// [`Placement`](crate::scene::Placement). Near the origin of the world, (0, 0, 0) will do.
    pub cell: [i32; 3],
    /// The matrix from the world, relative to the cell's corner, to the camera's space: a rotation and a translation. It
    /// may mirror.
    pub view_from_world: Mat4,
    /// The projection, to clip space with depth 0 to 1.
    pub clip_from_view: Mat4,
    /// Width and height of the picture in pixels.
    pub viewport: [u32; 2],
    /// The direction of depth, which must agree with that of the target.
    pub depth: Depth,
}

impl Camera {
    /// A camera at `eye` that looks at `target`, both relative to cell (0, 0, 0), with +Y up, a vertical field of view
    /// in radians, a near plane at `near` and depth from 0 there to 1 at `far`.
    pub fn looking_at(
        eye: Vec3,
        target: Vec3,
        field_of_view: f32,
        near_far: [f32; 2],
        viewport: [u32; 2],
    ) -> Self {
        let forward = (target - eye).normalize_or(Vec3::NEG_Z);
        // Straight up and down, north replaces the undefined up vector.
        let up = if forward.y.abs() > 0.9999 { Vec3::NEG_Z } else { Vec3::Y };
        let aspect = viewport[0] as f32 / viewport[1].max(1) as f32;
        let [near, far] = near_far;
        Self {
            cell: [0; 3],
            view_from_world: glam::camera::rh::view::look_at_mat4(eye, eye + forward, up),
            clip_from_view: glam::camera::rh::proj::directx::perspective(field_of_view, aspect, near, far),
            viewport,
            depth: Depth::Forward,
        }
    }

    /// Checks the matrices and the viewport.
    ///
    /// # Errors
    /// [`InputError`] for values that are not finite, a matrix without inverse, and an empty viewport.
    pub fn validate(&self) -> Result<(), InputError> {
        for (path, matrix) in
            [("camera.view_from_world", self.view_from_world), ("camera.clip_from_view", self.clip_from_view)]
        {
            let determinant = matrix.as_dmat4().determinant();
            if !matrix.is_finite() || determinant == 0.0 {
                return Err(InputError::new(path, matrix, "must be finite and have an inverse"));
            }
        }
        if self.viewport.contains(&0) {
            let value = format!("{:?}", self.viewport);
            return Err(InputError::new("camera.viewport", value, "must be at least 1 by 1"));
        }
        Ok(())
    }

    /// The matrix from the world, relative to the cell's corner, to clip space.
    pub fn clip_from_world(&self) -> Mat4 {
        self.clip_from_view * self.view_from_world
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
        Mat4::from_scale(Vec3::new(1.0, 1.0, direction)) * self.clip_from_world()
    }

    /// The position of the eye relative to the cell's corner.
    pub fn eye(&self) -> Vec3 {
        self.view_from_world.inverse().w_axis.truncate()
    }
}
