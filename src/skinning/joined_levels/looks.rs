//! Materials and images of joined models. Equal ones are kept once.

use super::index_of;
use crate::asset::material::Texture;
use crate::asset::{Material, Model};

/// Adds materials and images to a joined model.
pub(super) struct Looks<'a>(&'a mut Model);

impl<'a> Looks<'a> {
    pub fn new(joined: &'a mut Model) -> Self {
        Self(joined)
    }

    /// Adds all materials of a model, and the images that they show. Returns the new index of each material.
    pub fn add(&mut self, model: &Model) -> Vec<usize> {
        let mut known: Vec<Option<usize>> = vec![None; model.images.len()];
        let Model { materials, images, .. } = &mut *self.0;
        let add = |own: &Material| {
            let mut own = own.clone();
            own.map_textures(|texture| {
                // No mesh shows a material with a missing image, because the model was checked.
                let image = model.images.get(texture.image)?;
                let add = || index_of(images, image.clone(), PartialEq::eq);
                Some(Texture { image: *known[texture.image].get_or_insert_with(add), ..texture })
            });
            index_of(materials, own, PartialEq::eq)
        };
        model.materials.iter().map(add).collect()
    }
}
