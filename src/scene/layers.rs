//! Clips above clips: layers, blends, and root motion.

use crate::InputError;
use crate::asset::Transform;
use crate::scene::Scene;
use crate::scene::character::Character;
use crate::scene::handles::{InstanceId, no_character};
use crate::scene::placement::Play;

impl Scene {
    /// Lets a character play a clip on a layer, over what its base and the layers below play, with a weight from 0, where the
    /// layer is not heard, to 1, where nothing else is heard on its bones. Layers are counted from 1
    /// ([`CharacterOptions::layers`](crate::scene::CharacterOptions::layers)). Rotations are blended along the chord
    /// ([`animation::layers`](crate::animation::layers)); weights of morph targets are those of the base.
    ///
    /// While a layer is heard, all of the instance's bones are sampled in every frame that sees it, and it is culled by a
    /// sphere that holds any blend of the model's clips.
    ///
    /// # Errors
    /// As [`Scene::play`], and [`InputError`] for a layer that the character does not have and a weight outside 0..=1.
    pub fn play_layer(
        &mut self,
        instance: InstanceId,
        layer: usize,
        play: &Play<'_>,
        weight: f32,
    ) -> Result<(), InputError> {
        let now = self.now;
        let character = self.character_mut(instance)?;
        character.fade(instance.index, layer, (weight, 0.0, false), now)?;
        character.play_on(instance.index, layer, play)?;
        self.bound_again(instance)
    }

    /// Lets the weight of a layer change evenly to another one, in so many seconds of the scene's time from now on.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, for a layer that it does not have, for a
    /// weight outside 0..=1, and seconds outside 0..=1e6.
    pub fn fade_layer(
        &mut self,
        instance: InstanceId,
        layer: usize,
        weight: f32,
        seconds: f32,
    ) -> Result<(), InputError> {
        let now = self.now;
        self.character_mut(instance)?.fade(instance.index, layer, (weight, seconds, false), now)?;
        self.bound_again(instance)
    }

    /// Changes to another clip in so many seconds: a layer, which must have all bones, plays it with a weight that grows from 0
    /// to 1; then the base takes it over, and the layer is free again.
    ///
    /// # Errors
    /// As [`Scene::play_layer`] and [`Scene::fade_layer`], and [`InputError`] for a layer with a mask.
    pub fn cross_fade(
        &mut self,
        instance: InstanceId,
        layer: usize,
        play: &Play<'_>,
        seconds: f32,
    ) -> Result<(), InputError> {
        let now = self.now;
        let character = self.character_mut(instance)?;
        character.fade(instance.index, layer, (0.0, 0.0, true), now)?;
        character.play_on(instance.index, layer, play)?;
        character.fade(instance.index, layer, (1.0, seconds, true), now)?;
        self.bound_again(instance)
    }

    /// The motion that was taken out of the clip of an instance's base ([`CharacterOptions::root_motion`](crate::scene::CharacterOptions::root_motion)) between two times of
    /// the scene, in seconds: a rotation about +Y and a translation, in the space of the model at the first time. The caller
    /// moves the instance by it, as far as it wants to: its placement times this is its new placement
    /// ([`Placement::moved_by`](crate::scene::Placement::moved_by)).
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, is no character, or keeps its motion, and for times that are
    /// not finite.
    pub fn root_motion(&self, instance: InstanceId, from: f64, to: f64) -> Result<Transform, InputError> {
        let character = self.object_of(instance)?.character().ok_or_else(no_character)?;
        character.root_motion(instance.index, from, to)
    }

    pub(super) fn character_mut(&mut self, instance: InstanceId) -> Result<&mut Character, InputError> {
        self.instance_mut(instance)?.character_mut().ok_or_else(no_character)
    }

    /// Sets the sphere of an instance that plays something else.
    fn bound_again(&mut self, instance: InstanceId) -> Result<(), InputError> {
        self.instance_mut(instance)?.bound_again(instance.index);
        self.carry(instance)
    }
}
