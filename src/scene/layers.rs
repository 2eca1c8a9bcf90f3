//! Animation layers, cross-fades and root motion.

use crate::InputError;
use crate::asset::Transform;
use crate::scene::Scene;
use crate::scene::character::{Character, Weight};
use crate::scene::handles::{InstanceId, no_character};
use crate::scene::placement::Play;

impl Scene {
    /// Plays a clip on a layer, over the base and the layers below, with a weight. At weight 0 the layer has no effect. At
    /// weight 1, the layer replaces the base and the layers below, on all bones of the layer. Layers are counted from 1
    /// ([`CharacterOptions::layers`](crate::scene::CharacterOptions::layers)). Rotations are blended along the chord
    /// ([`animation::layers`](crate::animation::layers)). Weights of morph targets always come from the base.
    ///
    /// While a layer has a weight above 0, all bones of the instance are sampled in every frame that shows the instance.
    /// While the weight is above 0, culling uses a sphere that holds the instance in any blend of the model's clips.
    ///
    /// # Errors
    /// The errors of [`Scene::play`]; [`InputError`] for a layer that the character does not have, and for a weight outside
    /// 0..=1.
    ///
    /// # Examples
    ///
    /// Waving while walking, on layer 1.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Play, Scene};
    /// # fn example(scene: &mut Scene, walker: InstanceId) -> Result<(), relievo::Error> {
    /// scene.play(walker, &Play::new("walk"))?;
    /// scene.play_layer(walker, 1, &Play::new("wave"), 1.0)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn play_layer(
        &mut self,
        instance: InstanceId,
        layer: usize,
        play: &Play<'_>,
        weight: f32,
    ) -> Result<(), InputError> {
        let fade = Weight { to: weight, start: self.now, ..Weight::default() };
        let character = self.character_mut(instance)?;
        character.fade(instance.index, layer, fade)?;
        character.play_on(instance.index, layer, play)?;
        self.bound_again(instance)
    }

    /// Changes the weight of a layer linearly to `weight`, over `seconds` of the scene's time from now on.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, for a layer that the character does
    /// not have, for a weight outside 0..=1, and for seconds outside 0..=1e6.
    ///
    /// # Examples
    ///
    /// A wave that begins and ends softly.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Play, Scene};
    /// # fn example(scene: &mut Scene, walker: InstanceId) -> Result<(), relievo::Error> {
    /// scene.play_layer(walker, 1, &Play::new("wave"), 0.0)?;
    /// scene.fade_layer(walker, 1, 1.0, 0.3)?;
    /// // … two seconds later
    /// scene.fade_layer(walker, 1, 0.0, 0.3)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn fade_layer(
        &mut self,
        instance: InstanceId,
        layer: usize,
        weight: f32,
        seconds: f32,
    ) -> Result<(), InputError> {
        let fade = Weight { to: weight, start: self.now, seconds, ..Weight::default() };
        self.character_mut(instance)?.fade(instance.index, layer, fade)?;
        self.bound_again(instance)
    }

    /// Cross-fades from the base's clip to another clip over `seconds` of the scene's time. Meanwhile `layer` plays the new
    /// clip with a weight that grows from 0 to 1. This layer must affect all bones
    /// ([`LayerMask::All`](crate::scene::LayerMask::All)). Afterwards the base plays the new clip, and the layer is free
    /// again.
    ///
    /// # Errors
    /// The errors of [`Scene::play_layer`] and [`Scene::fade_layer`]; [`InputError`] for a layer with a mask.
    ///
    /// # Examples
    ///
    /// From walking to running in a quarter of a second. Layer 1 is a [`LayerMask::All`](crate::scene::LayerMask::All).
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Play, Scene};
    /// # fn example(scene: &mut Scene, walker: InstanceId) -> Result<(), relievo::Error> {
    /// scene.cross_fade(walker, 1, &Play { start: scene.time(), ..Play::new("run") }, 0.25)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn cross_fade(
        &mut self,
        instance: InstanceId,
        layer: usize,
        play: &Play<'_>,
        seconds: f32,
    ) -> Result<(), InputError> {
        let off = Weight { start: self.now, hands_over: true, ..Weight::default() };
        let character = self.character_mut(instance)?;
        character.fade(instance.index, layer, off)?;
        character.play_on(instance.index, layer, play)?;
        character.fade(instance.index, layer, Weight { to: 1.0, seconds, ..off })?;
        self.bound_again(instance)
    }

    /// The root motion of an instance between two scene times in seconds, extracted from its base clip
    /// ([`CharacterOptions::root_motion`](crate::scene::CharacterOptions::root_motion)). The motion is a rotation about +Y
    /// and a translation, in model space at the first time. The caller decides how much of it to apply.
    /// [`Placement::moved_by`](crate::scene::Placement::moved_by) applies a motion to a placement.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, is no character, or has no extracted motion, and for
    /// times that are not finite.
    ///
    /// # Examples
    ///
    /// In each frame, the instance moves as far as its clip has walked.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Scene};
    /// # fn example(scene: &mut Scene, walker: InstanceId) -> Result<(), relievo::Error> {
    /// let before = scene.time();
    /// scene.advance(1.0 / 60.0)?;
    /// let motion = scene.root_motion(walker, before, scene.time())?;
    /// scene.move_to(walker, scene.placement(walker)?.moved_by(&motion))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn root_motion(&self, instance: InstanceId, from: f64, to: f64) -> Result<Transform, InputError> {
        let character = self.object_of(instance)?.character().ok_or_else(no_character)?;
        character.root_motion(instance.index, from, to)
    }

    pub(super) fn character_mut(&mut self, instance: InstanceId) -> Result<&mut Character, InputError> {
        self.instance_mut(instance)?.character_mut().ok_or_else(no_character)
    }

    /// Updates the bounding sphere of an instance after its clip or layers changed.
    fn bound_again(&mut self, instance: InstanceId) -> Result<(), InputError> {
        self.instance_mut(instance)?.bound_again(instance.index);
        self.carry(instance)
    }
}
