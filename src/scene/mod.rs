//! A scene: terrain, meshes, reliefs and characters on the device, seen through any number of views.
//!
//! A [`Scene`] is everything there is; it knows no camera and no target. A [`View`] is a camera into it, with what that
//! camera sees and how fine. A [`Renderer`](crate::render::Renderer) draws a scene through a view in the caller's render
//! pass.
//!
//! # Order of calls
//!
//! Once, or whenever something is loaded:
//!
//! 1. [`Scene::new`], then [`Scene::add_terrain`], [`Scene::add_mesh`], [`Scene::add_relief`], [`Scene::add_character`] and
//!    [`Scene::spawn`].
//! 2. [`Renderer::new`](crate::render::Renderer::new) for each format of targets, and
//!    [`Renderer::prepare`](crate::render::Renderer::prepare), which compiles what the objects of the scene need. It is called
//!    again when objects were added; instances need no pipelines of their own.
//! 3. [`Scene::view`] for each camera.
//!
//! In each frame:
//!
//! 1. Change what there is: [`Scene::spawn`], [`Scene::despawn`], [`Scene::move_to`], [`Scene::play`], [`Scene::set_light`], …
//!    Changes show in the next recording.
//! 2. [`Scene::advance`] the time, and [`View::set`] the camera of each view.
//! 3. [`Scene::record`], once, with every view that the frame draws. It records compute work into the caller's encoder.
//! 4. [`Renderer::draw`](crate::render::Renderer::draw) in render passes of that encoder, or of others that are submitted
//!    after it. Between recording and drawing the scene and its views stay as they are.
//! 5. Submit the encoders.
//!
//! # Axes, units and colours
//!
//! The world is right-handed: +X points east, +Y up, +Z south. Its unit is the caller's choice; models in glTF, and the
//! creature of `samples`, are in metres. Angles are in radians, times in seconds.
//!
//! A model has +Y up, too. Its front is where its author has it: glTF asks for +Z. Triangles that are seen from outside run
//! counter-clockwise; back faces are not drawn, unless the material is double-sided. Placements with negative scale and
//! mirroring cameras change nothing in this: the winding is reversed where they reverse it.
//!
//! A camera looks along −Z of its own space, with +X to the right and +Y up, if its projection is made for that, as are those
//! of `glam::camera::rh` ([`Camera::looking_at`]). In clip space +X points to the right, +Y up, and depth is 0 to 1.
//!
//! Colours of materials, tints and lights are linear, and the crate's shading writes linear values: a target with an `…Srgb`
//! format encodes them. Images of colours are read as sRGB, height maps and normal maps as they are.
//!
//! # What a frame allocates
//!
//! A frame submits nothing and waits for nothing. [`Scene::record`] allocates memory on the device only
//! - after objects were added, removed or outgrew their capacity, and for a view that is recorded for the first time;
//! - where a character shows more vertices than in any frame before: memory for skinned vertices follows what is seen;
//! - for the upload of changes: in the first frames, and where more has changed than in any frame before.
//!
//! # Examples
//!
//! A program that opens its own device draws a patch of terrain. [`Scene`], [`View`] and [`Placement`] have more.
//!
//! ```
//! use relievo::gpu::{Gpu, Options};
//! use relievo::render::{Layer, Renderer, TargetFormat};
//! use relievo::scene::{Camera, Quality, Scene, TerrainSource};
//! use relievo::terrain::config::Config;
//! # let view = |gpu: &Gpu, format| {
//! #     gpu.device()
//! #         .create_texture(&wgpu::TextureDescriptor {
//! #             label: None,
//! #             size: wgpu::Extent3d { width: 64, height: 64, depth_or_array_layers: 1 },
//! #             mip_level_count: 1,
//! #             sample_count: 1,
//! #             dimension: wgpu::TextureDimension::D2,
//! #             format,
//! #             usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
//! #             view_formats: &[],
//! #         })
//! #         .create_view(&Default::default())
//! # };
//!
//! // Load.
//! let gpu = Gpu::headless(&Options::default())?; // or Gpu::from_wgpu(device, queue)
//! let mut scene = Scene::new(&gpu)?;
//! let land = scene.add_terrain(&TerrainSource::new(Config::new(33, 6.0, "any text")?))?;
//! let format = TargetFormat::new(wgpu::TextureFormat::Rgba8UnormSrgb); // and Depth32Float
//! let mut renderer = Renderer::new(&gpu, &format)?;
//! renderer.prepare(&scene)?;
//! let mut eye = scene.view(Quality::default())?;
//! # let color = view(&gpu, wgpu::TextureFormat::Rgba8UnormSrgb);
//! # let depth = view(&gpu, wgpu::TextureFormat::Depth32Float);
//!
//! // A frame: from the south, 20 units above the middle of the patch.
//! let height = scene.ground(land, 16.0, 16.0)?.map_or(0.0, |point| point.height as f32);
//! let (from, to) = ([16.0, height + 20.0, 60.0], [16.0, height, 16.0]);
//! eye.set(Camera::looking_at(from.into(), to.into(), 0.8, [0.1, 500.0], [64, 64]))?;
//! scene.advance(1.0 / 60.0)?;
//! let mut encoder = gpu.device().create_command_encoder(&Default::default());
//! scene.record(&mut encoder, &mut [&mut eye])?;
//! {
//!     let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
//!         // The program's own attachments, cleared to its sky and to depth 1.
//! #       color_attachments: &[Some(wgpu::RenderPassColorAttachment {
//! #           view: &color,
//! #           depth_slice: None,
//! #           resolve_target: None,
//! #           ops: wgpu::Operations::default(),
//! #       })],
//! #       depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
//! #           view: &depth,
//! #           depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
//! #           stencil_ops: None,
//! #       }),
//!         ..Default::default()
//!     });
//!     renderer.draw(&mut pass, &scene, &eye, Layer::Color)?;
//! }
//! gpu.queue().submit([encoder.finish()]);
//! # gpu.wait()?;
//! # Ok::<(), relievo::Error>(())
//! ```

