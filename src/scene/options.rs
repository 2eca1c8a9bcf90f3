//! What a character can do beyond playing one clip, and how terrain looks.

use crate::animation::RootMotion;
use crate::animation::root_motion::Taken;
use crate::asset::Model;
use crate::{InputError, error};

/// What a character can do beyond playing one clip, for
/// [`Scene::add_character_with`](crate::scene::Scene::add_character_with).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CharacterOptions<'a> {
    /// The layers above the base, at most 7; none of them is heard at first. Each costs 16 bytes an instance, and as much as the
    /// base where it is heard.
    pub layers: Vec<LayerMask<'a>>,
    /// The motion that is taken out of all clips, which then play in place; see
    /// [`Scene::root_motion`](crate::scene::Scene::root_motion).
    pub root_motion: Option<RootOptions<'a>>,
}

/// The bones on which a layer plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerMask<'a> {
    /// All bones.
    All,
    /// A bone, by its name or its index in digits, and all bones below it.
    Below(&'a str),
}

/// The motion that is taken out of clips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RootOptions<'a> {
    /// The bone whose motion it is, by its name or its index in digits.
    pub bone: &'a str,
    /// Which parts of its motion.
    pub taken: Taken,
}

/// The index of a bone of a model, by its name or its index. A name that is a number takes precedence.
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

/// How terrain looks in colour. In other layers it makes no difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TerrainStyle {
    /// Textures of the zones, blended by height.
    #[default]
    Textured,
    /// The edges of the triangles that are drawn, lit, on dark ground that no light reaches.
    Wireframe,
}
