//! Spawning, moving and changing instances.

use crate::scene::Scene;
use crate::scene::handles::{InstanceId, ObjectId, missing, no_character};
use crate::scene::instances;
use crate::scene::object::Object;
use crate::scene::placement::{Placement, Play};
use crate::{Error, InputError};

impl Scene {
    /// Spawns an instance, which is visible from the next recording on. An instance of a character plays the first clip
    /// of its model, from scene time 0 on; see [`Scene::play`].
    ///
    /// If the object is full, it grows to twice its capacity. Growth allocates memory, in this call and in the next
    /// recording. After growth, all instances of a character are sampled and skinned in full once. Handles stay valid,
    /// and no pipeline needs to be compiled. Views must be recorded again before they are drawn.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, for terrain (its instances are its patches), and for a
    /// placement that [`Placement::checked`] refuses; [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Placement, Scene};
    /// # fn example(scene: &mut Scene, fox: ObjectId) -> Result<(), relievo::Error> {
    /// // A model in centimetres, a kilometre to the east, turned by a quarter turn to the left.
    /// let place = Placement::at_world([1000.0, 0.0, 0.0]).turned(std::f32::consts::FRAC_PI_2).scaled(0.01);
    /// let instance = scene.spawn(fox, place)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn spawn(&mut self, object: ObjectId, placement: Placement) -> Result<InstanceId, Error> {
        let placement = placement.checked()?;
        let (gpu, layouts) = (self.gpu.clone(), self.layouts_of_groups.clone());
        let entry = self.object_mut(object)?;
        InputError::check(entry.kind.is_spawned(), "object", "terrain", || "must be a mesh or a character")?;
        let mut has_grown = false;
        if entry.instances.alive() == entry.instances.capacity() {
            entry.grow(&gpu, &layouts)?;
            has_grown = true;
        }
        let spawned = entry.instances.spawn(&placement, &entry.sphere);
        let Some([index, generation]) = spawned else {
            return Err(InputError::new("object.capacity", entry.capacity(), "must have room").into());
        };
        if let Some(sphere) = entry.kind.spawned(index) {
            entry.instances.change(index, |instance| instances::bound(instance, &sphere));
        }
        if has_grown {
            self.layout = None;
        }
        Ok(InstanceId { object, index, generation })
    }

    /// Removes an instance. The instance's handle becomes stale, even if another instance takes over the memory.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, and for a patch of terrain.
    pub fn despawn(&mut self, instance: InstanceId) -> Result<(), InputError> {
        self.spawned_mut(instance)?;
        self.let_go(instance)?;
        let object = self.instance_mut(instance)?;
        object.kind.despawned(instance.index);
        object.instances.despawn(instance.index);
        Ok(())
    }

    /// Replaces an instance's placement: moves, turns and scales the instance. An attached instance stays at its bone
    /// until it is detached; then it takes the new placement.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, for a patch of terrain, and for a placement that
    /// [`Placement::checked`] refuses.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use glam::DVec3;
    /// # use relievo::scene::{InstanceId, Placement, Scene};
    /// # fn example(scene: &mut Scene, fox: InstanceId) -> Result<(), relievo::Error> {
    /// let here = scene.placement(fox)?;
    /// let there = here.world() + DVec3::new(0.0, 0.0, -1.5);
    /// scene.move_to(fox, Placement { turn: here.turn, scale: here.scale, ..Placement::at_world(there) })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn move_to(&mut self, instance: InstanceId, placement: Placement) -> Result<(), InputError> {
        let placement = placement.checked()?;
        self.spawned_mut(instance)?;
        if self.move_detached(instance, placement) {
            return Ok(());
        }
        let object = self.instance_mut(instance)?;
        object.instances.change(instance.index, |instance| instances::place(instance, &placement));
        self.carry(instance)
    }

    /// Starts a clip on an instance of a character, at once and without a transition.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, for a clip that the instance's
    /// model does not have, and for values that [`Play::validate`] refuses.
    ///
    /// # Examples
    ///
    /// One instance walks backwards at half speed, and another jumps and stays in its last pose.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Play, Scene, Wrap};
    /// # fn example(scene: &mut Scene, one: InstanceId, other: InstanceId) -> Result<(), relievo::Error> {
    /// scene.play(one, &Play { rate: -0.5, ..Play::new("walk") })?;
    /// scene.play(other, &Play { start: scene.time(), wrap: Wrap::Clamp, ..Play::new("jump") })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn play(&mut self, instance: InstanceId, play: &Play<'_>) -> Result<(), InputError> {
        let object = self.instance_mut(instance)?;
        let character = object.character_mut().ok_or_else(no_character)?;
        let sphere = character.play(instance.index, play)?;
        object.instances.change(instance.index, |instance| instances::bound(instance, &sphere));
        self.carry(instance)
    }

    /// Sets the tint of an instance: factors of red, green, blue and alpha in linear light, each 0 to 1. The default is
    /// (1, 1, 1, 1). The tint is stored in steps of 1/255. Alpha has an effect only on cut-out and dithered materials.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, for a patch of terrain, and for values out of range.
    pub fn set_tint(&mut self, instance: InstanceId, tint: [f32; 4]) -> Result<(), InputError> {
        if let Some(at) = tint.iter().position(|value| !(0.0..=1.0).contains(value)) {
            return Err(InputError::new(format!("tint[{at}]"), tint[at], "must be in 0..=1"));
        }
        let packed = u32::from_le_bytes(tint.map(|value| (value * 255.0 + 0.5) as u8));
        self.spawned_mut(instance)?.instances.change(instance.index, |instance| instance.tint = packed);
        Ok(())
    }

    /// Sets the user data of an instance: 32 bits that the caller's shading reads as `surface.user_data`. The default
    /// is 0.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    ///
    /// # Examples
    ///
    /// Marks an instance as selected; the shading makes it glow.
    ///
    /// ```no_run
    /// # use relievo::render::Renderer;
    /// # use relievo::scene::{InstanceId, Scene};
    /// # fn example(scene: &mut Scene, renderer: Renderer, fox: InstanceId) -> Result<(), relievo::Error> {
    /// scene.set_user_data(fox, 1)?; // selected
    /// let renderer = renderer.with_shading(
    ///     "fn shade(surface: Surface, view: View) -> vec4<f32> {
    ///         let glow = select(0.0, 0.3, surface.user_data == 1u);
    ///         return vec4<f32>(surface.color + glow, surface.alpha);
    ///     }",
    ///     None,
    /// )?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_user_data(&mut self, instance: InstanceId, user_data: u32) -> Result<(), InputError> {
        self.instance_mut(instance)?
            .instances
            .change(instance.index, |instance| instance.user_data = user_data);
        Ok(())
    }

    /// Sets the visibility mask of an instance; the default is `u16::MAX`. A view sees an instance if the instance's
    /// mask and the view's mask ([`View::set_mask`](crate::scene::View::set_mask)) share a bit. A mask of 0 hides the
    /// instance everywhere.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    ///
    /// # Examples
    ///
    /// Hides a body from its own first-person camera. All other views show the body.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Scene, View};
    /// # fn example(scene: &mut Scene, body: InstanceId, first_person: &mut View) -> Result<(), relievo::Error> {
    /// const OWN_BODY: u16 = 1 << 15;
    /// scene.set_visibility_mask(body, OWN_BODY)?;
    /// first_person.set_mask(!OWN_BODY);
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_visibility_mask(&mut self, instance: InstanceId, mask: u16) -> Result<(), InputError> {
        let object = self.instance_mut(instance)?;
        object.instances.change(instance.index, |instance| instances::set_mask(instance, mask));
        Ok(())
    }

    /// Sets whether an instance casts shadows; the default is true. Some views show only casters
    /// ([`View::set_casters_only`](crate::scene::View::set_casters_only)), such as the view of a
    /// [`SunShadow`](crate::render::SunShadow). They leave out instances that cast no shadow.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn set_casts_shadow(&mut self, instance: InstanceId, casts: bool) -> Result<(), InputError> {
        let object = self.instance_mut(instance)?;
        object.instances.change(instance.index, |instance| instances::set_casts(instance, casts));
        Ok(())
    }

    /// Like [`Self::instance_mut`], but refuses patches of terrain, which the caller did not spawn.
    fn spawned_mut(&mut self, instance: InstanceId) -> Result<&mut Object, InputError> {
        let object = self.instance_mut(instance)?;
        if object.kind.is_spawned() {
            return Ok(object);
        }
        let bound = "must be an instance of a mesh or a character";
        Err(InputError::new("instance", "a patch of terrain", bound))
    }

    pub(super) fn instance_mut(&mut self, instance: InstanceId) -> Result<&mut Object, InputError> {
        let scene = self.objects.scene();
        self.objects.existing_mut(instance).ok_or_else(|| missing(scene, instance))
    }
}
