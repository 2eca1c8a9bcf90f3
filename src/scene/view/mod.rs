//! Views: cameras into a scene, with their visible instances and levels of detail.

mod attached;
mod budget;
mod counted;
pub(crate) mod lists;
mod rebuild;
mod shadow;
mod uniforms;

use glam::{IVec3, UVec2};

use crate::asset::Light;
use crate::gpu::{Gpu, Staged, Uniform, Upload as _};
#[cfg(not(target_arch = "wasm32"))]
use crate::lod::{INSTANCE_ALIVE, INSTANCE_CASTS, instance_flags_mask};
use crate::lod::{SelectView, VIEW_CAMERAS, planes};
use crate::scene::camera::{Camera, Depth};
use crate::scene::handles::{SceneNumber, Slots};
use crate::scene::layout::Layout;
use crate::scene::layouts::SceneLayouts;
use crate::scene::object::Object;
use crate::scene::object_kind::ViewOfFrame;
use crate::scene::order::back_to_front;
use crate::scene::quality::Quality;
use crate::scene::statistics::view::ViewCounts;
use crate::shared::render::scene_view::SceneView;
use crate::{Error, InputError};
use budget::BudgetOfView;
use lists::{BoundByView, ViewLists, ViewPasses};
pub(crate) use shadow::ViewShadow;
use uniforms::{clip_rows, lod_camera};

/// A camera into a scene, such as a main view, a shadow, a reflection, or half of a split screen. A frame may have any
/// number of views.
///
/// All settings of a view take effect in the next [`Scene::record`](super::Scene::record). For a view that fills half
/// of the screen, [`Camera::viewport`] is the size of that half.
///
/// # Examples
///
/// The main view, and the view of a sun's shadow map. The sun's view shows only casters, including casters outside the
/// main view's picture. The sun's view uses the levels of detail that the main view needs.
///
/// ```no_run
/// use glam::Vec3;
/// use relievo::render::{Layer, Renderer};
/// use relievo::scene::{Camera, Depth, Quality, Scene};
/// # fn frame(
/// #     (mut scene, renderer, shadows): (Scene, Renderer, Renderer), // shadows: TargetFormat::depth_only
/// #     mut encoder: wgpu::CommandEncoder,
/// #     begin: impl Fn(&mut wgpu::CommandEncoder) -> wgpu::RenderPass<'static>,
/// # ) -> Result<(), relievo::Error> {
///
/// let mut eye = scene.view(Quality::pixels(0.5))?;
/// let mut sun = scene.view(Quality::pixels(0.5))?;
/// sun.set_casters_only(true);
///
/// // A frame.
/// let camera = Camera::looking_at(Vec3::new(0.0, 2.0, 10.0), Vec3::Y, 0.8, [0.1, 500.0], [1920, 1080]);
/// eye.set(camera)?;
/// sun.set(Camera {
///     cell: camera.cell,
///     view_from_cell: glam::camera::rh::view::look_at_mat4(Vec3::new(-4.0, 8.0, 6.0), Vec3::ZERO, Vec3::Y),
///     // 40 units to either side, and 100 ahead.
///     clip_from_view: glam::camera::rh::proj::directx::orthographic(-40.0, 40.0, -40.0, 40.0, 0.0, 100.0),
///     viewport: [2048, 2048],
///     depth: Depth::Forward,
/// })?;
/// sun.set_lod_cameras(&[camera])?;
/// scene.record(&mut encoder, &mut [&mut eye, &mut sun])?;
/// # let mut shadow_pass = begin(&mut encoder);
/// shadows.draw(&mut shadow_pass, &scene, &sun, Layer::Depth)?;
/// # drop(shadow_pass);
/// # let mut pass = begin(&mut encoder);
/// renderer.draw(&mut pass, &scene, &eye, Layer::Color)?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct View {
    scene: SceneNumber,
    /// The number of the scene's device (`Scene::device`) on which the view was made.
    device: u32,
    /// Name of the function that recreates the view on another device, for error messages.
    pub(crate) remade_by: &'static str,
    quality: Quality,
    budget: BudgetOfView,
    camera: Option<Camera>,
    /// The last frame in which the view was recorded.
    last: Option<LastFrame>,
    lod_cameras: Vec<Camera>,
    mask: u16,
    casters: bool,
    dither: DitherPattern,
    /// The sun's shadow that is applied in this view.
    shadow: Option<ViewShadow>,
    select: Uniform<SelectView>,
    drawn: Uniform<SceneView>,
    recorded: Option<Recorded>,
    pub(crate) lists: Option<ViewLists>,
    counts: Option<ViewCounts>,
}

