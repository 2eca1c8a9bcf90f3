//! Bounding boxes of instances, computed on the host.

use glam::{DAffine3, DVec3};

use crate::InputError;
use crate::scene::Scene;
use crate::scene::handles::InstanceId;
use crate::scene::object::Object;
use crate::scene::object_kind::Placed;
use crate::scene::pick::MARGIN;
use crate::scene::placement::Placement;

/// Margin for rounding around a box of vertices. It is a fraction of the box's diagonal or of the instance's distance from
/// the cell's corner, whichever is larger. The host computes a vertex with a few products in `f32`, each with a relative
/// error of 6e-8.
const TIGHT: f64 = 1e-6;

/// An axis-aligned box in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The cell whose corner is the origin of `low_offset` and `high_offset`.
    pub cell: [i32; 3],
    /// The smallest x, y and z of the box in world units, relative to the cell's corner.
    pub low_offset: DVec3,
    /// The largest x, y and z of the box in world units, relative to the cell's corner.
    pub high_offset: DVec3,
}

impl Bounds {
    /// Two opposite corners of the box in world coordinates: the smallest x, y and z, then the largest.
    pub fn world(&self) -> [DVec3; 2] {
        [self.low_offset, self.high_offset].map(|offset| Placement::corner(self.cell) + offset)
    }
}

impl Scene {
    /// A box that encloses an instance, in the pose at the scene's time. The box may be larger than necessary;
    /// [`Scene::tight_bounds`] returns the smallest box.
    ///
    /// - Mesh: the smallest box, at the cost of one transform per vertex.
    /// - Character: a box around one ball per bone. Each ball is centred on its bone's joint and holds all vertices that
    ///   follow the bone. The box therefore extends below the feet. The host samples the bones, which takes a few
    ///   microseconds for a hundred bones.
    /// - Patch of terrain: a box around the patch's bounding sphere.
    ///
    /// Bones that the host wrote in the last frame keep the written values, as in [`Scene::pick`]. The drawn instance may
    /// deviate by up to [`Quality::pixels`](crate::scene::Quality), so it may reach beyond the box.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    ///
    /// # Examples
    ///
    /// A camera that frames an instance.
    ///
    /// ```no_run
    /// # use relievo::scene::{Camera, InstanceId, Scene, View};
    /// # fn example(scene: &Scene, view: &mut View, fox: InstanceId) -> Result<(), relievo::Error> {
    /// let [low, high] = scene.bounds(fox)?.world();
    /// view.set(Camera::framing(low, high, [960, 540]))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn bounds(&self, instance: InstanceId) -> Result<Bounds, InputError> {
        let placed = self.placed_instance(instance)?;
        match self.object_of(instance)?.kind.wide_box(&placed)? {
            Some(corners) => Ok(placed.enlarged(corners, MARGIN)),
            None => Ok(placed.enlarged(self.object_of(instance)?.kind.tight_box(&placed)?, TIGHT)),
        }
    }

    /// The smallest box around an instance, in full detail and in the pose at the scene's time. A character's feet are at
    /// the bottom of this box.
    ///
    /// The cost for a mesh is one transform per vertex. A character is posed and skinned, which takes about a quarter of a
    /// microsecond per vertex. For a patch of terrain, the host scans the heights that [`Scene::ground`] uses; if the
    /// heights are unknown, it returns the box of [`Scene::bounds`].
    ///
    /// Bones that the host wrote in the last frame keep the written values, as in [`Scene::pick`]. The drawn instance may
    /// deviate by up to [`Quality::pixels`](crate::scene::Quality), so it may reach beyond the box.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    ///
    /// # Examples
    ///
    /// A name above a head.
    ///
    /// ```no_run
    /// # use glam::DVec3;
    /// # use relievo::scene::{InstanceId, Scene};
    /// # fn example(scene: &Scene, fighter: InstanceId, label: impl Fn(DVec3)) -> Result<(), relievo::Error> {
    /// let [low, high] = scene.tight_bounds(fighter)?.world();
    /// label(DVec3::new((low.x + high.x) / 2.0, high.y + 0.2, (low.z + high.z) / 2.0));
    /// # Ok(())
    /// # }
    /// ```
    pub fn tight_bounds(&self, instance: InstanceId) -> Result<Bounds, InputError> {
        let placed = self.placed_instance(instance)?;
        let corners = self.object_of(instance)?.kind.tight_box(&placed)?;
        Ok(placed.enlarged(corners, TIGHT))
    }

    /// An instance with its transform to world axes, relative to the corner of its cell.
    fn placed_instance(&self, instance: InstanceId) -> Result<Placed, InputError> {
        let object = self.object_of(instance)?;
        let cell = object.instances.all()[instance.index as usize].cell;
        Ok(object.placed(instance.index, self.now, self.placed(instance, cell)?, cell))
    }
}

impl Placed {
    /// The box with the corners `low` and `high`, enlarged for rounding. `margin` is a fraction of the box's diagonal or of
    /// the instance's distance from the cell's corner, whichever is larger.
    fn enlarged(&self, [low, high]: [DVec3; 2], margin: f64) -> Bounds {
        let slack = margin * (high - low).length().max(self.place.translation.length());
        Bounds { cell: self.cell, low_offset: low - slack, high_offset: high + slack }
    }
}

impl Object {
    /// The instance `index` at scene time `now`. `place` is its transform to world axes, relative to the corner of `cell`.
    pub(super) fn placed(&self, index: u32, now: f64, place: DAffine3, cell: [i32; 3]) -> Placed {
        let instance = &self.instances.all()[index as usize];
        let [x, y, z, radius] = instance.bounding_sphere.map(f64::from);
        let middle = place.transform_point3(DVec3::new(x, y, z));
        let radius = radius * f64::from(instance.largest_scale());
        Placed { index, now, place, cell, sphere_box: [middle - radius, middle + radius] }
    }
}
