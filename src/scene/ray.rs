//! Rays, and surfaces for hit tests on the host.

use std::borrow::Cow;

use glam::{DAffine3, DMat4, DVec3};

use crate::InputError;
use crate::mesh::ray::distance_to;
use crate::scene::camera::{Camera, Depth};
use crate::scene::handles::{InstanceId, ObjectId};
use crate::scene::placement::Placement;
use crate::skinning::merged::Merged;

/// A ray in the world, for [`Scene::pick`](crate::scene::Scene::pick).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Index of a cell. `offset` is relative to the corner of this cell; see [`Placement`].
    pub cell: [i32; 3],
    /// The start of the ray in world units, relative to the cell's corner. For cell (0, 0, 0), `offset` is
    /// in world coordinates.
    pub offset: DVec3,
    /// The direction of the ray, of any length except 0.
    pub direction: DVec3,
    /// The largest distance of a hit, in world units.
    pub limit: f64,
    /// Visibility mask. The ray hits only instances whose own mask shares a bit with this mask.
    pub mask: u16,
}

/// The first hit of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The instance that was hit. For terrain, this is the patch.
    pub instance: InstanceId,
    /// The object of the instance.
    pub object: ObjectId,
    /// The distance from the start of the ray to the hit point, in world units.
    pub distance: f64,
    /// The cell of the ray. `offset` is relative to the corner of this cell.
    pub cell: [i32; 3],
    /// The hit point in world units, relative to the cell's corner.
    pub offset: DVec3,
    /// The outward unit normal of the triangle.
    pub normal: DVec3,
}

impl Hit {
    /// The hit point in world coordinates.
    pub fn world(&self) -> DVec3 {
        Placement::corner(self.cell) + self.offset
    }
}

impl Ray {
    /// A ray from a position in world coordinates, without a limit of distance. It hits instances with any visibility
    /// mask except 0.
    pub fn new(position: impl Into<DVec3>, direction: impl Into<DVec3>) -> Self {
        let (offset, direction) = (position.into(), direction.into());
        Self { cell: [0; 3], offset, direction, limit: f64::INFINITY, mask: u16::MAX }
    }

    /// The start of the ray in world coordinates.
    pub fn world(&self) -> DVec3 {
        Placement::corner(self.cell) + self.offset
    }

    /// The ray from a camera's near plane through a point of the camera's picture. The point is in pixels from the left
    /// and the top edge; the middle of the first pixel is (0.5, 0.5).
    ///
    /// # Errors
    /// [`InputError`] if [`Camera::validate`] refuses the camera, and for a point that is not finite.
    pub fn through(camera: &Camera, [x, y]: [f32; 2]) -> Result<Self, InputError> {
        camera.validate()?;
        for (path, value) in [("pixel[0]", x), ("pixel[1]", y)] {
            if !value.is_finite() {
                return Err(InputError::new(path, value, "must be finite"));
            }
        }
        let [width, height] = camera.viewport.map(f64::from);
        let [right, up] = [2.0 * f64::from(x) / width - 1.0, 1.0 - 2.0 * f64::from(y) / height];
        let world_from_clip: DMat4 =
            (camera.clip_from_view.as_dmat4() * camera.view_from_cell.as_dmat4()).inverse();
        let point = |depth: f64| world_from_clip.project_point3(DVec3::new(right, up, depth));
        let near = point(if camera.depth == Depth::Reversed { 1.0 } else { 0.0 });
        Ok(Self { cell: camera.cell, ..Self::new(near, point(0.5) - near) })
    }

    /// Checks the ray's fields.
    ///
    /// # Errors
    /// [`InputError`] for a position or a direction that is not finite, a direction of length 0, and a negative limit.
    pub fn validate(&self) -> Result<(), InputError> {
        InputError::check(self.offset.is_finite(), "ray.offset", self.offset, || "must be finite")?;
        let bound = || "must be finite, with a length that f64 can hold, and not 0";
        InputError::check(self.direction.try_normalize().is_some(), "ray.direction", self.direction, bound)?;
        // A NaN limit fails this comparison.
        if self.limit >= 0.0 {
            return Ok(());
        }
        Err(InputError::new("ray.limit", self.limit, "must be at least 0"))
    }
}

/// Triangles on the host, in model space.
#[derive(Debug, Clone)]
pub(super) struct Surface<'a> {
    positions: Cow<'a, [[f32; 3]]>,
    /// Parts of the surface: triangle indices, and whether both sides of the triangles are visible.
    parts: Vec<(&'a [u32], bool)>,
}

/// A hit on a surface: its distance, and the triangle's normal, which may have any length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SurfaceHit {
    pub distance: f64,
    pub normal: DVec3,
}

impl SurfaceHit {
    /// The nearer of two hits; `None` if there is neither.
    pub fn nearer(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        let all = one.into_iter().chain(other);
        all.reduce(|one, other| if other.distance < one.distance { other } else { one })
    }
}

impl<'a> Surface<'a> {
    /// A surface whose triangles are either all double-sided or all single-sided.
    pub fn new(positions: impl Into<Cow<'a, [[f32; 3]]>>, indices: &'a [u32], double_sided: bool) -> Self {
        Self { positions: positions.into(), parts: vec![(indices, double_sided)] }
    }

