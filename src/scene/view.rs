//! Views: a camera into a scene, with what it sees and how fine.

use std::sync::Arc;

use glam::{DVec3, IVec2, IVec3, Mat4, Vec3, Vec4};

use crate::asset::Light;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Staged, Uniform, Upload as _};
use crate::lod::list::{ListBuffers, ListPass};
use crate::lod::select::{SelectBuffers, SelectPass};
#[cfg(feature = "verify")]
use crate::lod::{INSTANCE_ALIVE, INSTANCE_CASTS, INSTANCE_MASK_SHIFT};
use crate::lod::{LodCamera, planes};
use crate::lod::{SelectView, VIEW_CAMERAS};
use crate::scene::camera::{Camera, Depth};
use crate::scene::layout::Layout;
use crate::scene::layouts::SceneLayouts;
use crate::scene::placement::Placement;
use crate::scene::quality::Quality;
use crate::shared::lod::object::SceneDraw;
use crate::shared::render::scene_terrain::TerrainView;
use crate::shared::render::scene_view::SceneView;
use crate::skinning::picture::is_mirrored;
use crate::{Error, InputError};

/// A camera into a scene: main view, shadow, reflection, half of a split screen. A frame may have any number of them.
#[derive(Debug)]
pub struct View {
    scene: Arc<()>,
    quality: Quality,
    camera: Option<Camera>,
    lod_cameras: Vec<Camera>,
    mask: u16,
    casters: bool,
    select: Uniform<SelectView>,
    drawn: Uniform<SceneView>,
    pub(crate) lists: Option<ViewLists>,
}

/// What a view sees, in buffers for one layout of the scene.
#[derive(Debug)]
pub(crate) struct ViewLists {
    pub version: u64,
    /// The lists of instances to draw.
    pub lists: Buffer<u32>,
    /// The draws of all objects.
    pub arguments: Buffer<SceneDraw>,
    /// For each instance that is seen, the rows of its transform from the model's space to the corner of the view's cell.
    #[cfg(feature = "verify")]
    pub rows: Buffer<[f32; 4]>,
    /// Bind group 0.
    pub group: Group,
    /// For each terrain, in the order of the objects, where its samples lie, and bind group 1.
    pub terrain: Vec<(Uniform<TerrainView>, Group)>,
    select: Job,
    list: Job,
}

