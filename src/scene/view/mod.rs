//! Views: a camera into a scene, with what it sees and how fine.

mod attached;
mod counted;
pub(crate) mod lists;
mod uniforms;

use std::sync::Arc;

use glam::IVec3;

use crate::asset::Light;
use crate::gpu::{Gpu, Group, Staged, Uniform, Upload as _};
use crate::lod::list::ListPass;
use crate::lod::select::SelectPass;
#[cfg(feature = "verify")]
use crate::lod::{INSTANCE_ALIVE, INSTANCE_CASTS, INSTANCE_MASK_SHIFT};
use crate::lod::{SelectView, VIEW_CAMERAS, planes};
use crate::scene::Scene;
use crate::scene::camera::Camera;
use crate::scene::layout::Layout;
use crate::scene::layouts::SceneLayouts;
use crate::scene::quality::Quality;
use crate::scene::statistics::view::ViewCounts;
use crate::shared::render::scene_view::SceneView;
use crate::{Error, InputError};
use lists::ViewLists;
use uniforms::{lod_camera, terrain_view};

/// A camera into a scene: main view, shadow, reflection, half of a split screen. A frame may have any number of them.
#[derive(Debug)]
pub struct View {
    scene: Arc<()>,
    /// The number of the scene's device on which it was made.
    device: u32,
    quality: Quality,
    camera: Option<Camera>,
    lod_cameras: Vec<Camera>,
    mask: u16,
    casters: bool,
    select: Uniform<SelectView>,
    drawn: Uniform<SceneView>,
    pub(crate) lists: Option<ViewLists>,
    counts: Option<ViewCounts>,
}

impl View {
    pub(super) fn new(gpu: &Gpu, (scene, device): (&Arc<()>, u32), quality: Quality) -> Result<Self, Error> {
        quality.validate()?;
        let select = Uniform::new(gpu, "what a view sees", &SelectView::nothing())?;
        let drawn = Uniform::new(gpu, "view", &SceneView::nothing())?;
        Ok(Self {
            scene: scene.clone(),
            device,
            quality,
            camera: None,
            lod_cameras: Vec::new(),
            mask: u16::MAX,
            casters: false,
            select,
            drawn,
            lists: None,
            counts: None,
        })
    }

    /// Sets the camera of the next frame.
    ///
    /// # Errors
    /// [`InputError`] as [`Camera::validate`], and for a projection that is neither perspective nor parallel; the camera
    /// stays what it was.
    pub fn set(&mut self, camera: Camera) -> Result<(), InputError> {
        camera.validate()?;
        lod_camera(&camera, camera.cell, self.quality.pixels)?;
        self.camera = Some(camera);
        Ok(())
    }

    /// Sets the quality of the next frame.
    ///
    /// # Errors
    /// [`InputError`] for pixels that are negative or not finite.
    pub fn set_quality(&mut self, quality: Quality) -> Result<(), InputError> {
        quality.validate()?;
        self.quality = quality;
        Ok(())
    }

    /// The quality of the next frame.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// Lets other cameras decide the levels of detail: the finest that any of them needs. A shadow view takes those of
    /// the main views, so that shadows fit what casts them. Without any, the view's own camera decides.
    ///
    /// # Errors
    /// [`InputError`] for more than four cameras, and as [`View::set`].
    pub fn set_lod_cameras(&mut self, cameras: &[Camera]) -> Result<(), InputError> {
        if cameras.len() > VIEW_CAMERAS as usize {
            let bound = format!("must be at most {VIEW_CAMERAS}");
            return Err(InputError::new("cameras.len", cameras.len(), bound));
        }
        for camera in cameras {
            camera.validate()?;
            lod_camera(camera, camera.cell, self.quality.pixels)?;
        }
        self.lod_cameras = cameras.to_vec();
        Ok(())
    }

    /// Shows only instances whose visibility mask shares a bit with `mask`; all of them at first.
    pub fn set_mask(&mut self, mask: u16) {
        self.mask = mask;
    }

    /// Whether the view shows only instances that cast shadows.
    pub fn set_casters_only(&mut self, casters: bool) {
        self.casters = casters;
    }

    /// The camera, if it was set.
    pub fn camera(&self) -> Option<&Camera> {
        self.camera.as_ref()
    }

