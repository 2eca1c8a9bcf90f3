//! Options of characters and of terrain.

use crate::animation::RootMotion;
use crate::animation::root_motion::Taken;
use crate::asset::Model;
use crate::{InputError, error};

/// Layers and root motion of a character, for [`Scene::add_character_with`](crate::scene::Scene::add_character_with).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CharacterOptions<'a> {
    /// The layers above the base, at most 7. Their weights start at 0. Each costs 16 bytes per instance, and as much
    /// sampling as the base while it has a weight.
    pub layers: Vec<LayerMask<'a>>,
    /// Root motion to extract from all clips, which then play in place; see
    /// [`Scene::root_motion`](crate::scene::Scene::root_motion).
    pub root_motion: Option<RootOptions<'a>>,
}

/// The bones that a layer animates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerMask<'a> {
    /// All bones.
    All,
    /// A bone, given by its name or its index in digits, and all bones below it.
    Below(&'a str),
}

/// Root motion to extract from clips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RootOptions<'a> {
    /// The bone that carries the motion, given by its name or its index in digits.
    pub bone: &'a str,
    /// The parts of the motion to extract.
    pub taken: Taken,
}

/// The index of a model's bone, by its name or its index. A name that is a number takes precedence.
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
    /// Extracts the root motion from all clips of a model.
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

/// Appearance of terrain in colour. It has no effect on other layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TerrainStyle {
    /// Textures of the zones, blended by height.
    #[default]
    Textured,
    /// Lit edges of the drawn triangles, on dark, unlit ground.
    Wireframe,
}
