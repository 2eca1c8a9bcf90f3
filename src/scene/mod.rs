//! A scene: terrain, meshes, reliefs and characters on the device, seen through any number of views.
//!
//! A [`Scene`] holds all objects and instances, but no camera and no target. A [`View`] is a camera into a scene, with
//! the visible instances and their levels of detail. A [`Renderer`](crate::render::Renderer) draws a scene through a
//! view in the caller's render pass.
//!
#![doc = include_str!("overview.md")]
//!
//! A browser forbids waiting and reports errors late. In a browser, use the functions whose names end in `_async`, and
//! call [`Scene::health`] once a frame. Functions without that ending do the same work, but their errors surface in a
//! later call. `Scene::add_terrain` and `Scene::read_ground` wait, so a browser has only their `_async` forms.

mod arrival;
mod attach;
mod bounds;
pub(crate) mod caller_text;
mod camera;
mod character;
mod chunk;
pub(crate) mod drawable;
mod drive;
mod frame;
mod ground;
mod handles;
mod instance_pose;
mod instances;
pub mod kind;
mod layers;
pub(crate) mod layout;
pub(crate) mod layouts;
pub(crate) mod level_of_detail;
pub(crate) mod material;
mod materials;
mod matrices;
#[cfg(not(target_arch = "wasm32"))]
mod measured;
#[doc(hidden)]
pub mod mesh;
pub(crate) mod object;
mod object_kind;
mod objects;
mod options;
pub(crate) mod order;
mod pacer;
mod paging;
mod pick;
mod pieces;
mod placement;
mod playing;
mod poses;
pub(crate) mod program;
mod quality;
#[doc(hidden)]
pub mod query;
mod ray;
mod rebuild;
mod relief;
mod spawned;
pub(crate) mod specialization;
mod stage;
mod statistics;
mod successor;
pub(crate) mod terrain;
mod uploads;
mod view;
mod wanted;
mod watch;
pub(crate) mod wgsl;

#[doc(inline)]
pub use crate::animation::{
    Range as DistanceRange, Weights as PriorityWeights, Wrap, crowd::Local as LocalTransform,
    root_motion::Taken as RootMotionParts,
};
#[doc(inline)]
pub use crate::lod::criterion::{Criterion, DistanceTo, SizeOf};
#[doc(inline)]
pub use crate::lod::transition::{Pace, Transition};
#[doc(inline)]
pub use crate::skinning::bounding_sphere::BoundingSphere;
#[doc(inline)]
pub use crate::skinning::{MeshLevels, SkeletonTier, add_levels, add_levels_with_progress, join_levels};
#[doc(inline)]
pub use crate::surface::{
    Address, Green, HeightMap, March, Mips, ReliefMaps, ReliefMaterial, ReliefMethod, ReliefOptions,
    ReliefShadow, SurfaceMesh, SurfaceTextures, SurfaceVertex,
};
#[doc(inline)]
#[cfg(not(target_arch = "wasm32"))]
pub use crate::terrain::elevation::ElevationLoader;
#[doc(inline)]
pub use crate::terrain::{
    blend::{Shading as TerrainShading, WeightMode},
    config::{
        Border as TerrainBorder, BuiltIn as BuiltInTexture, HeightGenerator, HeightInterpolation,
        Offset as TerrainOffset, Slope as TerrainSlope, TerrainConfig, Zone as TerrainZone, ZoneTexture,
    },
    despike::Despike,
    elevation::{
        ElevationInfo, ElevationLayout, ElevationMap, ElevationSource, ElevationTile, ElevationTiles,
        TileNumber,
    },
    features::{FeatureFile, Features as TerrainFeatures},
    fields::Fields as TerrainFields,
    fixed::FeatureMode,
    hydraulic::Hydraulic,
    mesh::GroundPoint,
    morph::Morph as TerrainMorph,
    recipe::Recipe as TerrainRecipe,
    texture::TerrainTexture,
    thermal::Thermal,
};
pub use bounds::Bounds;
pub use camera::{Camera, Depth};
pub use character::SkeletonStatistics;
pub use drive::Poses;
pub use handles::{InstanceId, ObjectId};
pub use instance_pose::InstancePose;
pub use level_of_detail::{Culling, LevelChoice, LevelOfDetail, Perceptual};
pub use options::{BoneGate, CharacterOptions, InfluenceLod, LayerMask, RootOptions, TerrainStyle};
pub use placement::{ClipTime, Placement, Play};
pub use poses::PoseBuffers;
pub use quality::{ErrorBudget, Quality};
pub use ray::{Hit, Ray};
pub use rebuild::Rebuild;
pub use relief::{Relief, ReliefSource};
pub use statistics::{
    BudgetStatistics, CharacterStatistics, LevelStatistics, ObjectStatistics, SceneStatistics, StageTimes,
    ViewStatistics,
};
pub use terrain::{EndlessLimits, EndlessStatistics, GroundRelief, SampleMask, TerrainHole, TerrainSource};
pub(crate) use view::ViewShadow;
pub use view::{DitherPattern, View};
pub use wanted::Wanted;
pub use watch::{InstanceBone, WatchedBone, WatchedBones};