/// The pattern of pixels by which one level of detail dithers into the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DitherPattern {
    /// The pattern is the same in every frame.
    #[default]
    Still,
    /// The pattern moves in every frame, through all of its 64 positions.
    PerFrame,
}

/// The last frame in which a view was recorded.
#[derive(Debug, Clone, Copy)]
struct LastFrame {
    frame: u64,
    camera: Camera,
    /// The scene's time in seconds.
    time: f64,
    /// Whether the next frame must ignore this frame ([`View::cut`]).
    is_cut: bool,
}

/// Facts about a view's last frame that a renderer needs.
#[derive(Debug, Default)]
pub(super) struct Recorded {
    /// Whether the picture is a mirror image.
    pub mirrors: bool,
    /// Whether depth falls with distance.
    pub reversed: bool,
    /// For each object: whether it has instances that are not mirrored, and whether it has mirrored ones.
    pub sides: Vec<[bool; 2]>,
}

/// The frame that is being recorded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    pub frame: u64,
    /// The scene's time in seconds.
    pub time: f64,
    /// Number of the view among those that the frame records.
    pub number: usize,
}

impl View {
    pub(super) fn new(gpu: &Gpu, scene: SceneNumber, device: u32, quality: Quality) -> Result<Self, Error> {
        quality.validate()?;
        let select = Uniform::new(gpu, "what a view sees", &SelectView::nothing())?;
        let drawn = Uniform::new(gpu, "view", &SceneView::nothing())?;
        Ok(Self {
            scene,
            device,
            remade_by: "View::rebuild",
            quality,
            budget: BudgetOfView::default(),
            camera: None,
            last: None,
            lod_cameras: Vec::new(),
            mask: u16::MAX,
            casters: false,
            dither: DitherPattern::Still,
            shadow: None,
            select,
            drawn,
            recorded: None,
            lists: None,
            counts: None,
        })
    }

