//! Validation of models that serde has read.

use serde::Deserialize;

use super::Model;
use crate::InputError;
use crate::asset::{Clip, Image, Material, Mesh, MotionBounds, Skeleton, Skin};

/// A model as serde reads it, before validation; its components may not match each other.
#[derive(Deserialize)]
#[serde(rename = "Model")]
pub(super) struct StoredModel {
    skeleton: Skeleton,
    skins: Vec<Skin>,
    clips: Vec<Clip>,
    motion: Option<MotionBounds>,
    meshes: Vec<Mesh>,
    skinned: usize,
    materials: Vec<Material>,
    #[serde(with = "images")]
    images: Vec<Image>,
}

impl TryFrom<StoredModel> for Model {
    type Error = InputError;

    fn try_from(stored: StoredModel) -> Result<Self, InputError> {
        let StoredModel { skeleton, skins, clips, motion, meshes, skinned, materials, images } = stored;
        let model = Self { skeleton, skins, clips, motion, meshes, skinned, materials, images };
        model.check()?;
        Ok(model)
    }
}

/// Serializes images as width, height and texels.
pub(super) mod images {
    use image::RgbaImage;
    use serde::de::Error as _;
    use serde::ser::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::asset::Image;

    #[derive(Serialize, Deserialize)]
    #[serde(rename = "Image")]
    struct Stored {
        width: u32,
        height: u32,
        texels: Vec<u8>,
    }

    pub fn serialize<S: Serializer>(images: &[Image], serializer: S) -> Result<S::Ok, S::Error> {
        let stored = |image: &Image| {
            let [width, height] = image.size();
            let texels = image.texels().map_err(S::Error::custom)?.clone().into_raw();
            Ok(Stored { width, height, texels })
        };
        images.iter().map(stored).collect::<Result<Vec<_>, S::Error>>()?.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Image>, D::Error> {
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
            RgbaImage::from_raw(width, height, texels).map(Image::from).ok_or_else(|| {
                D::Error::custom(format!("images[{at}]: {width} × {height} texels are too many"))
            })
        };
        Vec::<Stored>::deserialize(deserializer)?.into_iter().enumerate().map(image).collect()
    }
}
