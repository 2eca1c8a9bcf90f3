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

    fn try_from(stored: StoredModel) -> Result<Self, InputError> {
        let StoredModel { skeleton, skins, clips, meshes, skinned, materials, images } = stored;
        let model = Self { skeleton, skins, clips, meshes, skinned, materials, images };
        model.check()?;
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
