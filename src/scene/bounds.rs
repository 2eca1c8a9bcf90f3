//! Boxes around instances, computed on the host.

use glam::{DAffine3, DVec3};

use crate::InputError;
use crate::scene::Scene;
use crate::scene::handles::InstanceId;
use crate::scene::object::{Object, ObjectKind};
use crate::scene::pick::MARGIN;
use crate::scene::placement::Placement;
use crate::scene::ray::Surface;

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
        let object = self.object_of(instance)?;
        match &object.kind {
            ObjectKind::Terrain(_) | ObjectKind::Own(_) => {
                self.around(instance, MARGIN, |placed| Ok(object.box_of_sphere(instance.index, placed)))
            }
            ObjectKind::Character(character) => self.around(instance, MARGIN, |placed| {
                Ok(character.bounds(&character.pose(instance.index, self.now)?, placed))
            }),
            ObjectKind::Mesh(_) => self.tight_bounds(instance),
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
        let object = self.object_of(instance)?;
        self.around(instance, TIGHT, |placed| {
            let around = |surfaces: Vec<Surface<'_>>| {
                let boxes = surfaces.iter().map(|surface| surface.bounds(placed));
                boxes.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)])
            };
            let found = match &object.kind {
                ObjectKind::Mesh(mesh) => around(mesh.surfaces()),
                ObjectKind::Character(character) => around(character.surface(instance.index, self.now)?),
                ObjectKind::Own(_) => Some(object.box_of_sphere(instance.index, placed)),
                ObjectKind::Terrain(terrain) => {
                    let known = terrain.bounds(instance.index, placed.translation);
                    known.or_else(|| Some(object.box_of_sphere(instance.index, placed)))
                }
            };
            Ok(found.unwrap_or([placed.translation; 2]))
        })
    }

    /// The box of an instance from its corners, which are computed from the transform to the corner of the instance's
    /// cell, and enlarged by what rounding moves.
    fn around(
        &self,
        instance: InstanceId,
        margin: f64,
        corners: impl FnOnce(DAffine3) -> Result<[DVec3; 2], InputError>,
    ) -> Result<Bounds, InputError> {
        let cell = self.object_of(instance)?.instances.all()[instance.index as usize].cell;
        let placed = self.placed(instance, cell)?;
        let [low, high] = corners(placed)?;
        let slack = margin * (high - low).length().max(placed.translation.length());
        Ok(Bounds { cell, low_offset: low - slack, high_offset: high + slack })
    }
}

impl Object {
    /// The corners of a box around the bounding sphere of an instance.
    fn box_of_sphere(&self, index: u32, placed: DAffine3) -> [DVec3; 2] {
        let instance = &self.instances.all()[index as usize];
        let [x, y, z, radius] = instance.bounding_sphere.map(f64::from);
        let middle = placed.transform_point3(DVec3::new(x, y, z));
        let radius = radius * f64::from(instance.largest_scale());
        [middle - radius, middle + radius]
    }
}
