//! Base colours of skinned meshes on the device: a factor, a texture, and the use of alpha.

use std::collections::HashMap;

use crate::Error;
use crate::asset::Model;
use crate::asset::material::{Alpha, Material, Texture};
use crate::gpu::{Gpu, GpuError};
use crate::surface::color::ColorTexture;
use crate::surface::mips::Mips;

/// The base colour of a surface.
#[derive(Debug, Clone)]
pub struct Albedo {
    /// The texture of colour and alpha.
    pub texture: ColorTexture,
    /// The factor of the texture: linear red, green, blue, and alpha.
    pub factor: [f32; 4],
    /// How alpha is used.
    pub alpha: Alpha,
}

impl From<ColorTexture> for Albedo {
    /// An opaque surface with this texture, unchanged.
    fn from(texture: ColorTexture) -> Self {
        Self { texture, factor: [1.0; 4], alpha: Alpha::Opaque }
    }
}

/// A function that uploads textures: [`ColorTexture::new`] or [`ColorTexture::linear`].
pub(crate) type Upload = fn(&Gpu, &Mips, bool) -> Result<ColorTexture, GpuError>;

impl Albedo {
    /// The base colours of a model's meshes, one per mesh, with each texture uploaded once. Meshes without a
    /// material get `other`.
    ///
    /// # Errors
    /// [`crate::InputError`] for materials and images that the model does not have; [`GpuError`].
    pub fn of_meshes(gpu: &Gpu, model: &Model, other: &Self, upload: Upload) -> Result<Vec<Self>, Error> {
        let mut textures = Textures { gpu, model, upload, known: HashMap::new() };
        let mut all = Vec::with_capacity(model.meshes.len());
        for mesh in &model.meshes {
            all.push(match model.material(mesh)? {
                Some(material) => textures.albedo(material)?,
                None => other.clone(),
            });
        }
        Ok(all)
    }
}

/// Textures that have been uploaded, by image and by whether they have mip levels; the white texture has no
/// image.
struct Textures<'a> {
    gpu: &'a Gpu,
    model: &'a Model,
    upload: Upload,
    known: HashMap<Option<(usize, bool)>, ColorTexture>,
}

impl Textures<'_> {
    fn albedo(&mut self, material: &Material) -> Result<Albedo, GpuError> {
        let key = material.texture.map(|Texture { image, sampling }| (image, sampling.mips.is_some()));
        let known = match self.known.get(&key) {
            Some(known) => known.clone(),
            None => {
                let uploaded = (self.upload)(self.gpu, &self.mips(key), true)?;
                self.known.entry(key).or_insert(uploaded).clone()
            }
        };
        let texture = match material.texture {
            Some(Texture { sampling, .. }) => known.with_sampling(self.gpu, &sampling)?,
            None => known,
        };
        Ok(Albedo { texture, factor: material.color, alpha: material.alpha })
    }

    fn mips(&self, key: Option<(usize, bool)>) -> Mips {
        match key {
            None => Mips::of_color(image::RgbaImage::from_pixel(1, 1, image::Rgba([255; 4]))),
            Some((image, true)) => Mips::of_color(self.model.images[image].clone()),
            Some((image, false)) => Mips { levels: vec![self.model.images[image].clone()], is_srgb: true },
        }
    }
}
