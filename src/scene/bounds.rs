//! Boxes around instances, computed on the host.

use glam::{DAffine3, DVec3};

use crate::InputError;
use crate::scene::Scene;
use crate::scene::handles::InstanceId;
use crate::scene::object::Object;
use crate::scene::object_kind::Placed;
use crate::scene::pick::MARGIN;
use crate::scene::placement::Placement;

/// By how much a box of vertices is enlarged, relative to its size or to its distance from the cell's corner: the host rounds a
/// vertex to `f32` in a few products, each by 6e-8.
const TIGHT: f64 = 1e-6;

/// A box along the axes of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The cell to whose corner the box's corners are relative.
    pub cell: [i32; 3],
    /// The smallest x, y and z in world units, relative to the cell's corner.
    pub low_offset: DVec3,
    /// The largest x, y and z in world units, relative to the cell's corner.
    pub high_offset: DVec3,
}

impl Bounds {
    /// The corners with the smallest and the largest x, y and z, in world coordinates.
    pub fn world(&self) -> [DVec3; 2] {
        [self.low_offset, self.high_offset].map(|offset| Placement::corner(self.cell) + offset)
    }
}

impl Scene {
    /// A box that encloses an instance as it stands now, in the pose of the time of the scene, and may be larger than
    /// necessary; [`Scene::tight_bounds`] is the smallest.
    ///
    /// The box of a mesh is the smallest, and costs a transform of each of its vertices. That of a character holds a ball around
    /// each bone in which the vertices stay that follow it, so that it begins below the feet. It takes sampling
    /// the bones on the host (some microseconds for a hundred bones). That of a patch of terrain holds a sphere around
    /// it. Bones that were written in the last frame count as in [`Scene::pick`]. What is drawn may be off by what
    /// [`Quality::pixels`](crate::scene::Quality) allows, and may thus reach beyond the box.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn bounds(&self, instance: InstanceId) -> Result<Bounds, InputError> {
        let placed = self.placed_instance(instance)?;
        match self.object_of(instance)?.kind.wide_box(&placed)? {
            Some(corners) => Ok(placed.enlarged(corners, MARGIN)),
            None => self.tight_bounds(instance),
        }
    }

    /// The smallest box around an instance as it stands now, in the pose of the time of the scene and in full detail. A character
    /// touches the ground where this box ends.
    ///
    /// It costs a transform of each vertex of a mesh, and posing and skinning each vertex of a character, about a
    /// quarter of a microsecond a vertex. For a patch of terrain it goes through the heights that
    /// [`Scene::ground`] answers by, and where these are unknown, the box is that of [`Scene::bounds`]. Bones that were written in the
    /// last frame count as in [`Scene::pick`]. What is drawn may be off as [`Scene::bounds`] says.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn tight_bounds(&self, instance: InstanceId) -> Result<Bounds, InputError> {
        let placed = self.placed_instance(instance)?;
        let corners = self.object_of(instance)?.kind.tight_box(&placed)?;
        Ok(placed.enlarged(corners, TIGHT))
    }

    /// An instance in its place, relative to the corner of its cell.
    fn placed_instance(&self, instance: InstanceId) -> Result<Placed, InputError> {
        let object = self.object_of(instance)?;
        let cell = object.instances.all()[instance.index as usize].cell;
        Ok(object.placed(instance.index, self.now, self.placed(instance, cell)?, cell))
    }
}

impl Placed {
    /// A box of these corners, enlarged by what rounding moves.
    fn enlarged(&self, [low, high]: [DVec3; 2], margin: f64) -> Bounds {
        let slack = margin * (high - low).length().max(self.place.translation.length());
        Bounds { cell: self.cell, low_offset: low - slack, high_offset: high + slack }
    }
}

impl Object {
    /// An instance in a place.
    pub(super) fn placed(&self, index: u32, now: f64, place: DAffine3, cell: [i32; 3]) -> Placed {
        let instance = &self.instances.all()[index as usize];
        let [x, y, z, radius] = instance.bounding_sphere.map(f64::from);
        let middle = place.transform_point3(DVec3::new(x, y, z));
        let radius = radius * f64::from(instance.largest_scale());
        Placed { index, now, place, cell, sphere_box: [middle - radius, middle + radius] }
    }
}
