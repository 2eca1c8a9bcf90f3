//! Rebuilds a scene on another device, after the scene's own device was lost.

use crate::Error;
use crate::gpu::{Gpu, Staged, StagingRing};
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::OnDevice;
use crate::scene::statistics::StageTimer;
use crate::scene::{FRAMES_IN_FLIGHT, Passes, Scene};

/// A type whose device resources can be recreated after the scene's device was lost: a [`View`](crate::scene::View), a
/// [`Renderer`](crate::render::Renderer), a [`SunShadow`](crate::render::SunShadow), or a type of the caller.
pub trait Rebuild {
    /// Recreates all device resources on the new device of a rebuilt scene.
    ///
    /// # Errors
    /// The errors of the type's own function `rebuild`.
    fn rebuild_for(&mut self, scene: &Scene) -> Result<(), Error>;
}

impl Scene {
    /// Rebuilds the scene on another device ([`Scene::rebuild`]), then the views, shadows and renderers in `parts`, one
    /// after the other. The next use of a part that was left out returns an error, which names the function that
    /// rebuilds this part.
    ///
    /// A renderer with the caller's bind group layout needs a layout of the new device. Leave such a renderer out here,
    /// and call [`Renderer::rebuild_with_layout`].
    ///
    /// [`Renderer::rebuild_with_layout`]: crate::render::Renderer::rebuild_with_layout
    ///
    /// # Errors
    /// - If [`Scene::rebuild`] fails, its error. Nothing has changed.
    /// - If a part fails, the error of that part, with a path that starts with `parts[0]`, `parts[1]` and so on. The
    ///   scene and the parts before the failed part are rebuilt; all other parts are not.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::gpu::{Gpu, GpuError};
    /// # use relievo::render::{Renderer, SunShadow};
    /// # use relievo::scene::{Scene, View};
    /// # fn open() -> Gpu { unimplemented!() }
    /// # fn frame(
    /// #     (mut scene, mut eye, mut shadow, mut renderer): (Scene, View, SunShadow, Renderer),
    /// # ) -> Result<(), relievo::Error> {
    /// if let Err(GpuError::DeviceLost { .. }) = scene.health() {
    ///     let gpu = open(); // a new device, of the same wgpu::Instance or of another one
    ///     scene.rebuild_all(&gpu, &mut [&mut eye, &mut shadow, &mut renderer])?;
    /// }
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(not(target_arch = "wasm32"))]
    pub fn rebuild_all(&mut self, gpu: &Gpu, parts: &mut [&mut dyn Rebuild]) -> Result<(), Error> {
        self.rebuild(gpu)?;
        self.rebuild_parts(parts)
    }

    /// Like `Scene::rebuild_all`, but the future completes once the device has reported its errors; see
    /// [`Gpu::wait_async`].
    ///
    /// # Errors
    /// As for `Scene::rebuild_all`.
    pub async fn rebuild_all_async(
        &mut self,
        gpu: &Gpu,
        parts: &mut [&mut dyn Rebuild],
    ) -> Result<(), Error> {
        self.rebuild_async(gpu).await?;
        self.rebuild_parts(parts)?;
        Ok(gpu.check_async().await?)
    }

    fn rebuild_parts(&self, parts: &mut [&mut dyn Rebuild]) -> Result<(), Error> {
        for (at, part) in parts.iter_mut().enumerate() {
            part.rebuild_for(self).map_err(|error| match error {
                Error::Input(error) => error.below(&format!("parts[{at}]")).into(),
                other => other,
            })?;
        }
        Ok(())
    }

    /// Recreates the scene's device resources on another device, after the scene's own device was lost. Handles stay
    /// valid. Placements, clips, times, attachments and all other settings are kept. The next frame starts afresh, as
    /// after [`Scene::refresh`]. If the rebuild fails, the scene stays unchanged.
    ///
    /// Views, renderers and shadows must also be rebuilt: with [`View::rebuild`](crate::scene::View::rebuild),
    /// [`Renderer::rebuild`](crate::render::Renderer::rebuild) and
    /// [`SunShadow::rebuild`](crate::render::SunShadow::rebuild). [`Scene::rebuild_all`] calls all of these functions.
    ///
    /// Data in the caller's buffers and textures cannot be restored. Before the call, remove terrain made from fields
    /// ([`TerrainSource::from_fields`](crate::scene::TerrainSource::from_fields)) and reliefs made from textures
    /// ([`Relief::of_maps`](crate::scene::Relief::of_maps)).
    ///
    /// The scene keeps its sources on the host: meshes with their images, clips, and recipes of terrain. Terrain is
    /// generated again. The rebuild takes as long as adding the objects, except for computations that characters need
    /// only once (bounds of motion). All shaders that the new device has not compiled yet are compiled.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for terrain and reliefs whose data is in the caller's buffers or textures;
    /// [`crate::gpu::GpuError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn rebuild(&mut self, gpu: &Gpu) -> Result<(), Error> {
        gpu.block_on(self.rebuild_async(gpu))
    }

    /// Like `Scene::rebuild`, but the future completes once the device has generated terrain and reported its errors;
    /// see [`Gpu::wait_async`].
    ///
    /// # Errors
    /// As for `Scene::rebuild`.
    pub async fn rebuild_async(&mut self, gpu: &Gpu) -> Result<(), Error> {
        // The data of new models is on the host, so that they need not wait.
        self.objects
            .iter_mut()
            .filter_map(|object| object.successor.as_mut())
            .for_each(|next| next.pending = None);
        self.succeed()?;
        let layouts = SceneLayouts::new(gpu)?;
        let passes = Passes::new(gpu)?;
        let timer = if self.counted { StageTimer::new(gpu)? } else { None };
        let watch = self.watch.as_ref().map(|watch| watch.on(gpu)).transpose()?;
        let mut objects: Vec<OnDevice> = Vec::new();
        for object in self.objects.iter() {
            objects.push(object.on(gpu, &layouts).await?);
        }
        gpu.check_async().await?;
        // From here on, no step can fail, so the scene may be changed.
        for (object, on_device) in self.objects.iter_mut().zip(objects) {
            object.adopt(on_device);
        }
        self.gpu = gpu.clone();
        self.device += 1;
        (self.passes, self.layouts_of_groups) = (passes, layouts);
        (self.timer, self.watch, self.counts) = (timer, watch, None);
        self.attachments.forget_device();
        (self.staging, self.staged) = (StagingRing::new(FRAMES_IN_FLIGHT), Staged::default());
        self.is_broken = false;
        self.pose_staging = StagingRing::new(FRAMES_IN_FLIGHT);
        self.layout = None;
        Ok(())
    }
}
