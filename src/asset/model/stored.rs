//! Validation of models that serde has read.

use image::RgbaImage;
use serde::Deserialize;

use super::Model;
use crate::InputError;
use crate::asset::{Clip, Material, Mesh, Skeleton, Skin};

/// A model as serde reads it, before validation; its components may not match each other.
#[derive(Deserialize)]
#[serde(rename = "Model")]
pub(super) struct StoredModel {
    skeleton: Skeleton,
    skins: Vec<Skin>,
    clips: Vec<Clip>,
    meshes: Vec<Mesh>,
    skinned: usize,
    materials: Vec<Material>,
    #[serde(with = "images")]
    images: Vec<RgbaImage>,
}

impl TryFrom<StoredModel> for Model {
    type Error = InputError;

    /// Refuses skins, clips and meshes that do not match each other or the skeleton, and missing materials.
    fn try_from(stored: StoredModel) -> Result<Self, InputError> {
        let StoredModel { skeleton, skins, clips, meshes, skinned, materials, images } = stored;
        let model = Self { skeleton, skins, clips, meshes, skinned, materials, images };
        (0..model.skins.len()).try_for_each(|skin| model.check_skin(skin))?;
        for (at, clip) in model.clips.iter().enumerate() {
            let path = format!("clips[{at}].bones");
            InputError::check_len(&path, clip.bones(), model.skeleton.len(), "a bone")?;
        }
        for (at, mesh) in model.meshes.iter().enumerate() {
            model.check_mesh(at)?;
            model.check_material(at)?;
            for (clip, _) in &mesh.weight_keys {
                let path = format!("meshes[{at}].weight_keys.clip");
                InputError::check_below(path, *clip, model.clips.len())?;
            }
        }
        let bound = || format!("must be at most {}, the number of meshes", model.meshes.len());
        InputError::check(model.skinned <= model.meshes.len(), "skinned", model.skinned, bound)?;
        Ok(model)
    }
}

/// Serializes images as width, height and texels.
pub(super) mod images {
    use image::RgbaImage;
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize)]
    #[serde(rename = "Image")]
    struct Borrowed<'a> {
        width: u32,
        height: u32,
        texels: &'a [u8],
    }

    #[derive(Deserialize)]
    #[serde(rename = "Image")]
    struct Stored {
        width: u32,
        height: u32,
        texels: Vec<u8>,
    }

    pub fn serialize<S: Serializer>(images: &[RgbaImage], serializer: S) -> Result<S::Ok, S::Error> {
        let all = images.iter().map(|image| {
            let (width, height) = image.dimensions();
            Borrowed { width, height, texels: image.as_raw() }
        });
        serializer.collect_seq(all)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RgbaImage>, D::Error> {
        let image = |(at, stored): (usize, Stored)| {
            let Stored { width, height, texels } = stored;
            let wanted = 4 * u64::from(width) * u64::from(height);
            // Without this check, texels beyond the last row would be kept.
            if texels.len() as u64 != wanted {
                let value = texels.len();
                return Err(D::Error::custom(format!(
                    "images[{at}].texels.len = {value}: must be {wanted}, four a texel of {width} × {height}"
                )));
            }
            RgbaImage::from_raw(width, height, texels).ok_or_else(|| {
                D::Error::custom(format!("images[{at}]: {width} × {height} texels are too many"))
            })
        };
        Vec::<Stored>::deserialize(deserializer)?.into_iter().enumerate().map(image).collect()
    }
}