use crate::asset::Light;
use crate::gpu::{Gpu, GpuError, Staged, StagingRing};
use crate::lod::assign::AssignPass;
use crate::lod::attach::AttachPass;
use crate::lod::budget::BudgetPass;
use crate::lod::decide::DecidePass;
use crate::lod::list::ListPass;
use crate::lod::select::SelectPass;
use crate::lod::sorted::SortedPass;
use crate::{Error, InputError};
use attach::Attachments;
use handles::Slots;
use layout::Layout;
use layouts::SceneLayouts;
use object::Object;
use statistics::{SceneCounts, StageTimer};
use watch::Watch;

/// Largest number of frames in flight: frames that are recorded, but not yet submitted or not yet executed by the
/// device.
pub const FRAMES_IN_FLIGHT: usize = 4;

/// A scene on the device: objects (terrain, meshes, reliefs, characters) and their instances.
///
/// # Examples
///
/// A crowd of 100 foxes. 20 foxes walk backwards, and one leaves.
///
/// ```no_run
/// use relievo::asset::Model;
/// use relievo::scene::{Placement, Play, Scene};
/// # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
///
/// let gpu = relievo::gpu::Gpu::from_wgpu(device, queue);
/// let mut scene = Scene::new(&gpu)?;
/// let mut model = Model::from_file("fox.glb".as_ref())?;
/// relievo::scene::add_levels(&mut model, &[0], 60)?; // levels of detail, for the first clip's poses
/// let fox = scene.add_character(&model, 100)?;
/// let mut foxes = Vec::new();
/// for at in 0..100 {
///     // In a row to the east, each facing 0.1 further to the left than the one before.
///     let place = Placement::at_world([2.0 * f64::from(at), 0.0, 0.0]);
///     let instance = scene.spawn(fox, place.turned(0.1 * at as f32).scaled(0.01))?; // a model in centimetres
///     let rate = if at % 5 == 0 { -1.0 } else { 1.0 };
///     scene.play(instance, &Play { rate, ..Play::new("Walk") })?;
///     foxes.push(instance);
/// }
/// scene.set_tint(foxes[3], [1.0, 0.5, 0.5, 1.0])?;
/// scene.despawn(foxes[4])?;
/// assert!(scene.placement(foxes[4]).is_err()); // its handle is stale from now on
/// # Ok::<(), relievo::Error>(())
/// ```
#[derive(Debug)]
pub struct Scene {
    gpu: Gpu,
    /// Number of times the scene was rebuilt on another device.
    device: u32,
    objects: Slots<Object>,
    budget: ErrorBudget,
    light: Light,
    /// `now` is the scene's time in seconds. `step` is the argument of the last [`Scene::advance`]. Each frame resets
    /// `step` to 0.
    now: f64,
    step: f32,
    /// The scene's time in the last frame that was staged.
    last_staged: f64,
    /// Motion history: whether the placements and vertices of the last frame are kept.
    keeps_last: bool,
    /// Whether shading samples a sun's shadow map.
    is_shadowed: bool,
    /// Number of frames recorded so far.
    frames: u64,
    /// Whether the recording of the last frame failed halfway.
    is_broken: bool,
    layout: Option<Layout>,
    layouts: u64,
    staging: StagingRing,
    staged: Staged,
    /// Staging buffers for the caller's writes to driven bones.
    pose_staging: StagingRing,
    uploaded: usize,
    /// Largest number of bytes of newly added objects that a frame uploads; `None` for no limit.
    upload_budget: Option<usize>,
    passes: Passes,
    layouts_of_groups: SceneLayouts,
    /// Whether statistics are collected.
    counted: bool,
    counts: Option<SceneCounts>,
    timer: Option<StageTimer>,
    watch: Option<Watch>,
    attachments: Attachments,
}

