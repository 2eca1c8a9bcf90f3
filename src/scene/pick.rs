//! Picking on the host: the first instance that a ray hits.

use glam::{DAffine3, DVec3};

use crate::InputError;
use crate::scene::Scene;
use crate::scene::handles::InstanceId;
use crate::scene::matrices::placed_model;
use crate::scene::object::Object;
use crate::scene::object_kind::{Placed, UnitRay};
use crate::scene::ray::{Hit, Ray, SurfaceHit};
use crate::shared::lod::instance::{INSTANCE_ALIVE, instance_flags_mask};

/// Relative enlargement of boxes and spheres. It exceeds the rounding errors of drawn positions, which are `f32`.
pub(super) const MARGIN: f64 = 1e-5;

impl Scene {
    /// The first hit of a ray on an instance; `None` if the ray hits nothing. Instances are tested in full detail, in
    /// the pose at the scene's time. Hidden objects are not hit. Triangles are hit only from their visible sides. A
    /// relief is hit at its mesh, without the relief's depth. Cut-out pixels are hit like the rest of the mesh.
    ///
    /// Driven bones ([`Scene::drive`]) have the values that [`Poses::write`](crate::scene::Poses::write) wrote in the
    /// last frame. All other bones have the pose of their clip at the scene's time. This includes bones that the
    /// caller's kernels wrote ([`Poses::of`](crate::scene::Poses::of)), because the host does not know their values.
    ///
    /// The host first tests the bounding sphere of each instance. If the ray meets the sphere, the host tests every
    /// triangle of a mesh, or the terrain cells below the ray. A character's vertices are all posed and skinned first,
    /// which takes about a quarter of a microsecond per vertex. Nearer spheres are tested first. Spheres behind the
    /// nearest hit are skipped.
    ///
    /// # Errors
    /// [`InputError`] if [`Ray::validate`] refuses the ray.
    ///
    /// # Examples
    ///
    /// Prints the instance under the pointer.
    ///
    /// ```no_run
    /// # use relievo::scene::{Camera, Ray, Scene};
    /// # fn example(scene: &mut Scene, camera: &Camera, pointer: [f32; 2]) -> Result<(), relievo::Error> {
    /// if let Some(hit) = scene.pick(&Ray::through(camera, pointer)?)? {
    ///     println!("{:?} at {}, {} units away", hit.instance, hit.world(), hit.distance);
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn pick(&self, ray: &Ray) -> Result<Option<Hit>, InputError> {
        ray.validate()?;
        let direction = ray.direction.normalize();
        let mut near = self.spheres_near(ray, direction)?;
        near.sort_by(|one, other| one.distance.total_cmp(&other.distance));
        let mut first: Option<(SurfaceHit, InstanceId)> = None;
        for candidate in near {
            let farthest = first.map_or(ray.limit, |(hit, _)| hit.distance);
            if candidate.distance > farthest {
                break;
            }
            let InstanceId { index, .. } = candidate.instance;
            let placed = self.placed(candidate.instance, ray.cell)?;
            let placed = candidate.entry.placed(index, self.now, placed, ray.cell);
            let ray = UnitRay { origin: ray.offset, direction, limit: farthest };
            let found = candidate.entry.kind.hit(&placed, &ray)?;
            first = found.map(|hit| (hit, candidate.instance)).or(first);
        }
        Ok(first.map(|(hit, instance)| Hit {
            instance,
            object: instance.object,
            distance: hit.distance,
            cell: ray.cell,
            offset: ray.offset + hit.distance * direction,
            normal: hit.normal.normalize_or_zero(),
        }))
    }

    /// An instance's transform from model space to world axes, relative to a cell's corner.
    pub(super) fn placed(&self, instance: InstanceId, cell: [i32; 3]) -> Result<DAffine3, InputError> {
        if let Some(placed) = self.attached_placed(instance, cell)? {
            return Ok(placed);
        }
        let object = self.object_of(instance)?;
        Ok(placed_model(&object.instances.all()[instance.index as usize], cell))
    }

    /// The instances whose bounding spheres the ray meets within its limit.
    fn spheres_near(&self, ray: &Ray, direction: DVec3) -> Result<Vec<Candidate<'_>>, InputError> {
        let mut near = Vec::new();
        for (object, entry) in self.objects.each().filter(|(_, entry)| entry.is_drawn()) {
            for [index, generation] in entry.instances.each() {
                let instance = &entry.instances.all()[index as usize];
                if instance.flags & INSTANCE_ALIVE == 0
                    || instance_flags_mask(instance.flags) & u32::from(ray.mask) == 0
                {
                    continue;
                }
                let placed = placed_model(instance, ray.cell);
                let (center, radius) =
                    entry.sphere_around(&entry.placed(index, self.now, placed, ray.cell))?;
                let slack = MARGIN * (radius + placed.translation.length());
                let towards = center - ray.offset;
                if let Some(distance) = distance_to_sphere(towards, direction, radius + slack)
                    && distance <= ray.limit
                {
                    let instance = InstanceId { object, index, generation };
                    near.push(Candidate { distance, instance, entry });
                }
            }
        }
        Ok(near)
    }
}

/// An instance whose bounding sphere the ray meets. The ray cannot hit the instance nearer than `distance`.
struct Candidate<'a> {
    distance: f64,
    instance: InstanceId,
    entry: &'a Object,
}

/// The distance from the origin to a sphere along a unit direction. It is 0 inside the sphere, and `None` if the sphere
/// is missed.
fn distance_to_sphere(center: DVec3, direction: DVec3, radius: f64) -> Option<f64> {
    let along = center.dot(direction);
    let aside = (center - along * direction).length_squared();
    let inside = radius * radius - aside;
    if inside < 0.0 || along + inside.sqrt() < 0.0 {
        return None;
    }
    Some((along - inside.sqrt()).max(0.0))
}

impl Object {
    /// The center and radius of a sphere around an instance.
    fn sphere_around(&self, instance: &Placed) -> Result<(DVec3, f64), InputError> {
        if self.kind.may_leave_sphere(instance.index)
            && let Some([low, high]) = self.kind.wide_box(instance)?
        {
            return Ok(((low + high) / 2.0, low.distance(high) / 2.0));
        }
        let [low, high] = instance.sphere_box;
        Ok(((low + high) / 2.0, (high.x - low.x) / 2.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_are_met_ahead() {
        let ahead = |center: [f64; 3]| distance_to_sphere(DVec3::from(center), DVec3::X, 1.0);
        assert_eq!((ahead([3.0, 0.0, 0.0]), ahead([0.5, 0.0, 0.0])), (Some(2.0), Some(0.0)));
        assert_eq!((ahead([-3.0, 0.0, 0.0]), ahead([3.0, 1.1, 0.0])), (None, None));
    }
}