impl View {
    pub(super) fn new(gpu: &Gpu, scene: &Arc<()>, quality: Quality) -> Result<Self, Error> {
        quality.validate()?;
        let select = Uniform::new(gpu, "what a view sees", &SelectView::nothing())?;
        let drawn = Uniform::new(gpu, "view", &SceneView::nothing())?;
        Ok(Self {
            scene: scene.clone(),
            quality,
            camera: None,
            lod_cameras: Vec::new(),
            mask: u16::MAX,
            casters: false,
            select,
            drawn,
            lists: None,
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

impl ViewLists {
    fn new(
        gpu: &Gpu,
        layout: &Layout,
        (view, drawn): (&Uniform<SelectView>, &Uniform<SceneView>),
        (select, list): (&SelectPass, &ListPass),
        (layouts, terrains): (&SceneLayouts, usize),
    ) -> Result<Self, Error> {
        let instances = layout.instances.len();
        let decisions = Buffer::new(gpu, "decisions", instances)?;
        let counts = Buffer::new(gpu, "counts of blocks", 16 * layout.blocks as usize)?;
        let rows = Buffer::new(gpu, "placements in the view", 3 * instances)?;
        let lists = Buffer::new(gpu, "lists of instances", layout.list_words as usize)?;
        let arguments = Buffer::from_slice(gpu, "draws", &layout.draws)?;
        let select = select.prepare(
            gpu,
            SelectBuffers {
                view,
                objects: &layout.objects,
                block_objects: &layout.block_objects,
                instances: &layout.instances,
                allowed: &layout.allowed,
                decisions: &decisions,
                rows: &rows,
                counts: &counts,
            },
        )?;
        let buffers = ListBuffers {
            objects: &layout.objects,
            block_objects: &layout.block_objects,
            decisions: &decisions,
            counts: &counts,
            lists: &lists,
            arguments: &arguments,
        };
        let list = list.prepare(gpu, buffers, layout.object_count, layout.blocks)?;
        let group = layouts.view(gpu, drawn, &rows, &layout.instances)?;
        let ground = || {
            let uniform = Uniform::new(gpu, "terrain in a view", &TerrainView::nowhere())?;
            let group = layouts.ground(gpu, &uniform)?;
            Ok((uniform, group))
        };
        let terrain = (0..terrains).map(|_| ground()).collect::<Result<_, GpuError>>()?;
        Ok(Self {
            version: layout.version,
            lists,
            arguments,
            #[cfg(feature = "verify")]
            rows,
            group,
            terrain,
            select,
            list,
        })
    }
}

impl SceneView {
    fn new(camera: &Camera, own: &LodCamera, light: &Light) -> Self {
        let eye = match own.perspective > 0.0 {
            true => camera.eye().extend(1.0),
            false => (-camera.ahead()).extend(0.0),
        };
        Self {
            clip_from_world: camera.clip_from_world(),
            eye,
            light: light.direction.normalize().extend(light.ambient),
            light_color: light.color,
            side: if is_mirrored(&camera.clip_from_world()) { -1.0 } else { 1.0 },
        }
    }

    fn nothing() -> Self {
        let (clip_from_world, eye, light) = (Mat4::IDENTITY, Vec4::W, Vec4::Y);
        Self { clip_from_world, eye, light, light_color: Vec3::ONE, side: 1.0 }
    }
}

/// Where the samples of a terrain, `spacing` world units apart, lie in a view: counted from the one nearest to the eye.
fn terrain_view(camera: &Camera, spacing: f64) -> TerrainView {
    let corner = DVec3::from(camera.cell.map(f64::from)) * f64::from(Placement::CELL);
    let eye = corner + camera.eye().as_dvec3();
    // Conversion saturates; samples so far away are not drawn precisely.
    let base = IVec2::new((eye.x / spacing).round() as i32, (eye.z / spacing).round() as i32);
    let place = DVec3::new(f64::from(base.x) * spacing, 0.0, f64::from(base.y) * spacing);
    TerrainView { base, rest: (place - corner).as_vec3() }
}

impl TerrainView {
    fn nowhere() -> Self {
        Self { base: IVec2::ZERO, rest: Vec3::ZERO }
    }
}

impl SelectView {
    /// A view that sees nothing.
    fn nothing() -> Self {
        let camera = LodCamera {
            eye: Vec3::ZERO,
            focal: 1.0,
            ahead: Vec3::NEG_Z,
            pixels: 0.0,
            near: 0.0,
            perspective: 1.0,
            unused_a: 0.0,
            unused_b: 0.0,
        };
        Self {
            planes: [Vec4::NEG_W; 6],
            cameras: [camera; VIEW_CAMERAS as usize],
            cell: IVec3::ZERO,
            mask: 0,
            camera_count: 1,
            is_first: 1,
            casters: 0,
            blocks: 0,
        }
    }
}

/// A camera that decides levels of detail, relative to the corner of a cell.
fn lod_camera(camera: &Camera, cell: [i32; 3], pixels: f32) -> Result<LodCamera, InputError> {
    let is_reversed = camera.depth == Depth::Reversed;
    let mut own =
        LodCamera::new(camera.view_from_world, camera.clip_from_view, camera.viewport, is_reversed, pixels)?;
    let cells = |axis: usize| f64::from(camera.cell[axis]) - f64::from(cell[axis]);
    let offset = glam::DVec3::from([0, 1, 2].map(cells)) * f64::from(Placement::CELL);
    own.eye = (own.eye.as_dvec3() + offset).as_vec3();
    Ok(own)
}