#[derive(Debug)]
struct Passes {
    select: SelectPass,
    decide: DecidePass,
    budget: BudgetPass,
    list: ListPass,
    sorted: SortedPass,
    assign: AssignPass,
    attach: AttachPass,
}

impl Passes {
    fn new(gpu: &Gpu) -> Result<Self, Error> {
        Ok(Self {
            select: SelectPass::new(gpu)?,
            decide: DecidePass::new(gpu)?,
            budget: BudgetPass::new(gpu)?,
            list: ListPass::new(gpu)?,
            sorted: SortedPass::new(gpu)?,
            assign: AssignPass::new(gpu)?,
            attach: AttachPass::new(gpu)?,
        })
    }
}

impl Scene {
    /// Creates an empty scene.
    ///
    /// # Errors
    /// Shader compilation errors from the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        let passes = Passes::new(gpu)?;
        Ok(Self {
            gpu: gpu.clone(),
            device: 0,
            objects: Slots::default(),
            budget: ErrorBudget::default(),
            light: Light::default(),
            now: 0.0,
            step: 0.0,
            last_staged: 0.0,
            keeps_last: false,
            is_shadowed: false,
            frames: 0,
            is_broken: false,
            layout: None,
            layouts: 0,
            staging: StagingRing::new(FRAMES_IN_FLIGHT),
            staged: Staged::default(),
            pose_staging: StagingRing::new(FRAMES_IN_FLIGHT),
            uploaded: 0,
            upload_budget: None,
            passes,
            layouts_of_groups: SceneLayouts::new(gpu)?,
            counted: false,
            counts: None,
            timer: None,
            watch: None,
            attachments: Attachments::default(),
        })
    }

    /// Like [`Scene::new`], but the future completes once the device has reported its errors ([`Gpu::check_async`]).
    ///
    /// # Errors
    /// As for [`Scene::new`].
    pub async fn new_async(gpu: &Gpu) -> Result<Self, Error> {
        let scene = Self::new(gpu)?;
        gpu.check_async().await?;
        Ok(scene)
    }

    /// Checks for device errors that were reported after the call that caused them ([`Gpu::check`]). In a browser, call
    /// this once a frame.
    ///
    /// # Errors
    /// The errors of [`Gpu::check`].
    ///
    /// # Examples
    ///
    /// In a browser, once a frame:
    ///
    /// ```no_run
    /// # use relievo::gpu::GpuError;
    /// # use relievo::scene::Scene;
    /// # fn example(scene: &Scene) -> Result<(), relievo::Error> {
    /// match scene.health() {
    ///     Err(GpuError::DeviceLost { .. }) => { /* open another device: Scene::rebuild_all_async */ }
    ///     checked => checked?,
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn health(&self) -> Result<(), GpuError> {
        self.gpu.check()
    }

    /// The device that holds the scene.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Sets the light of the whole scene, from the next recording on. The light's direction is in world space and
    /// points towards the light.
    ///
    /// # Errors
    /// [`InputError`] if [`Light::validate`] refuses the light.
    ///
    /// # Examples
    ///
    /// A low, warm sun in the west.
    ///
    /// ```no_run
    /// # use glam::Vec3;
    /// # use relievo::asset::Light;
    /// # use relievo::scene::Scene;
    /// # fn example(scene: &mut Scene) -> Result<(), relievo::Error> {
    /// scene.set_light(Light {
    ///     direction: Vec3::new(-1.0, 0.3, 0.0), // towards the light
    ///     color: Vec3::new(1.4, 1.2, 1.0),
    ///     ambient: 0.2,
    /// })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_light(&mut self, light: Light) -> Result<(), InputError> {
        light.validate()?;
        self.light = light;
        Ok(())
    }

    /// The light of the whole scene.
    pub fn light(&self) -> Light {
        self.light
    }

    /// Makes renderers sample a sun's shadow map in their shading, from their next [`prepare`] on.
    ///
    /// [`prepare`]: crate::render::Renderer::prepare
    pub(crate) fn set_shadowed(&mut self) {
        self.is_shadowed = true;
    }

    /// Whether shading samples a sun's shadow map.
    pub(crate) fn is_shadowed(&self) -> bool {
        self.is_shadowed
    }

    /// Sets how the allowed displacement of characters is divided among levels of detail, bones and influences. The new
    /// division holds from the next recording on.
    ///
    /// # Errors
    /// [`InputError`] if [`ErrorBudget::validate`] refuses the budget.
    ///
    /// # Examples
    ///
    /// Half of the allowed displacement is for bones that keep an older pose.
    ///
    /// ```no_run
    /// # use relievo::scene::{ErrorBudget, Scene};
    /// # fn example(scene: &mut Scene) -> Result<(), relievo::Error> {
    /// scene.set_error_budget(ErrorBudget { mesh: 0.45, bones: 0.5, influences: 0.02 })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_error_budget(&mut self, budget: ErrorBudget) -> Result<(), InputError> {
        budget.validate()?;
        self.budget = budget;
        for object in self.objects.iter_mut().filter(|object| object.character().is_some()) {
            object.mesh_fraction = budget.mesh;
        }
        self.layout = None;
        Ok(())
    }

    /// Advances the scene's time by `seconds`; a negative value turns it back. Call this once a frame, because the
    /// elapsed time decides which bones the frame samples.
    ///
    /// # Errors
    /// [`InputError`] for a value that is not finite.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::Scene;
    /// # fn example(scene: &mut Scene, last: &mut std::time::Instant) -> Result<(), relievo::Error> {
    /// let now = std::time::Instant::now();
    /// scene.advance(now.duration_since(*last).as_secs_f32())?;
    /// *last = now;
    /// # Ok(())
    /// # }
    /// ```
    pub fn advance(&mut self, seconds: f32) -> Result<(), InputError> {
        crate::animation::instance::check_seconds("seconds", seconds)?;
        self.now += f64::from(seconds);
        self.step = seconds;
        Ok(())
    }

    /// The factor by which the last frame enlarged the displacement that an object's levels of detail may use. The
    /// factor is 1 as long as the error in all views stays within [`Quality::pixels`]. It exceeds 1 when the device has
    /// no memory left for the vertices of a character's visible instances. [`Scene::refresh`] tries again to allocate
    /// that memory.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(scene: &Scene, crowd: ObjectId) -> Result<(), relievo::Error> {
    /// let bias = scene.lod_bias(crowd)?;
    /// if bias > 1.0 {
    ///     eprintln!("out of memory: the crowd is up to {bias} times as far off as the views allow");
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn lod_bias(&self, object: ObjectId) -> Result<f32, InputError> {
        Ok(self.object_at(object)?.lod_bias)
    }

    /// The largest number of draws that an object needs in one view and one layer. An object that fits into a binding
    /// of the device needs at most 64. A larger character is drawn in several chunks of instances, and a larger mesh in
    /// several pieces of triangles. Each chunk or piece has its own draws.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn draws(&self, object: ObjectId) -> Result<usize, InputError> {
        Ok(self.object_at(object)?.draws())
    }

    /// The number of bytes that the last recorded frame uploads from the host: cameras, times, changes, and delayed
    /// uploads ([`Scene::set_upload_budget`]).
    pub fn uploaded(&self) -> usize {
        self.uploaded
    }

    /// The scene's time in seconds.
    pub fn time(&self) -> f64 {
        self.now
    }

    /// Creates a view into the scene. The view needs a camera ([`View::set`]) before a frame is recorded.
    ///
    /// # Errors
    /// [`InputError`] if [`Quality::validate`] refuses the quality; [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// A main view with an error of at most half a pixel, and a mirror with an error of at most two pixels.
    ///
    /// ```no_run
    /// # use relievo::scene::{Camera, Quality, Scene};
    /// # fn example(scene: &Scene, camera: Camera, mirrored: Camera) -> Result<(), relievo::Error> {
    /// let mut main = scene.view(Quality::pixels(0.5))?;
    /// let mut mirror = scene.view(Quality::pixels(2.0))?;
    /// main.set(camera)?;
    /// mirror.set(mirrored)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn view(&self, quality: Quality) -> Result<View, Error> {
        View::new(&self.gpu, self.objects.scene(), self.device, quality)
    }
}
