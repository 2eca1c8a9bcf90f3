//! A character, or anything else that moves in parts or not at all: one skeleton, the skins that share it, its clips and
//! its meshes.

use super::clip::Clip;
use super::skeleton::{Skeleton, Skin};
use crate::InputError;
use crate::asset::{Material, Mesh};

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
    /// How many of these, from the first on, have a skin of the file; each of the others follows one bone as a whole, the
    /// node that it hangs on.
    pub skinned: usize,
    /// What its meshes look like.
    pub materials: Vec<Material>,
    /// What textures show: sRGB, alpha as it is, the first row on top.
    pub images: Vec<image::RgbaImage>,
}

impl Model {
    /// What a mesh looks like, where it has a material.
    ///
    /// # Errors
    /// [`InputError`] for a material or an image that the model lacks, and an image without texels.
    pub fn material(&self, mesh: &Mesh) -> Result<Option<&Material>, InputError> {
        let Some(index) = mesh.material else { return Ok(None) };
        let Some(material) = self.materials.get(index) else {
            let bound = format!("must be below {}", self.materials.len());
            return Err(InputError::new("mesh.material", index, bound));
        };
        if let Some(texture) = material.texture {
            let path = format!("materials[{index}].texture.image");
            match self.images.get(texture.image) {
                None => {
                    let bound = format!("must be below {}", self.images.len());
                    return Err(InputError::new(path, texture.image, bound));
                }
                Some(image) if image.is_empty() => {
                    return Err(InputError::new(path, texture.image, "must have texels"));
                }
                Some(_) => {}
            }
        }
        Ok(Some(material))
    }

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