    /// Sets the camera. Field of view, viewport and depth direction may differ from the previous camera's.
    ///
    /// # Errors
    /// [`InputError`] if [`Camera::validate`] refuses the camera, and for a projection that is neither perspective nor
    /// parallel. [`InputError`] also if the near plane is not ahead of the eye; [`Camera::depth`] decides which plane
    /// is the near one. After an error, the camera is unchanged.
    ///
    /// # Examples
    ///
    /// Sets a camera in the south that looks down at the target.
    ///
    /// ```no_run
    /// # use relievo::scene::{Camera, View};
    /// # fn example(view: &mut View, size: [u32; 2]) -> Result<(), relievo::Error> {
    /// let (eye, target) = ([650.0, 40.0, 700.0], [650.0, 20.0, 600.0]);
    /// view.set(Camera::looking_at_world(eye, target, 0.8, [0.1, 2000.0], size))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set(&mut self, camera: Camera) -> Result<(), InputError> {
        camera.validate()?;
        lod_camera(&camera, camera.cell, self.quality.pixels)?;
        self.camera = Some(camera);
        Ok(())
    }

    /// Sets the quality: the largest error, and limits of triangles and time.
    ///
    /// # Errors
    /// [`InputError`] if [`Quality::validate`] refuses the quality.
    ///
    /// # Examples
    ///
    /// A view that is coarser while the camera moves, and never draws more than a million triangles.
    ///
    /// ```no_run
    /// # use relievo::scene::{Quality, View};
    /// # fn example(view: &mut View, is_moving: bool) -> Result<(), relievo::Error> {
    /// let pixels = if is_moving { 2.0 } else { 0.5 };
    /// view.set_quality(Quality { triangles: Some(1_000_000), ..Quality::pixels(pixels) })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_quality(&mut self, quality: Quality) -> Result<(), InputError> {
        quality.validate()?;
        let had = self.has_budget();
        self.quality = quality;
        self.budget_changed(had);
        Ok(())
    }

    /// The view's quality.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// Sets the cameras that decide the levels of detail. Each instance gets the finest level that any of these cameras
    /// needs. If the list is empty, the view's own camera decides. Give a shadow view the cameras of the main views, so
    /// that shadows match their casters. Call this again whenever those cameras change.
    ///
    /// # Errors
    /// [`InputError`] for more than four cameras, and for a camera that [`View::set`] would refuse.
    pub fn set_lod_cameras(&mut self, cameras: &[Camera]) -> Result<(), InputError> {
        let bound = || format!("must be at most {VIEW_CAMERAS}");
        InputError::check(cameras.len() <= VIEW_CAMERAS as usize, "cameras.len", cameras.len(), bound)?;
        for (at, camera) in cameras.iter().enumerate() {
            let checked =
                camera.validate().and_then(|()| lod_camera(camera, camera.cell, self.quality.pixels));
            checked.map_err(|error| InputError {
                path: error.path.replacen("camera", &format!("cameras[{at}]"), 1),
                ..error
            })?;
        }
        self.lod_cameras = cameras.to_vec();
        Ok(())
    }

    /// Sets the view's mask. The view shows only instances whose visibility mask
    /// ([`Scene::set_visibility_mask`](super::Scene::set_visibility_mask)) shares a bit with `mask`. The default shows
    /// all instances.
    ///
    /// # Examples
    ///
    /// A minimap without the instances that are marked as small.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Scene, View};
    /// # fn example(scene: &mut Scene, minimap: &mut View, flower: InstanceId) -> Result<(), relievo::Error> {
    /// const SMALL: u16 = 1;
    /// scene.set_visibility_mask(flower, SMALL)?;
    /// minimap.set_mask(!SMALL);
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_mask(&mut self, mask: u16) {
        self.mask = mask;
    }

    /// Sets whether the view shows only instances that cast shadows; the default is false.
    pub fn set_casters_only(&mut self, casters: bool) {
        self.casters = casters;
    }

    /// Sets whether the pattern of [`Transition::Dither`](super::Transition::Dither) stands still, which is the
    /// default, or changes in each frame. Temporal antialiasing averages a pattern that changes.
    pub fn set_dither(&mut self, dither: DitherPattern) {
        self.dither = dither;
    }

    /// The offset of a frame's dither pattern, in pixels.
    fn dither_offset(&self, frame: u64) -> UVec2 {
        match self.dither {
            DitherPattern::Still => UVec2::ZERO,
            // Each frame moves the pattern by (3, 1) pixels, and every 8th frame by one more row. So the offsets of 64
            // frames are all different.
            DitherPattern::PerFrame => UVec2::new((3 * frame % 8) as u32, (frame / 8 + frame) as u32 % 8),
        }
    }

    /// Makes the next frame independent of the last one, for a cut or a jump of the camera. Levels of detail are then
    /// chosen anew, no fade continues, and velocities are those of a still camera.
    pub fn cut(&mut self) {
        if let Some(last) = &mut self.last {
            last.is_cut = true;
        }
    }

    /// The camera, if one was set.
    pub fn camera(&self) -> Option<&Camera> {
        self.camera.as_ref()
    }

    /// Whether the view shows an instance with these flags if the instance is inside the view volume.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn may_show(&self, flags: u32) -> bool {
        let is_in_mask = instance_flags_mask(flags) & u32::from(self.mask) != 0;
        flags & INSTANCE_ALIVE != 0 && is_in_mask && (!self.casters || flags & INSTANCE_CASTS != 0)
    }

    pub(in crate::scene) fn is_of(&self, scene: SceneNumber) -> bool {
        self.scene == scene
    }

    /// Allocates the view's buffers for a layout of these objects, unless they exist.
    pub(super) fn fit(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        passes: ViewPasses<'_>,
        layouts: &SceneLayouts,
        objects: &Slots<Object>,
    ) -> Result<(), Error> {
        let budget = if self.has_budget() { Some(self.budget_on(gpu)?) } else { None };
        let map = self.shadow.as_ref().map(|shadow| &shadow.map);
        match &mut self.lists {
            Some(lists) if lists.version == layout.version => {
                lists.bind_map(gpu, layout, layouts, &self.drawn, map)?;
            }
            lists => {
                let (select, drawn, budget) = (&self.select, &self.drawn, budget.as_deref());
                let bound = BoundByView { select, drawn, map, budget };
                *lists = Some(ViewLists::new(gpu, layout, layouts, objects, passes, bound)?);
            }
        }
        Ok(())
    }

    /// Facts about the view's last frame that a renderer needs; `None` before the first frame.
    pub(super) fn last_recorded(&self) -> Option<&Recorded> {
        self.recorded.as_ref()
    }

    /// Whether the scene's last frame included this view. `frames` is the number of frames recorded so far.
    pub(super) fn is_of_frame(&self, frames: u64) -> bool {
        self.last.is_some_and(|last| last.frame + 1 == frames)
    }

    /// Notes that a frame with this view was recorded, at scene time `time`.
    pub(super) fn recorded(&mut self, frame: u64, time: f64) {
        self.last = self.camera.map(|camera| LastFrame { frame, camera, time, is_cut: false });
    }

    /// Stages the view's uniforms. `sides` has the meaning of [`Recorded::sides`].
    pub(super) fn stage(
        &mut self,
        staged: &mut Staged,
        layout: &Layout,
        light: &Light,
        sides: impl Iterator<Item = [bool; 2]>,
        now: Moment,
    ) -> Result<(), Error> {
        let Moment { frame, time, number } = now;
        let is_first = number == 0;
        let last = self.last.filter(|last| last.frame + 1 == frame && !last.is_cut);
        let (camera, mut view) = self.select_view(layout.blocks, is_first)?;
        self.stage_budget(staged, layout.blocks, layout.triangle_unit)?;
        view.is_next = last.is_some().into();
        view.clip_rows = clip_rows(&camera);
        view.last_clip_rows = last.map_or(view.clip_rows, |last| clip_rows(&last.camera));
        view.seconds = last.map_or(0.0, |last| (time - last.time).abs() as f32);
        let last = last.map(|last| last.camera);
        staged.uniform(&self.select, &view)?;
        staged.uniform(
            &self.drawn,
            &SceneView::new(
                [&camera, &last.unwrap_or(camera)],
                &view.cameras[0],
                light,
                self.shadow.as_ref(),
                self.dither_offset(frame),
            ),
        )?;
        if let Some(lists) = &self.lists {
            for (in_view, first) in lists.in_view.iter().zip(&lists.firsts) {
                let Some(in_view) = in_view else { continue };
                let shown = in_view
                    .stage(staged, ViewOfFrame { camera: &camera, number, is_next: last.is_some() })?;
                staged.elements(&lists.shown, *first as usize / 32, &shown)?;
            }
        }
        let recorded = self.recorded.get_or_insert_default();
        recorded.mirrors = camera.is_mirrored();
        recorded.reversed = camera.depth == Depth::Reversed;
        recorded.sides.clear();
        recorded.sides.extend(sides);
        Ok(())
    }

    /// Sorts the instances with transparent surfaces, which are drawn one by one.
    pub(super) fn order<'a>(&mut self, objects: impl Iterator<Item = &'a Object>, selected: &SelectView) {
        if let (Some(lists), Some(camera)) = (&mut self.lists, &self.camera) {
            back_to_front(&mut lists.order, objects, selected, camera);
        }
    }

    /// The view's uniform for the selection kernels.
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
            planes: planes(camera.clip_from_cell()),
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

    /// Adds culling to a compute pass.
    pub(super) fn dispatch_select(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some(lists) = &self.lists {
            lists.select.dispatch(pass);
        }
    }

    /// Adds level decisions and list building to a compute pass.
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some(lists) = &self.lists {
            lists.decide.dispatch(pass);
            lists.list.dispatch(pass);
            if let Some(sorted) = &lists.sorted {
                sorted.job.dispatch(pass);
            }
        }
    }
}
