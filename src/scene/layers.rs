//! Clips above clips: layers, blends, and root motion.

use crate::InputError;
use crate::animation::RootMotion;
use crate::animation::root_motion::Taken;
use crate::asset::{Model, Transform};
use crate::scene::Scene;
use crate::scene::character::Character;
use crate::scene::handles::InstanceId;
use crate::scene::object::Kind;
use crate::scene::placement::Play;

/// What a character can do beyond playing one clip, for
/// [`Scene::add_character_with`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CharacterOptions<'a> {
    /// The layers above the base, at most 7; none of them is heard at first. Each costs 16 bytes an instance, and as much as the
    /// base where it is heard.
    pub layers: Vec<LayerMask<'a>>,
    /// The motion that is taken out of all clips, which then play in place; see [`Scene::root_motion`].
    pub root_motion: Option<RootOptions<'a>>,
}

/// The bones on which a layer plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerMask<'a> {
    /// All bones.
    All,
    /// A bone, by its name or its index, and all bones below it.
    Below(&'a str),
}

/// The motion that is taken out of clips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RootOptions<'a> {
    /// The bone whose motion it is, by its name or its index.
    pub bone: &'a str,
    /// Which parts of its motion.
    pub taken: Taken,
}

/// The index of a bone of a model, by its name or its index. A name that is a number takes precedence.
///
/// # Errors
/// [`InputError`] for a bone that the model does not have.
pub(super) fn bone_of(model: &Model, name_or_index: &str) -> Result<usize, InputError> {
    let bones = model.skeleton.bones();
    let by_name = bones.iter().position(|bone| bone.name == name_or_index);
    let by_index = || name_or_index.parse().ok().filter(|index| *index < bones.len());
    by_name.or_else(by_index).ok_or_else(|| {
        let bound = format!("must be below {} or the name of a bone of the model", bones.len());
        InputError::new("bone", name_or_index, bound)
    })
}

impl RootOptions<'_> {
    /// Takes the motion out of all clips of a model.
    ///
    /// # Errors
    /// [`InputError`] as [`RootMotion::extract`], and for a bone that the model does not have.
    pub(super) fn take(&self, model: &mut Model) -> Result<Vec<RootMotion>, InputError> {
        let bone = bone_of(model, self.bone)?;
        let extracted =
            model.clips.iter().map(|clip| RootMotion::extract(&model.skeleton, clip, bone, self.taken));
        let (clips, motions) = extracted.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        model.clips = clips;
        Ok(motions)
    }
}

impl Scene {
    /// Lets a character play a clip on a layer, over what its base and the layers below play, with a weight from 0, where the
    /// layer is not heard, to 1, where nothing else is heard on its bones. Layers are counted from 1
    /// ([`CharacterOptions::layers`]). Rotations are blended along the chord
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

    /// The motion that was taken out of the clip of an instance's base ([`CharacterOptions::root_motion`]) between two times of
    /// the scene, in seconds: a rotation about +Y and a translation, in the space of the model at the first time. The caller
    /// moves the instance by it, as far as it wants to: its placement times this is its new placement.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, is no character, or keeps its motion, and for times that are
    /// not finite.
    pub fn root_motion(&self, instance: InstanceId, from: f64, to: f64) -> Result<Transform, InputError> {
        match &self.object_of(instance)?.kind {
            Kind::Character(character) => character.root_motion(instance.index, from, to),
            _ => Err(InputError::new("instance", "a mesh", "must be an instance of a character")),
        }
    }

    fn character_mut(&mut self, instance: InstanceId) -> Result<&mut Character, InputError> {
        match &mut self.instance_mut(instance)?.kind {
            Kind::Character(character) => Ok(character),
            _ => Err(InputError::new("instance", "a mesh", "must be an instance of a character")),
        }
    }

    /// Sets the sphere of an instance that plays something else.
    fn bound_again(&mut self, instance: InstanceId) -> Result<(), InputError> {
        let object = self.instance_mut(instance)?;
        object.bound_again(instance.index);
        self.carry(instance)
    }
}