mod camera;
mod character;
pub(crate) mod drawable;
mod frame;
mod handles;
mod instances;
pub(crate) mod layout;
pub(crate) mod layouts;
pub(crate) mod material;
pub(crate) mod mesh;
pub(crate) mod object;
mod objects;
mod paging;
mod pick;
mod placement;
mod quality;
pub(crate) mod query;
mod ray;
mod relief;
mod spawned;
mod statistics;
mod terrain;
mod view;
mod watch;

use std::sync::Arc;

pub use camera::{Camera, Depth};
pub use handles::{InstanceId, ObjectId};
pub use pick::Bounds;
pub use placement::{ClipTime, Placement, Play};
pub use quality::{Quality, Shares};
pub use ray::{Hit, Ray};
pub use relief::Relief;
pub use statistics::{
    CharacterStatistics, LevelStatistics, ObjectStatistics, SceneStatistics, StageTimes, ViewStatistics,
};
pub use terrain::TerrainSource;
pub use view::View;
pub use watch::{WatchedBone, WatchedBones};

use crate::asset::Light;
use crate::gpu::{Gpu, Staged, StagingRing};
use crate::lod::assign::AssignPass;
use crate::lod::list::ListPass;
use crate::lod::select::SelectPass;
use crate::{Error, InputError};
use handles::{Slots, stale};
use layout::Layout;
use layouts::SceneLayouts;
use object::{Kind, Object};
use statistics::{SceneCounts, StageTimer};
use watch::Watch;

/// The number of recordings that may wait for their submission or execution.
pub const RECORDINGS: usize = 4;

