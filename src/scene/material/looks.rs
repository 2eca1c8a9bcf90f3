//! Host copies of an object's materials and images, and checks of changes to them.

use image::RgbaImage;

use super::textures::check_image;
use crate::asset::material::{Alpha, Material};
use crate::asset::{Image, Model};
use crate::gpu::Gpu;
use crate::{InputError, error};

/// Materials of an object, with their images.
#[derive(Debug)]
pub(crate) struct Looks {
    pub materials: Vec<Material>,
    pub images: Vec<Image>,
}

impl Looks {
    /// No materials and no images.
    pub const NONE: Self = Self { materials: Vec::new(), images: Vec::new() };

    /// Moves all materials and images out of a model.
    pub fn taken(model: &mut Model) -> Self {
        Self { materials: std::mem::take(&mut model.materials), images: std::mem::take(&mut model.images) }
    }

    /// The index of a material. `name_or_index` is the material's name, or its index in digits. Names take precedence
    /// over indices.
    ///
    /// # Errors
    /// [`InputError`] that lists up to 20 materials.
    pub fn find(&self, name_or_index: &str) -> Result<usize, InputError> {
        let by_name = self.materials.iter().position(|material| material.name == name_or_index);
        let count = self.materials.len();
        let by_index = || name_or_index.parse().ok().filter(|index: &usize| *index < count);
        by_name.or_else(by_index).ok_or_else(|| {
            let names = self.materials.iter().map(|material| material.name.as_str());
            InputError::new("material", name_or_index, error::name_or_index("materials", names))
        })
    }

    /// Checks all materials. The path of an error begins with `model.materials`.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn check_all(&self) -> Result<(), InputError> {
        let mut all = self.materials.iter().enumerate();
        all.try_for_each(|(at, material)| self.check(&format!("model.materials[{at}]"), material))
    }

    /// Checks a material's values, and that the images it refers to exist. The path of an error begins with `path`.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn check(&self, path: &str, material: &Material) -> Result<(), InputError> {
        for (at, channel) in material.color.into_iter().enumerate() {
            if !(0.0..=1.0).contains(&channel) {
                return Err(InputError::new(format!("{path}.color[{at}]"), channel, "must be in 0..=1"));
            }
        }
        if !material.normal_scale.is_finite() {
            let field = format!("{path}.normal_scale");
            return Err(InputError::new(field, material.normal_scale, "must be finite"));
        }
        if let Alpha::Mask(cutoff) = material.alpha
            && !cutoff.is_finite()
        {
            return Err(InputError::new(format!("{path}.alpha"), cutoff, "must be finite"));
        }
        for (field, texture) in material.textures() {
            if texture.image >= self.images.len() {
                let bound = format!("must be below {}, the number of images", self.images.len());
                return Err(InputError::new(format!("{path}.{field}.image"), texture.image, bound));
            }
        }
        Ok(())
    }

    /// Replaces the image at `index` and returns the previous one. An index equal to the number of images appends the
    /// image; the result is then `None`.
    ///
    /// # Errors
    /// [`InputError`] for an image without texels, for one that is too large for a texture of the device, and for an
    /// index above the number of images.
    pub fn set_image(
        &mut self,
        gpu: &Gpu,
        index: usize,
        image: RgbaImage,
    ) -> Result<Option<Image>, InputError> {
        check_image(gpu, "image", &image)?;
        let bound = || format!("must be at most {}, which adds an image", self.images.len());
        InputError::check(index <= self.images.len(), "index", index, bound)?;
        match self.images.get_mut(index) {
            Some(old) => Ok(Some(std::mem::replace(old, image.into()))),
            None => {
                self.images.push(image.into());
                Ok(None)
            }
        }
    }
}