    /// A merged mesh in full detail, with the given vertex positions.
    pub fn of_merged(merged: &'a Merged, mesh: usize, positions: impl Into<Cow<'a, [[f32; 3]]>>) -> Self {
        let own = merged.parts.iter().filter(|part| part.mesh == mesh);
        let indices = &merged.model.meshes[mesh].indices;
        let part = |range: &std::ops::Range<u32>| &indices[range.start as usize..range.end as usize];
        let parts = own.map(|part_of| (part(&part_of.indices[0]), part_of.key.double_sided)).collect();
        Self { positions: positions.into(), parts }
    }

    /// The lowest and highest corner of a box around the surface after the transform `placed`.
    pub fn bounds(&self, placed: DAffine3) -> [DVec3; 2] {
        let corners = self.positions.iter().map(|corner| placed.transform_point3(point(*corner)));
        corners.fold([DVec3::MAX, DVec3::MIN], |[low, high], corner| [low.min(corner), high.max(corner)])
    }

    /// The nearest hit of a ray on the surface after the transform `placed`, at a distance of at most `limit`. The
    /// direction must have length 1. Single-sided triangles are hit only from their visible side.
    pub fn hit(&self, placed: DAffine3, [at, direction]: [DVec3; 2], limit: f64) -> Option<SurfaceHit> {
        let corners: Vec<DVec3> =
            self.positions.iter().map(|corner| placed.transform_point3(point(*corner)) - at).collect();
        let side = if placed.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
        let mut nearest: Option<SurfaceHit> = None;
        for (indices, double_sided) in &self.parts {
            for triangle in indices.as_chunks::<3>().0 {
                let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
                let normal = side * (b - a).cross(c - a);
                if !double_sided && normal.dot(direction) >= 0.0 {
                    continue;
                }
                let farthest = nearest.map_or(limit, |hit| hit.distance);
                let found = distance_to([a, b, c], direction).filter(|distance| *distance <= farthest);
                nearest = found.map(|distance| SurfaceHit { distance, normal }).or(nearest);
            }
        }
        nearest
    }
}

fn point(position: [f32; 3]) -> DVec3 {
    DVec3::from(position.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_are_hit_where_they_are_seen() {
        let surface =
            Surface::new(vec![[0.0, 0.0, -2.0], [2.0, 0.0, -2.0], [0.0, 2.0, -2.0]], &[0, 1, 2], false);
        let ray = [DVec3::new(0.5, 0.5, 0.0), DVec3::NEG_Z];
        let hit = |placed: DAffine3, ray: [DVec3; 2], limit: f64| {
            surface.hit(placed, ray, limit).map(|hit| hit.distance)
        };
        assert_eq!(hit(DAffine3::IDENTITY, ray, 9.0), Some(2.0));
        assert_eq!(hit(DAffine3::IDENTITY, ray, 1.9), None, "beyond the limit");
        assert_eq!(hit(DAffine3::from_translation(DVec3::NEG_Z), ray, 9.0), Some(3.0));
        let behind = [DVec3::new(0.5, 0.5, -9.0), DVec3::Z];
        assert_eq!(hit(DAffine3::IDENTITY, behind, 9.0), None, "from behind");
        let mirrored = DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
        assert_eq!(hit(mirrored, [DVec3::new(0.5, 0.5, 9.0), DVec3::NEG_Z], 9.0), None, "the inner side");
        assert_eq!(hit(mirrored, [DVec3::new(0.5, 0.5, 0.0), DVec3::Z], 9.0), Some(2.0));
    }

    #[test]
    fn rays_are_checked_field_by_field() {
        let good = Ray::new([0.0, 1.0, 0.0], [0.0, -2.0, 0.0]);
        let refused = |ray: Ray| ray.validate().expect_err("refused").path;
        assert!(good.validate().is_ok());
        assert_eq!(refused(Ray { offset: DVec3::NAN, ..good }), "ray.offset");
        assert_eq!(refused(Ray { direction: DVec3::ZERO, ..good }), "ray.direction");
        assert_eq!(refused(Ray { limit: f64::NAN, ..good }), "ray.limit");
    }

    #[test]
    fn rays_go_through_pixels() {
        let eye = glam::Vec3::new(3.0, 12.0, 16.0);
        let camera = Camera::looking_at(eye, glam::Vec3::ZERO, 0.9, [0.5, 400.0], [200, 100]);
        let middle = Ray::through(&camera, [100.0, 50.0]).expect("a pixel");
        let ahead = (-eye).as_dvec3().normalize();
        assert!(middle.direction.normalize().distance(ahead) < 1e-5);
        assert!((middle.world() - eye.as_dvec3()).length() < 0.501);
        let corner = Ray::through(&camera, [0.0, 0.0]).expect("a pixel");
        let up = ahead.cross(DVec3::Y).normalize().cross(ahead);
        // The corner is half the field of view above the middle, and twice as far to the side.
        let rise = corner.direction.normalize().dot(up) / corner.direction.normalize().dot(ahead);
        assert!((rise - 0.45_f64.tan()).abs() < 1e-5, "{rise}");
        assert_eq!(Ray::through(&camera, [f32::NAN, 0.0]).expect_err("refused").path, "pixel[0]");
    }
}
