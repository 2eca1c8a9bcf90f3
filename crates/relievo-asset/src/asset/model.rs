//! A model: one skeleton, the skins that share it, its clips and its meshes. A model may be a character or any other object,
//! moving or static.

mod stored;

use serde::{Deserialize, Serialize};

use super::clip::Clip;
use super::skeleton::{Skeleton, Skin};
use crate::asset::material::{Alpha, Pbr};
use crate::asset::{Image, Material, Mesh, MotionBounds};
use crate::{InputError, error};

/// A skeleton with its skins, clips and meshes.
///
/// serde stores a model completely, in any format, including images and the levels of detail of its meshes. A format that keeps
/// the bits of floats gives back an equal model. Deserialization checks the whole model. The stored form belongs to one version
/// of this crate. A program that keeps stored models must also store the crate's version, and import the model again if that
/// version differs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "stored::StoredModel")]
pub struct Model {
    /// The bones of the model.
    pub skeleton: Skeleton,
    /// Skins: the bones that meshes follow, with their inverse bind matrices.
    pub skins: Vec<Skin>,
    /// Animations that move the bones.
    pub clips: Vec<Clip>,
    /// Bounds of the model's motion in its clips, if they were computed in advance.
    pub motion: Option<MotionBounds>,
    /// The meshes of the model.
    pub meshes: Vec<Mesh>,
    /// Number of meshes with a skin from the file; these come first in `meshes`. Each of the other meshes follows one bone as a
    /// whole: the bone of the mesh's node or of an ancestor of this node.
    pub skinned: usize,
    /// Materials; meshes refer to them by index.
    pub materials: Vec<Material>,
    /// Images of textures, the top row first. Base colours are sRGB with linear alpha; normal maps are linear.
    #[serde(with = "stored::images")]
    pub images: Vec<Image>,
}

impl Model {
    /// Switches materials from screen-door transparency to blending: [`Alpha::Dithered`] becomes [`Alpha::Blended`]. The import
    /// gives glTF's `BLEND` materials [`Alpha::Dithered`].
    pub fn blend(&mut self) {
        for material in self.materials.iter_mut().filter(|material| material.alpha == Alpha::Dithered) {
            material.alpha = Alpha::Blended;
        }
    }

    /// Returns the material of a mesh, if the mesh has one.
    ///
    /// # Errors
    /// [`InputError`] for a material or an image that the model does not have, for an image without texels, for a normal map's
    /// scale that is not finite, and for physically based factors outside 0..=1.
    pub fn material(&self, mesh: &Mesh) -> Result<Option<&Material>, InputError> {
        let Some(index) = mesh.material else { return Ok(None) };
        InputError::check_below("mesh.material", index, self.materials.len())?;
        let material = &self.materials[index];
        for (field, texture) in material.textures() {
            let path = format!("materials[{index}].{field}.image");
            InputError::check_below(&path, texture.image, self.images.len())?;
            if self.images[texture.image].size().contains(&0) {
                return Err(InputError::new(path, texture.image, "must have texels"));
            }
        }
        InputError::check_finite(format!("materials[{index}].normal_scale"), material.normal_scale)?;
        let Pbr { metallic, roughness, occlusion_strength, emissive: [red, green, blue], .. } = material.pbr;
        let factors = [metallic, roughness, occlusion_strength, red, green, blue];
        let path = format!("materials[{index}].pbr");
        InputError::check_each(&path, &factors, |value| (0.0..=1.0).contains(value), "must be in 0..=1")?;
        Ok(Some(material))
    }

