//! A model: one skeleton, the skins that share it, its clips and its meshes. It may be a character, or anything
//! else, moving or not.

mod stored;

use serde::{Deserialize, Serialize};

use super::clip::Clip;
use super::skeleton::{Skeleton, Skin};
use crate::asset::material::Alpha;
use crate::asset::{Material, Mesh};
use crate::{InputError, error};

/// A skeleton with its skins, clips and meshes.
///
/// A model is stored with serde, in any format, with all that it has: the levels of detail of its meshes and its images
/// too. Formats that keep the bits of floats give back an equal model. What is read is checked as a whole. The stored form
/// belongs to one version of this crate: a program that keeps it stores its own version beside it, and imports the model
/// again if that differs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "stored::StoredModel")]
pub struct Model {
    /// The bones.
    pub skeleton: Skeleton,
    /// The skins, which meshes follow.
    pub skins: Vec<Skin>,
    /// The clips, which move the bones.
    pub clips: Vec<Clip>,
    /// The meshes, which are drawn.
    pub meshes: Vec<Mesh>,
    /// How many of the meshes, from the first on, have a skin from the file. Each of the others follows one
    /// bone as a whole: its node or an ancestor of that.
    pub skinned: usize,
    /// The materials of the meshes.
    pub materials: Vec<Material>,
    /// The images of textures, the top row first: sRGB with linear alpha, and those of normal maps linear.
    #[serde(with = "stored::images")]
    pub images: Vec<image::RgbaImage>,
}

impl Model {
    /// Lets the materials whose transparency is a pattern of opaque pixels ([`Alpha::Dithered`], as the import makes of
    /// glTF's `BLEND`) be blended with what is behind them ([`Alpha::Blended`]).
    pub fn blend(&mut self) {
        for material in self.materials.iter_mut().filter(|material| material.alpha == Alpha::Dithered) {
            material.alpha = Alpha::Blended;
        }
    }

    /// The material of a mesh, if it has one.
    ///
    /// # Errors
    /// [`InputError`] for a material or an image that the model does not have, for an image without texels, and for a
    /// scale of the normal map that is not finite.
    pub fn material(&self, mesh: &Mesh) -> Result<Option<&Material>, InputError> {
        let Some(index) = mesh.material else { return Ok(None) };
        InputError::check_below("mesh.material", index, self.materials.len())?;
        let material = &self.materials[index];
        for (field, texture) in [("texture", material.texture), ("normal", material.normal)] {
            let Some(texture) = texture else { continue };
            let path = format!("materials[{index}].{field}.image");
            InputError::check_below(&path, texture.image, self.images.len())?;
            if self.images[texture.image].is_empty() {
                return Err(InputError::new(path, texture.image, "must have texels"));
            }
        }
        InputError::check_finite(format!("materials[{index}].normal_scale"), material.normal_scale)?;
        Ok(Some(material))
    }

    /// Checks one of the skins.
    ///
    /// # Errors
    /// As [`Skin::validate`], with the number of the skin (`skins[0].bones[3]`).
    pub(crate) fn check_skin(&self, skin: usize) -> Result<(), InputError> {
        self.skins[skin].validate(&self.skeleton).map_err(|error| numbered("skin", "skins", skin, error))
    }

    /// Checks one of the meshes, with its skin.
    ///
    /// # Errors
    /// As [`Mesh::validate`], with the number of the mesh (`meshes[2].indices[1]`), and as [`Self::check_skin`].
    pub(crate) fn check_mesh(&self, mesh: usize) -> Result<(), InputError> {
        let checked = self.meshes[mesh].validate(&self.skins);
        checked.map_err(|error| numbered("mesh", "meshes", mesh, error))?;
        self.check_skin(self.meshes[mesh].skin)
    }

    /// Checks the material of one of the meshes.
    ///
    /// # Errors
    /// As [`Self::material`], with the number of the mesh (`meshes[2].material`) or of the material.
    pub(crate) fn check_material(&self, mesh: usize) -> Result<(), InputError> {
        let found = self.material(&self.meshes[mesh]);
        found.map(|_| ()).map_err(|error| numbered("mesh", "meshes", mesh, error))
    }

    /// The clip with this name or this index, counted from 0. A name that is a number takes precedence.
    ///
    /// # Errors
    /// [`InputError`] that lists up to 20 clips.
    pub fn clip(&self, name_or_index: &str) -> Result<&Clip, InputError> {
        let by_name = self.clips.iter().find(|clip| clip.name() == name_or_index);
        let by_index = || name_or_index.parse().ok().and_then(|index: usize| self.clips.get(index));
        by_name.or_else(by_index).ok_or_else(|| {
            let bound = error::name_or_index("clips", self.clips.iter().map(Clip::name));
            InputError::new("clip", name_or_index, bound)
        })
    }
}

/// An error that names a field of `item`, which is one of `list`, with its number there. Others stay as they are.
fn numbered(item: &str, list: &str, number: usize, error: InputError) -> InputError {
    let field = error.path.strip_prefix(item).filter(|field| field.starts_with('.'));
    match field {
        Some(field) => InputError { path: format!("{list}[{number}]{field}"), ..error },
        None => error,
    }
}
