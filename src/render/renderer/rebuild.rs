//! Rebuilding a renderer on another device after its device was lost.

use super::{Renderer, Shading};
use crate::gpu::Gpu;
use crate::scene::{Rebuild, Scene};
use crate::{Error, InputError};

impl Rebuild for Renderer {
    fn rebuild_for(&mut self, scene: &Scene) -> Result<(), Error> {
        self.rebuild(scene.gpu())
    }
}

impl Renderer {
    /// Compiles the renderer's pipelines again on another device, after its device was lost. The scene must also be
    /// rebuilt on that device ([`Scene::rebuild`](crate::scene::Scene::rebuild)).
    ///
    /// # Errors
    /// [`InputError`] for the caller's shading with a bind group layout, because the layout was lost with the device
    /// ([`Renderer::rebuild_with_layout`]). Errors of the driver's shader compiler. After an error, the renderer is unchanged.
    pub fn rebuild(&mut self, gpu: &Gpu) -> Result<(), Error> {
        if self.shading.as_ref().is_some_and(|shading| shading.layout.is_some()) {
            let bound = "must be given again, of the new device: Renderer::rebuild_with_layout";
            return Err(InputError::new("shading.layout", "of the lost device", bound).into());
        }
        self.remake(gpu, self.shading.clone())
    }

    /// Same as [`Renderer::rebuild`], with a layout of the new device for bind group 3 of the caller's shading
    /// ([`Renderer::with_shading`]).
    ///
    /// # Errors
    /// The errors of [`Renderer::with_shading`] for the layout; [`InputError`] for a renderer without the caller's shading. After
    /// an error, the renderer is unchanged.
    pub fn rebuild_with_layout(&mut self, gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> Result<(), Error> {
        let Some(shading) = &self.shading else {
            return Err(InputError::new("shading", "none", "must be there where a layout is given").into());
        };
        self.remake(gpu, Some(shading.clone().with_layout(layout)))
    }

    fn remake(&mut self, gpu: &Gpu, shading: Option<Shading>) -> Result<(), Error> {
        let mut fresh = Self::new(gpu, &self.format)?;
        if let Some(shading) = &shading {
            shading.check_layout(gpu, &fresh.format, &fresh.layouts)?;
        }
        fresh.shading = shading;
        fresh.casts = self.casts;
        self.pipelines.keys().try_for_each(|key| fresh.compile(key.clone()))?;
        *self = fresh;
        Ok(())
    }
}
