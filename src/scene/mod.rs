//! A scene: terrain, meshes and characters on the device, seen through any number of views.
//!
//! A [`Scene`] is everything there is; it knows no camera and no target. A [`View`] is a camera into it, with what it
//! sees and how fine. [`render::Renderer`](crate::render) draws a scene through a view in the caller's render pass.
//!
//! In a frame, the caller moves instances, advances the time, sets the cameras of the views, records the scene's work
//! into an encoder of its own ([`Scene::record`]), and draws. Nothing is submitted, waited for or allocated in a frame,
//! except where an object outgrows its capacity.

mod camera;
mod character;
pub(crate) mod drawable;
mod handles;
mod instances;
pub(crate) mod layout;
pub(crate) mod layouts;
pub(crate) mod material;
pub(crate) mod mesh;
pub(crate) mod object;
mod paging;
mod placement;
mod quality;
pub(crate) mod query;
mod relief;
mod terrain;
mod view;

use std::sync::Arc;

pub use camera::{Camera, Depth};
pub use handles::{InstanceId, ObjectId};
pub use placement::{ClipTime, Placement, Play};
pub use quality::{Quality, Shares};
pub use relief::Relief;
pub use terrain::TerrainSource;
pub use view::View;

use crate::animation::Frame;
use crate::asset::{Light, Model};
use crate::gpu::{Gpu, Staged, StagingRing, Upload as _, compute_pass};
use crate::lod::SelectView;
use crate::lod::assign::AssignPass;
use crate::lod::list::ListPass;
use crate::lod::select::SelectPass;
use crate::skinning::picture::is_mirrored;
use crate::terrain::mesh::GroundPoint;
use crate::{Error, InputError};
use drawable::{Drawable, DrawnObject, DrawnView};
use handles::{Slots, stale};
use layout::Layout;
use layouts::SceneLayouts;
use object::{Kind, Object};

/// The number of recordings that may wait for their submission or execution.
pub const RECORDINGS: usize = 4;

