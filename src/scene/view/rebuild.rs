//! Rebuilding a view on another device, after the scene's device was lost.

use super::View;
use crate::scene::handles::foreign;
use crate::scene::{Rebuild, Scene};
use crate::{Error, InputError};

impl Rebuild for View {
    fn rebuild_for(&mut self, scene: &Scene) -> Result<(), Error> {
        self.rebuild(scene)
    }
}

impl View {
    /// Recreates all device resources of the view after its scene was rebuilt on another device ([`Scene::rebuild_async`]).
    /// Cameras, quality and mask stay; a sun's shadow must be fitted again.
    ///
    /// # Errors
    /// [`InputError`] for a view of another scene; [`crate::gpu::GpuError`].
    pub fn rebuild(&mut self, scene: &Scene) -> Result<(), Error> {
        if !self.is_of(scene.objects.scene()) {
            return Err(InputError::new("scene", "another", "must be the one that the view is of").into());
        }
        let fresh = Self::new(&scene.gpu, scene.objects.scene(), scene.device, self.quality)?;
        let Self { device, select, drawn, .. } = fresh;
        (self.device, self.select, self.drawn) = (device, select, drawn);
        (self.lists, self.counts, self.recorded, self.last) = (None, None, None, None);
        // The shadow map belonged to the lost device.
        self.shadow = None;
        Ok(())
    }

    /// Refuses a view that does not belong to the scene's present device; `path` names the view in the error.
    pub(crate) fn check(&self, scene: &Scene, path: &str) -> Result<(), InputError> {
        if !self.is_of(scene.objects.scene()) {
            return Err(foreign(path));
        }
        if self.device != scene.device {
            let bound = format!("must be rebuilt after its scene: {}", self.remade_by);
            return Err(InputError::new(path, "of a device that was lost", bound));
        }
        Ok(())
    }
}
