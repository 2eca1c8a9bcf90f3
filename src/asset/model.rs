//! A model: one skeleton, the skins that share it, its clips and its meshes. It may be a character or any other object, moving
//! or not.

mod stored;

use serde::{Deserialize, Serialize};

use super::clip::Clip;
use super::skeleton::{Skeleton, Skin};
use crate::asset::material::Alpha;
use crate::asset::{Material, Mesh};
use crate::{InputError, error};

/// A skeleton with its skins, clips and meshes.
///
/// serde stores a model completely, in any format, including images and the levels of detail of its meshes. Formats that keep
/// the bits of floats give back an equal model. Deserialization checks the model as a whole. The stored form belongs to one
/// version of this crate. A program that keeps stored models must store its own version beside them, and import the model again
/// if that version differs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "stored::StoredModel")]
pub struct Model {
    /// The bones.
    pub skeleton: Skeleton,
    /// Skins that meshes follow.
    pub skins: Vec<Skin>,
    /// Clips that move the bones.
    pub clips: Vec<Clip>,
    /// Meshes to draw.
    pub meshes: Vec<Mesh>,
    /// Number of leading meshes that have a skin from the file. Each of the other meshes follows one bone as a whole: its node
    /// or an ancestor of its node.
    pub skinned: usize,
    /// The materials of the meshes.
    pub materials: Vec<Material>,
    /// Images of textures, the top row first: sRGB with linear alpha. Images of normal maps are linear.
    #[serde(with = "stored::images")]
    pub images: Vec<image::RgbaImage>,
}

impl Model {
    /// Switches materials from screen-door transparency to blending: [`Alpha::Dithered`] becomes [`Alpha::Blended`]. The import
    /// gives glTF's `BLEND` materials [`Alpha::Dithered`].
    pub fn blend(&mut self) {
        for material in self.materials.iter_mut().filter(|material| material.alpha == Alpha::Dithered) {
            material.alpha = Alpha::Blended;
        }
    }

    /// Material of a mesh, if it has one.
    ///
    /// # Errors
    /// [`InputError`] for a material or an image that the model does not have, for an image without texels, and for a scale of
    /// the normal map that is not finite.
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

    /// Checks one skin.
    ///
    /// # Errors
    /// As [`Skin::validate`], with the index of the skin (`skins[0].bones[3]`).
    pub(crate) fn check_skin(&self, skin: usize) -> Result<(), InputError> {
        self.skins[skin].validate(&self.skeleton).map_err(|error| numbered("skin", "skins", skin, error))
    }

    /// Checks one mesh, and its skin.
    ///
    /// # Errors
    /// As [`Mesh::validate`], with the index of the mesh (`meshes[2].indices[1]`), and as [`Self::check_skin`].
    pub(crate) fn check_mesh(&self, mesh: usize) -> Result<(), InputError> {
        let checked = self.meshes[mesh].validate(&self.skins);
        checked.map_err(|error| numbered("mesh", "meshes", mesh, error))?;
        self.check_skin(self.meshes[mesh].skin)
    }

    /// Checks the material of one mesh.
    ///
    /// # Errors
    /// As [`Self::material`], with the index of the mesh (`meshes[2].material`) or of the material.
    pub(crate) fn check_material(&self, mesh: usize) -> Result<(), InputError> {
        let found = self.material(&self.meshes[mesh]);
        found.map(|_| ()).map_err(|error| numbered("mesh", "meshes", mesh, error))
    }

    /// Finds a clip by name or by index, counted from 0. A name that is a number takes precedence.
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

/// Adds an index to an error whose path begins with `item`, an element of `list`. Other errors stay as they are.
fn numbered(item: &str, list: &str, number: usize, error: InputError) -> InputError {
    let field = error.path.strip_prefix(item).filter(|field| field.starts_with('.'));
    match field {
        Some(field) => InputError { path: format!("{list}[{number}]{field}"), ..error },
        None => error,
    }
}
