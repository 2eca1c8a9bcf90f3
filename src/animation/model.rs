//! A character: one skeleton, the skins that share it, its clips and its meshes.

use super::clip::Clip;
use super::skeleton::{Skeleton, Skin};
use crate::InputError;
use crate::skinning::Mesh;

/// A skeleton with its skins, clips and meshes.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The bones.
    pub skeleton: Skeleton,
    /// What follows them.
    pub skins: Vec<Skin>,
    /// What moves them.
    pub clips: Vec<Clip>,
    /// What is seen of it.
    pub meshes: Vec<Mesh>,
}

impl Model {
    /// The clip of this name, or of this number, counted from 0. A name that is a number wins.
    ///
    /// # Errors
    /// [`InputError`] that lists the clips.
    pub fn clip(&self, name_or_index: &str) -> Result<&Clip, InputError> {
        let by_name = self.clips.iter().find(|clip| clip.name() == name_or_index);
        let by_index = || name_or_index.parse().ok().and_then(|index: usize| self.clips.get(index));
        by_name.or_else(by_index).ok_or_else(|| {
            let names = self.clips.iter().map(|clip| format!("{:?}", clip.name())).collect::<Vec<_>>();
            let bound = match names.len() {
                0 => "the model has no clips".to_owned(),
                count => format!("must be below {count} or one of {}", names.join(", ")),
            };
            InputError::new("clip", name_or_index, bound)
        })
    }
}