/// Everything there is, on the device.
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
    frame: u32,
    layout: Option<Layout>,
    layouts: u64,
    staging: StagingRing,
    staged: Staged,
    uploaded: usize,
    passes: Passes,
    layouts_of_groups: SceneLayouts,
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
            frame: 0,
            layout: None,
            layouts: 0,
            staging: StagingRing::new(RECORDINGS),
            staged: Staged::default(),
            uploaded: 0,
            passes,
            layouts_of_groups: SceneLayouts::new(gpu)?,
        })
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Adds terrain: generates its patches, and shows them.
    ///
    /// # Errors
    /// [`InputError`] for a configuration or patches out of bounds, and for more patches than one binding holds;
    /// [`crate::gpu::GpuError`].
    pub fn add_terrain(&mut self, source: &TerrainSource) -> Result<ObjectId, Error> {
        let object = Object::terrain(&self.gpu, &self.layouts_of_groups, source)?;
        Ok(self.add(object))
    }

    /// The ground of a terrain that is drawn, at a position of the world in world units east and south of its origin: height
    /// and normal of the triangle there. `None` where the terrain has no patch.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, or no terrain.
    pub fn ground(&self, terrain: ObjectId, x: f64, z: f64) -> Result<Option<GroundPoint>, InputError> {
        let ObjectId { index, generation } = terrain;
        let object =
            self.objects.get([index, generation]).ok_or_else(|| stale("terrain", index, generation))?;
        match &object.kind {
            Kind::Terrain(terrain) => Ok(terrain.point_at(x, z)),
            _ => Err(InputError::new("terrain", "a mesh or a character", "must be terrain")),
        }
    }

    /// Adds a mesh that does not move by itself: all meshes of a model, posed at rest, with their levels of detail
    /// ([`add_levels`](crate::skinning::add_levels)) and materials. There is room for `capacity` instances; more than
    /// that let it grow, which allocates.
    ///
    /// # Errors
    /// [`InputError`] for a model without meshes or with invalid ones; [`crate::gpu::GpuError`].
    pub fn add_mesh(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        let object = Object::mesh(&self.gpu, &self.layouts_of_groups, model, capacity)?;
        Ok(self.add(object))
    }

    /// Adds a character: its bones are sampled from its clips, gated, and its meshes morphed and skinned, each only as
    /// far as a view needs. A model without clips becomes a mesh ([`Scene::add_mesh`]). There is room for `capacity`
    /// instances; more than that let it grow, which allocates and lets all of them start afresh.
    ///
    /// # Errors
    /// [`InputError`] for a model without meshes or with invalid ones; [`crate::gpu::GpuError`].
    pub fn add_character(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        if model.clips.is_empty() {
            return self.add_mesh(model, capacity);
        }
        let object = Object::character(&self.gpu, &self.layouts_of_groups, model, capacity, self.shares)?;
        Ok(self.add(object))
    }

    /// Adds a mesh that carries a relief. There is room for `capacity` instances; more than that let it grow, which
    /// allocates.
    ///
    /// # Errors
    /// [`InputError`] for maps, options or a mesh that do not fit each other; [`crate::gpu::GpuError`].
    pub fn add_relief(&mut self, relief: &Relief, capacity: usize) -> Result<ObjectId, Error> {
        let object = Object::relief(&self.gpu, &self.layouts_of_groups, relief, capacity)?;
        Ok(self.add(object))
    }

    fn add(&mut self, object: Object) -> ObjectId {
        self.layout = None;
        let [index, generation] = self.objects.insert(object);
        ObjectId { index, generation }
    }

    /// Removes an object with all of its instances, and releases its memory.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn remove(&mut self, object: ObjectId) -> Result<(), InputError> {
        let ObjectId { index, generation } = object;
        self.objects.remove([index, generation]).ok_or_else(|| stale("object", index, generation))?;
        self.layout = None;
        Ok(())
    }

    /// Shows or hides all instances of an object. Hidden ones cost nothing, and go on playing.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene; [`crate::gpu::GpuError`].
    pub fn show(&mut self, object: ObjectId, is_shown: bool) -> Result<(), Error> {
        let entry = self.object_mut(object)?;
        if std::mem::replace(&mut entry.is_shown, is_shown) != is_shown {
            // Until the next layout, the object's entry is written alone.
            let (value, number) = (entry.lod_object(), entry.number);
            if let Some(layout) = &self.layout {
                self.staged.elements(&layout.objects, number, &[value])?;
            }
        }
        Ok(())
    }

    /// Spawns an instance. A character plays the first clip of its model, from time 0 of the scene on; see
    /// [`Scene::play`]. If there is no room, the object grows to twice its capacity.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, for terrain, whose patches are its instances, and as
    /// [`Placement::checked`]; [`crate::gpu::GpuError`].
    pub fn spawn(&mut self, object: ObjectId, placement: Placement) -> Result<InstanceId, Error> {
        let placement = placement.checked()?;
        let (gpu, layouts) = (self.gpu.clone(), self.layouts_of_groups.clone());
        let entry = self.object_mut(object)?;
        if let Kind::Terrain(_) = entry.kind {
            return Err(InputError::new("object", "terrain", "must be a mesh or a character").into());
        }
        let mut has_grown = false;
        if entry.instances.alive() == entry.instances.capacity() {
            entry.grow(&gpu, &layouts)?;
            has_grown = true;
        }
        let spawned = entry.instances.spawn(&placement, &entry.sphere);
        let Some([index, generation]) = spawned else {
            return Err(InputError::new("object.capacity", entry.capacity(), "must have room").into());
        };
        if let Kind::Character(character) = &mut entry.kind {
            let sphere = character.play_first(index);
            entry.instances.change(index, |instance| instances::bound(instance, &sphere));
        }
        if has_grown {
            self.layout = None;
        }
        Ok(InstanceId { object, index, generation })
    }

    /// Removes an instance.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn despawn(&mut self, instance: InstanceId) -> Result<(), InputError> {
        self.instance_mut(instance)?.instances.despawn(instance.index);
        Ok(())
    }

    /// Moves an instance.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, and as [`Placement::checked`].
    pub fn move_to(&mut self, instance: InstanceId, placement: Placement) -> Result<(), InputError> {
        let placement = placement.checked()?;
        let object = self.instance_mut(instance)?;
        object.instances.change(instance.index, |instance| instances::place(instance, &placement));
        Ok(())
    }

    /// Lets a character play a clip.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, for a clip that its model does
    /// not have, and as [`Play::validate`].
    pub fn play(&mut self, instance: InstanceId, play: &Play<'_>) -> Result<(), InputError> {
        let object = self.instance_mut(instance)?;
        let Kind::Character(character) = &mut object.kind else {
            return Err(InputError::new("instance", "a mesh", "must be an instance of a character"));
        };
        let sphere = character.play(instance.index, play)?;
        object.instances.change(instance.index, |instance| instances::bound(instance, &sphere));
        Ok(())
    }

    /// Sets the colour by which an instance's colours are multiplied: linear red, green, blue and alpha, each 0 to 1.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, and for values out of range.
    pub fn set_tint(&mut self, instance: InstanceId, tint: [f32; 4]) -> Result<(), InputError> {
        if let Some(at) = tint.iter().position(|value| !(0.0..=1.0).contains(value)) {
            return Err(InputError::new(format!("tint[{at}]"), tint[at], "must be in 0..=1"));
        }
        let packed = u32::from_le_bytes(tint.map(|value| (value * 255.0 + 0.5) as u8));
        self.instance_mut(instance)?.instances.change(instance.index, |instance| instance.tint = packed);
        Ok(())
    }

    /// Sets a word that the caller's own shading may read for an instance; 0 at first.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn set_word(&mut self, instance: InstanceId, word: u32) -> Result<(), InputError> {
        self.instance_mut(instance)?.instances.change(instance.index, |instance| instance.word = word);
        Ok(())
    }

    /// Sets the visibility mask of an instance, and whether it casts shadows. At first all bits are set, and it casts.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn set_visibility(&mut self, instance: InstanceId, mask: u16, casts: bool) -> Result<(), InputError> {
        let object = self.instance_mut(instance)?;
        object.instances.change(instance.index, |instance| instance.flags = instances::flags(mask, casts));
        Ok(())
    }

    /// Sets the light of everything, from the next frame on.
    ///
    /// # Errors
    /// [`InputError`] as [`Light::validate`].
    pub fn set_light(&mut self, light: Light) -> Result<(), InputError> {
        light.validate()?;
        self.light = light;
        Ok(())
    }

    /// Sets how the permitted displacement of characters is divided.
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

    /// Advances the time of the scene by so many seconds; negative ones go back.
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

    /// Gives up all recordings whose encoders were dropped, and lets everything start afresh.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn invalidate(&mut self) -> Result<(), Error> {
        self.staging.invalidate();
        self.staged = Staged::default();
        self.refresh()
    }

    /// Lets the next frame sample and skin everything that is seen in full, and upload every instance again. The result
    /// is the picture of a scene that was made anew.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn refresh(&mut self) -> Result<(), Error> {
        for object in self.objects.iter_mut() {
            object.refresh(&self.gpu, &self.layouts_of_groups)?;
        }
        self.layout = None;
        Ok(())
    }

    /// Records a frame: what changed, what each view sees and how fine, and the poses and vertices of the characters that
    /// any of them sees. Draw afterwards, in passes of the same encoder or of later ones. Two recordings for one
    /// submission are two frames.
    ///
    /// # Errors
    /// [`InputError`] for no view, a view of another scene or without a camera, and if [`RECORDINGS`] frames have been
    /// recorded that the device has not executed; [`crate::gpu::GpuError`].
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        views: &mut [&mut View],
    ) -> Result<(), Error> {
        self.check(views)?;
        self.fit(views)?;
        self.stage(views)?;
        let gpu = self.gpu.clone();
        self.uploaded = self.staged.len();
        if !self.staging.record(&gpu, encoder, &mut self.staged)? {
            let bound = format!("must be below {RECORDINGS}: submit what was recorded, or call invalidate()");
            return Err(InputError::new("recordings", self.staging.busy(), bound).into());
        }
        let mut pass = compute_pass(encoder, "scene");
        views.iter().for_each(|view| view.dispatch(&mut pass));
        for object in self.objects.iter() {
            if let Kind::Character(character) = &object.kind {
                character.dispatch(&mut pass);
            }
        }
        self.frame = self.frame.wrapping_add(1);
        // Unless the time advances again, the next frame is as this one.
        self.step = 0.0;
        Ok(())
    }

    /// What is drawn, object by object.
    pub(crate) fn drawables(&self) -> impl Iterator<Item = &Drawable> {
        self.objects.iter().flat_map(|object| &object.drawables)
    }

    /// What a renderer needs of a view and of all objects that are shown.
    pub(crate) fn drawn<'a>(
        &'a self,
        view: &'a View,
    ) -> Result<(DrawnView<'a>, Vec<DrawnObject<'a>>), InputError> {
        if !view.is_of(&self.token) {
            return Err(InputError::new("view", "of another scene", "must be of this scene"));
        }
        let (Some(layout), Some(lists), Some(camera)) = (&self.layout, &view.lists, view.camera()) else {
            return Err(InputError::new("view", "not recorded", "must be recorded before it is drawn"));
        };
        if lists.version != layout.version {
            let bound = "must be recorded again, since objects were added or grew";
            return Err(InputError::new("view", "out of date", bound));
        }
        let drawn = DrawnView {
            group: &lists.group,
            lists: &lists.lists,
            arguments: &lists.arguments,
            mirrors: is_mirrored(&camera.clip_from_world()),
            reversed: camera.depth == Depth::Reversed,
        };
        let mut terrains = 0;
        let mut objects = Vec::new();
        for object in self.objects.iter() {
            let ground = object.spacing().and_then(|_| view.ground(terrains));
            terrains += usize::from(object.spacing().is_some());
            if object.is_shown {
                let of_object = object.drawables.iter().zip(&object.lods);
                objects.extend(of_object.map(|(drawable, lod)| DrawnObject {
                    drawable,
                    lod,
                    mirrors: true,
                    ground,
                }));
            }
        }
        Ok((drawn, objects))
    }

    fn check(&self, views: &[&mut View]) -> Result<(), InputError> {
        if views.is_empty() {
            return Err(InputError::new("views", "none", "must be at least one"));
        }
        if let Some(at) = views.iter().position(|view| !view.is_of(&self.token)) {
            return Err(InputError::new(format!("views[{at}]"), "of another scene", "must be of this scene"));
        }
        Ok(())
    }

    /// Allocates what objects and views need since something was added or grew.
    fn fit(&mut self, views: &mut [&mut View]) -> Result<(), Error> {
        if self.layout.is_none() {
            self.layouts += 1;
            let layout = object::laid_out(&self.gpu, &mut self.objects, self.layouts)?;
            self.objects.iter_mut().for_each(|object| object.instances.change_all());
            self.layout = Some(layout);
        }
        let Some(layout) = &self.layout else { return Ok(()) };
        for object in self.objects.iter_mut() {
            object.fit(&self.gpu, layout, (&self.passes.assign, self.shares), &mut self.staged)?;
        }
        let terrains = self.objects.iter().filter_map(Object::spacing).count();
        for view in views {
            let passes = (&self.passes.select, &self.passes.list);
            view.fit(&self.gpu, layout, passes, (&self.layouts_of_groups, terrains))?;
        }
        Ok(())
    }

    fn stage(&mut self, views: &[&mut View]) -> Result<(), Error> {
        let Some(layout) = &self.layout else { return Ok(()) };
        let seen = views.iter().map(|view| Ok(view.select_view(layout.blocks, true)?.1));
        let seen = seen.collect::<Result<Vec<SelectView>, InputError>>()?;
        for object in self.objects.iter_mut() {
            object.provide(&self.gpu, &self.layouts_of_groups, &seen, (&mut self.staged, layout))?;
        }
        let spacings: Vec<f64> = self.objects.iter().filter_map(Object::spacing).collect();
        for (at, view) in views.iter().enumerate() {
            view.stage(&mut self.staged, (layout.blocks, &self.light), &spacings, at == 0)?;
        }
        let frame = Frame { ticks: 0, frame_ticks: 0, frame: self.frame, ahead: self.step };
        for object in self.objects.iter_mut() {
            let first = object.range.first as usize;
            for (at, run) in object.instances.take_changed() {
                self.staged.elements(&layout.instances, first + at, run)?;
            }
            if let Kind::Character(character) = &mut object.kind {
                character.stage(&mut self.staged, &frame, self.now)?;
            }
        }
        Ok(())
    }

    fn object_mut(&mut self, object: ObjectId) -> Result<&mut Object, InputError> {
        let ObjectId { index, generation } = object;
        self.objects.get_mut([index, generation]).ok_or_else(|| stale("object", index, generation))
    }

    fn instance_mut(&mut self, instance: InstanceId) -> Result<&mut Object, InputError> {
        let InstanceId { index, generation, .. } = instance;
        let object = self.object_mut(instance.object)?;
        match object.instances.contains([index, generation]) {
            true => Ok(object),
            false => Err(stale("instance", index, generation)),
        }
    }
}
