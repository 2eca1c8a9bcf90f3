//! The materials and images of an object, on the host: what may be changed, and to what.

use image::RgbaImage;

use crate::InputError;
use crate::asset::Model;
use crate::asset::material::{Alpha, Material};

/// The materials of an object with their images.
#[derive(Debug)]
pub(crate) struct Looks {
    pub materials: Vec<Material>,
    pub images: Vec<RgbaImage>,
}

impl Looks {
    /// Takes those of a model.
    pub fn taken(model: &mut Model) -> Self {
        Self { materials: std::mem::take(&mut model.materials), images: std::mem::take(&mut model.images) }
    }

    /// The index of the material with this name or this index. A name that is a number takes precedence.
    ///
    /// # Errors
    /// [`InputError`] that lists the materials.
    pub fn find(&self, name_or_index: &str) -> Result<usize, InputError> {
        let by_name = self.materials.iter().position(|material| material.name == name_or_index);
        let count = self.materials.len();
        let by_index = || name_or_index.parse().ok().filter(|index: &usize| *index < count);
        by_name.or_else(by_index).ok_or_else(|| {
            let names = self.materials.iter().map(|material| format!("{:?}", material.name));
            let bound = match count {
                0 => "the model has no materials".to_owned(),
                _ => format!("must be below {count} or one of {}", names.collect::<Vec<_>>().join(", ")),
            };
            InputError::new("material", name_or_index, bound)
        })
    }

    /// Checks a material that is to be drawn with these images.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn check(&self, material: &Material) -> Result<(), InputError> {
        for (at, channel) in material.color.into_iter().enumerate() {
            if !(0.0..=1.0).contains(&channel) {
                return Err(InputError::new(format!("material.color[{at}]"), channel, "must be in 0..=1"));
            }
        }
        if !material.normal_scale.is_finite() {
            return Err(InputError::new("material.normal_scale", material.normal_scale, "must be finite"));
        }
        if let Alpha::Mask(cutoff) = material.alpha
            && !cutoff.is_finite()
        {
            return Err(InputError::new("material.alpha", cutoff, "must be finite"));
        }
        for (field, texture) in [("texture", material.texture), ("normal", material.normal)] {
            if let Some(texture) = texture
                && texture.image >= self.images.len()
            {
                let bound = format!("must be below {}, the number of images", self.images.len());
                return Err(InputError::new(format!("material.{field}.image"), texture.image, bound));
            }
        }
        Ok(())
    }

    /// Replaces an image, or adds one behind the last.
    ///
    /// # Errors
    /// [`InputError`] for an image without texels, and for an index beyond that.
    pub fn set_image(&mut self, index: usize, image: RgbaImage) -> Result<(), InputError> {
        if image.is_empty() {
            let value = format!("{} × {}", image.width(), image.height());
            return Err(InputError::new("image", value, "must have texels"));
        }
        if index > self.images.len() {
            let bound = format!("must be at most {}, which adds an image", self.images.len());
            return Err(InputError::new("index", index, bound));
        }
        if index == self.images.len() {
            self.images.push(image);
        } else {
            self.images[index] = image;
        }
        Ok(())
    }
}
