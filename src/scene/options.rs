//! Options of characters and of terrain.

use crate::animation::RootMotion;
use crate::animation::root_motion::Taken;
use crate::asset::Model;
use crate::{InputError, error};

/// Animation layers and root motion of a character, for
/// [`Scene::add_character_with`](crate::scene::Scene::add_character_with).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CharacterOptions<'a> {
    /// The animation layers above the base layer, at most 7. Their weights are 0 at first. A layer costs 16 bytes per
    /// instance. While its weight is above 0, it costs as much sampling as the base layer.
    pub layers: Vec<LayerMask<'a>>,
    /// Root motion to extract from all clips. The clips then play in place; [`Scene::root_motion`] returns the motion.
    ///
    /// [`Scene::root_motion`]: crate::scene::Scene::root_motion
    pub root_motion: Option<RootOptions<'a>>,
}

/// The bones that an animation layer moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerMask<'a> {
    /// All bones.
    All,
    /// A bone and all bones below it. The bone is given by its name, or by its index in digits.
    Below(&'a str),
}

/// Root motion to extract from clips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RootOptions<'a> {
    /// The bone that carries the motion, given by its name, or by its index in digits.
    pub bone: &'a str,
    /// The components of the motion to extract.
    pub taken: Taken,
}

/// The index of a model's bone. `name_or_index` is the bone's name, or its index in digits. Names take precedence over
/// indices.
///
/// # Errors
/// [`InputError`] that lists up to 20 bones.
pub(super) fn bone_of(model: &Model, name_or_index: &str) -> Result<usize, InputError> {
    let bones = model.skeleton.bones();
    let by_name = bones.iter().position(|bone| bone.name == name_or_index);
    let by_index = || name_or_index.parse().ok().filter(|index| *index < bones.len());
    by_name.or_else(by_index).ok_or_else(|| {
        let names = bones.iter().map(|bone| bone.name.as_str());
        InputError::new("bone", name_or_index, error::name_or_index("bones", names))
    })
}

impl RootOptions<'_> {
    /// Extracts the root motion from all clips of a model. The model keeps clips that play in place. Returns one motion
    /// per clip.
    ///
    /// # Errors
    /// As for [`RootMotion::extract`]; [`InputError`] for a bone that the model does not have.
    pub(super) fn take(&self, model: &mut Model) -> Result<Vec<RootMotion>, InputError> {
        let bone = bone_of(model, self.bone)?;
        let extracted =
            model.clips.iter().map(|clip| RootMotion::extract(&model.skeleton, clip, bone, self.taken));
        let (clips, motions) = extracted.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        model.clips = clips;
        Ok(motions)
    }
}

/// Appearance of terrain in the layer [`Layer::Color`](crate::render::Layer::Color). The style has no effect on other
/// layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TerrainStyle {
    /// The textures of the terrain's zones, blended by height.
    #[default]
    Textured,
    /// Lit edges of the drawn triangles on dark, unlit ground.
    Wireframe,
}
