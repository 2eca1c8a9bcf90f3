//! A renderer on another device, after its own was lost.

use super::Renderer;
use crate::gpu::Gpu;
use crate::scene::{Rebuild, Scene};
use crate::{Error, InputError};

impl Rebuild for Renderer {
    fn rebuild_for(&mut self, scene: &Scene) -> Result<(), Error> {
        self.rebuild(scene.gpu())
    }
}

impl Renderer {
    /// Compiles its pipelines again on another device, after its own was lost; the scene is rebuilt there too
    /// ([`Scene::rebuild`](crate::scene::Scene::rebuild)).
    ///
    /// # Errors
    /// [`InputError`] for the caller's shading with a bind group layout, which the lost device takes with it: make a new renderer
    /// with the layout of the new device. What the driver's compiler reports. In either case the renderer is as it was.
    pub fn rebuild(&mut self, gpu: &Gpu) -> Result<(), Error> {
        if self.shading.as_ref().is_some_and(|shading| shading.layout.is_some()) {
            let bound = "must be given again, to a new renderer, with a layout of the new device";
            return Err(InputError::new("shading.layout", "of the lost device", bound).into());
        }
        let mut fresh = Self::new(gpu, &self.format)?;
        fresh.shading.clone_from(&self.shading);
        fresh.casts = self.casts;
        self.pipelines.keys().try_for_each(|key| fresh.compile(*key))?;
        *self = fresh;
        Ok(())
    }
}