    /// Checks that skins, clips, meshes and materials match each other and the skeleton.
    ///
    /// # Errors
    /// [`InputError`] with the path of the part that does not match.
    #[doc(hidden)]
    pub fn check(&self) -> Result<(), InputError> {
        (0..self.skins.len()).try_for_each(|skin| self.check_skin(skin))?;
        for (at, clip) in self.clips.iter().enumerate() {
            let path = format!("clips[{at}].bones");
            InputError::check_len(&path, clip.bones(), self.skeleton.len(), "a bone")?;
        }
        for (at, mesh) in self.meshes.iter().enumerate() {
            self.check_mesh(at)?;
            self.check_material(at)?;
            for (clip, _) in &mesh.weight_keys {
                let path = format!("meshes[{at}].weight_keys.clip");
                InputError::check_below(path, *clip, self.clips.len())?;
            }
        }
        let bound = || format!("must be at most {}, the number of meshes", self.meshes.len());
        InputError::check(self.skinned <= self.meshes.len(), "skinned", self.skinned, bound)
    }

    /// Checks one skin.
    ///
    /// # Errors
    /// The errors of [`Skin::validate`], with the index of the skin in their paths (`skins[0].bones[3]`).
    #[doc(hidden)]
    pub fn check_skin(&self, skin: usize) -> Result<(), InputError> {
        self.skins[skin].validate(&self.skeleton).map_err(|error| numbered("skin", "skins", skin, error))
    }

    /// Checks one mesh and its skin.
    ///
    /// # Errors
    /// The errors of [`Mesh::validate`], with the index of the mesh in their paths (`meshes[2].indices[1]`), and the errors of
    /// [`Self::check_skin`].
    #[doc(hidden)]
    pub fn check_mesh(&self, mesh: usize) -> Result<(), InputError> {
        let checked = self.meshes[mesh].validate(&self.skins);
        checked.map_err(|error| numbered("mesh", "meshes", mesh, error))?;
        self.check_skin(self.meshes[mesh].skin)
    }

    /// Checks the material of one mesh.
    ///
    /// # Errors
    /// The errors of [`Self::material`], with the index of the mesh (`meshes[2].material`) or of the material in their paths.
    #[doc(hidden)]
    pub fn check_material(&self, mesh: usize) -> Result<(), InputError> {
        let found = self.material(&self.meshes[mesh]);
        found.map(|_| ()).map_err(|error| numbered("mesh", "meshes", mesh, error))
    }

    /// Finds a clip by its name, or by its index counted from 0. If a clip's name is itself a number, the name takes
    /// precedence.
    ///
    /// # Errors
    /// [`InputError`] if there is no such clip. The error lists up to 20 clips.
    pub fn clip(&self, name_or_index: &str) -> Result<&Clip, InputError> {
        let by_name = self.clips.iter().find(|clip| clip.name() == name_or_index);
        let by_index = || name_or_index.parse().ok().and_then(|index: usize| self.clips.get(index));
        by_name.or_else(by_index).ok_or_else(|| {
            let bound = error::name_or_index("clips", self.clips.iter().map(Clip::name));
            InputError::new("clip", name_or_index, bound)
        })
    }

    /// Finds a bone by its name, or by its index in digits, and returns its index. If a bone's name is itself a number, the name
    /// takes precedence.
    ///
    /// # Errors
    /// [`InputError`] if there is no such bone. The error lists up to 20 bones.
    pub fn bone(&self, name_or_index: &str) -> Result<usize, InputError> {
        let bones = self.skeleton.bones();
        let by_name = bones.iter().position(|bone| bone.name == name_or_index);
        let by_index = || name_or_index.parse().ok().filter(|index| *index < bones.len());
        by_name.or_else(by_index).ok_or_else(|| {
            let bound = error::name_or_index("bones", bones.iter().map(|bone| bone.name.as_str()));
            InputError::new("bone", name_or_index, bound)
        })
    }
}

/// Replaces the leading `item` of an error's path by `list[number]`. Errors with other paths stay unchanged.
fn numbered(item: &str, list: &str, number: usize, error: InputError) -> InputError {
    let field = error.path.strip_prefix(item).filter(|field| field.starts_with('.'));
    match field {
        Some(field) => InputError { path: format!("{list}[{number}]{field}"), ..error },
        None => error,
    }
}
