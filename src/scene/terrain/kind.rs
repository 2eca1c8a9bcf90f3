//! Terrain as a kind of object.

use std::any::Any;

use glam::DVec3;

use super::in_view::TerrainInView;
use super::{Morphing, Terrain, made};
use crate::animation::Frame;
use crate::gpu::{Gpu, Staged};
use crate::scene::chunk::Chunk;
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::{KindInView, Made, MakeOn, Making, ObjectKind, OnDevice, Placed, UnitRay};
use crate::scene::placement::Placement;
use crate::scene::ray::SurfaceHit;
use crate::{Error, InputError};

impl Terrain {
    /// Checks that the terrain can be made again on another device.
    ///
    /// # Errors
    /// [`InputError`] for terrain made from fields, because they were on the lost device.
    fn check_can_be_rebuilt(&self) -> Result<(), InputError> {
        match self.source.fields() {
            None => Ok(()),
            Some(_) => {
                let bound = "must be removed before, and added again with fields on the new device";
                Err(InputError::new("terrain", "made from fields on the lost device", bound))
            }
        }
    }
}

impl ObjectKind for Terrain {
    fn name(&self) -> &'static str {
        "terrain"
    }

    /// The caller does not spawn instances: the patches are the instances.
    fn is_spawned(&self) -> bool {
        false
    }

    /// Terrain does not grow. Only the blend of two recipes is computed again.
    fn renew(&mut self, _: MakeOn<'_>, _: &mut Vec<Chunk>) -> Result<(), Error> {
        self.morphing.iter_mut().for_each(Morphing::refresh);
        Ok(())
    }

    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a> {
        let MakeOn { gpu, layouts, .. } = target;
        Box::pin(async move {
            self.check_can_be_rebuilt()?;
            let (terrain, _, (chunks, _)) = made(gpu, layouts, &self.source).await?;
            Ok(OnDevice { chunks, other: Box::new(terrain.morphing) })
        })
    }

    fn adopt(&mut self, other: Box<dyn Made>) {
        let other: Box<dyn Any> = other;
        if let Ok(morphing) = other.downcast() {
            self.morphing = *morphing;
        }
    }

    fn in_view(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        number: u32,
    ) -> Result<Option<Box<dyn KindInView>>, Error> {
        Ok(Some(Box::new(TerrainInView::new(gpu, layouts, self.spacing, number)?)))
    }

    fn stage(&mut self, staged: &mut Staged, _: &Frame, _: f64) -> Result<(), Error> {
        self.morphing.iter().try_for_each(|morphing| morphing.stage(staged))
    }

    fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.morphing.iter_mut().for_each(|morphing| morphing.record(encoder));
    }

    /// The first hit of a ray on a patch. Both sides of the ground are visible, so both can be hit.
    fn hit(&self, instance: &Placed, ray: &UnitRay) -> Result<Option<SurfaceHit>, InputError> {
        let Some(patch) = self.source.patches.get(instance.index as usize) else { return Ok(None) };
        let [x, z] = patch.map(|index| f64::from(index) * self.edge);
        let origin = ray.origin + (Placement::corner(instance.cell) - DVec3::new(x, 0.0, z));
        let hit = self.ground.hit(*patch, [origin, ray.direction], ray.limit);
        Ok(hit.map(|hit| SurfaceHit { distance: hit.distance, normal: hit.normal }))
    }

    /// A box between the lowest and the highest point of a patch. If the host does not know the heights, the box
    /// contains the patch's bounding sphere.
    fn tight_box(&self, instance: &Placed) -> Result<[DVec3; 2], InputError> {
        let patch = self.source.patches.get(instance.index as usize);
        let extremes = patch.and_then(|patch| self.ground.extremes(*patch));
        let (middle, half) = (instance.place.translation, DVec3::new(self.edge / 2.0, 0.0, self.edge / 2.0));
        let known = |[lowest, highest]: [f64; 2]| {
            [middle - half + DVec3::Y * lowest, middle + half + DVec3::Y * highest]
        };
        Ok(extremes.map_or(instance.sphere_box, known))
    }

    fn wide_box(&self, instance: &Placed) -> Result<Option<[DVec3; 2]>, InputError> {
        Ok(Some(instance.sphere_box))
    }
}