    /// Whether the view shows an instance with these flags if it is inside the view volume.
    #[cfg(feature = "verify")]
    pub(super) fn may_show(&self, flags: u32) -> bool {
        let is_in_mask = flags >> INSTANCE_MASK_SHIFT & u32::from(self.mask) != 0;
        flags & INSTANCE_ALIVE != 0 && is_in_mask && (!self.casters || flags & INSTANCE_CASTS != 0)
    }

    /// Creates everything that the view has on the device again, after its scene was rebuilt on another one
    /// ([`Scene::rebuild`](crate::scene::Scene::rebuild)). Cameras, quality and mask stay.
    ///
    /// # Errors
    /// [`InputError`] for another scene; [`crate::gpu::GpuError`].
    pub fn rebuild(&mut self, scene: &Scene) -> Result<(), Error> {
        if !self.is_of(&scene.token) {
            return Err(InputError::new("scene", "another", "must be the one that the view is of").into());
        }
        let fresh = Self::new(&scene.gpu, (&scene.token, scene.device), self.quality)?;
        let Self { device, select, drawn, .. } = fresh;
        (self.device, self.select, self.drawn) = (device, select, drawn);
        (self.lists, self.counts) = (None, None);
        Ok(())
    }

    /// Refuses a view that is not of a scene on its present device; `path` names the view.
    pub(super) fn check(&self, scene: &Scene, path: &str) -> Result<(), InputError> {
        if !self.is_of(&scene.token) {
            return Err(InputError::new(path, "of another scene", "must be of this scene"));
        }
        if self.device != scene.device {
            let bound = "must be rebuilt after its scene: View::rebuild";
            return Err(InputError::new(path, "of a device that was lost", bound));
        }
        Ok(())
    }

    pub(crate) fn is_of(&self, scene: &Arc<()>) -> bool {
        Arc::ptr_eq(&self.scene, scene)
    }

    /// Allocates what the view needs for a layout and so many terrains, unless it has it.
    pub(super) fn fit(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        passes: (&SelectPass, &ListPass),
        groups: (&SceneLayouts, usize),
    ) -> Result<(), Error> {
        if self.lists.as_ref().is_none_or(|lists| lists.version != layout.version) {
            self.lists = Some(ViewLists::new(gpu, layout, (&self.select, &self.drawn), passes, groups)?);
        }
        Ok(())
    }

    /// Bind group 1 of a terrain, by its number among the terrains.
    pub(crate) fn ground(&self, terrain: usize) -> Option<&Group> {
        self.lists.as_ref()?.terrain.get(terrain).map(|(_, group)| group)
    }

    /// Stages the view's uniforms. `spacings` gives the distance between the samples of each terrain.
    pub(super) fn stage(
        &self,
        staged: &mut Staged,
        (blocks, light): (u32, &Light),
        spacings: &[f64],
        is_first: bool,
    ) -> Result<(), Error> {
        let (camera, view) = self.select_view(blocks, is_first)?;
        staged.uniform(&self.select, &view)?;
        staged.uniform(&self.drawn, &SceneView::new(&camera, &view.cameras[0], light))?;
        let terrain = self.lists.iter().flat_map(|lists| &lists.terrain);
        for ((uniform, _), spacing) in terrain.zip(spacings) {
            staged.uniform(uniform, &terrain_view(&camera, *spacing))?;
        }
        Ok(())
    }

    /// The view as kernels see it.
    pub(super) fn select_view(
        &self,
        blocks: u32,
        is_first: bool,
    ) -> Result<(Camera, SelectView), InputError> {
        let Some(camera) = self.camera else {
            return Err(InputError::new("view.camera", "none", "must be set before a frame is recorded"));
        };
        let own = [camera];
        let cameras = if self.lod_cameras.is_empty() { &own[..] } else { &self.lod_cameras };
        let mut view = SelectView {
            planes: planes(camera.clip_from_world()),
            cell: IVec3::from(camera.cell),
            mask: self.mask.into(),
            camera_count: cameras.len() as u32,
            is_first: is_first.into(),
            casters: self.casters.into(),
            blocks,
            ..SelectView::nothing()
        };
        for (to, from) in view.cameras.iter_mut().zip(cameras) {
            *to = lod_camera(from, camera.cell, self.quality.pixels)?;
        }
        Ok((camera, view))
    }

    /// Adds culling, choice of levels and lists to a compute pass.
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some(lists) = &self.lists {
            lists.select.dispatch(pass);
            lists.list.dispatch(pass);
        }
    }
}