/// Everything there is, on the device: objects, which are terrain, meshes, reliefs and characters, and instances of them.
///
/// # Examples
///
/// A crowd of 100 foxes, 20 of which walk backwards, and one of which leaves.
///
/// ```no_run
/// use relievo::asset::Model;
/// use relievo::scene::{Placement, Play, Scene};
/// # let (device, queue): (wgpu::Device, wgpu::Queue) = unimplemented!();
///
/// let gpu = relievo::gpu::Gpu::from_wgpu(device, queue);
/// let mut scene = Scene::new(&gpu)?;
/// let mut model = Model::from_file("fox.glb".as_ref())?;
/// relievo::skinning::add_levels(&mut model, &[0], 60)?; // levels of detail, for the first clip's poses
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
    /// Tells this scene's views from others'.
    token: Arc<()>,
    objects: Slots<Object>,
    shares: Shares,
    light: Light,
    /// Seconds since the scene began, and seconds since the last frame.
    now: f64,
    step: f32,
    /// Number of frames that were recorded.
    frames: u64,
    layout: Option<Layout>,
    layouts: u64,
    staging: StagingRing,
    staged: Staged,
    uploaded: usize,
    passes: Passes,
    layouts_of_groups: SceneLayouts,
    /// Whether frames are counted.
    counted: bool,
    counts: Option<SceneCounts>,
    timer: Option<StageTimer>,
    watch: Option<Watch>,
}

#[derive(Debug)]
struct Passes {
    select: SelectPass,
    list: ListPass,
    assign: AssignPass,
}

impl Scene {
    /// An empty scene.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        let passes = Passes {
            select: SelectPass::new(gpu)?,
            list: ListPass::new(gpu)?,
            assign: AssignPass::new(gpu)?,
        };
        Ok(Self {
            gpu: gpu.clone(),
            token: Arc::default(),
            objects: Slots::default(),
            shares: Shares::default(),
            light: Light::default(),
            now: 0.0,
            step: 0.0,
            frames: 0,
            layout: None,
            layouts: 0,
            staging: StagingRing::new(RECORDINGS),
            staged: Staged::default(),
            uploaded: 0,
            passes,
            layouts_of_groups: SceneLayouts::new(gpu)?,
            counted: false,
            counts: None,
            timer: None,
            watch: None,
        })
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Sets the light of everything, from the next recording on. Its direction is one of the world, towards the light.
    ///
    /// # Errors
    /// [`InputError`] as [`Light::validate`].
    pub fn set_light(&mut self, light: Light) -> Result<(), InputError> {
        light.validate()?;
        self.light = light;
        Ok(())
    }

    /// Sets how the permitted displacement of characters is divided, from the next recording on.
    ///
    /// # Errors
    /// [`InputError`] as [`Shares::validate`].
    pub fn set_shares(&mut self, shares: Shares) -> Result<(), InputError> {
        shares.validate()?;
        self.shares = shares;
        for object in self.objects.iter_mut() {
            if let Kind::Character(_) = object.kind {
                object.mesh_fraction = shares.mesh;
            }
        }
        self.layout = None;
        Ok(())
    }

    /// Advances the time of the scene by so many seconds; negative ones go back. Call it once a frame: what is sampled in a
    /// frame depends on how far the time went.
    ///
    /// # Errors
    /// [`InputError`] for seconds that are not finite.
    pub fn advance(&mut self, seconds: f32) -> Result<(), InputError> {
        crate::animation::instance::check_seconds("seconds", seconds)?;
        self.now += f64::from(seconds);
        self.step = seconds;
        Ok(())
    }

    /// The factor by which the displacement that levels of detail may use was enlarged in the last frame, because the
    /// vertices of what is seen of a character exceed what one binding of the device holds. It is 1 where the views'
    /// [`Quality::pixels`] holds.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn coarsening(&self, object: ObjectId) -> Result<f32, InputError> {
        let ObjectId { index, generation } = object;
        let entry =
            self.objects.get([index, generation]).ok_or_else(|| stale("object", index, generation))?;
        Ok(entry.coarsening)
    }

    /// The number of bytes that the last recorded frame took from the host: cameras, times, and what has changed.
    pub fn uploaded(&self) -> usize {
        self.uploaded
    }

    /// The time of the scene in seconds.
    pub fn time(&self) -> f64 {
        self.now
    }

    /// A view into the scene.
    ///
    /// # Errors
    /// [`InputError`] for pixels that are negative or not finite; [`crate::gpu::GpuError`].
    pub fn view(&self, quality: Quality) -> Result<View, Error> {
        View::new(&self.gpu, &self.token, quality)
    }
}
