//! Changing the materials and images of objects.

use image::RgbaImage;

use crate::asset::material::{Alpha, Material};
use crate::gpu::{Gpu, Staged};
use crate::scene::Scene;
use crate::scene::handles::ObjectId;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{Changed, Looks, PartMaterials};
use crate::scene::mesh::{MeshDrawable, MeshMaterials};
use crate::scene::object::Object;
use crate::{Error, InputError};

impl Scene {
    /// Replaces a material of a mesh or a character. `material` is the material's name, or the digits of its index in
    /// the model. All instances show the new material from the next frame on. A material refers to images by their index
    /// in the model; [`Scene::set_image`] replaces images and adds others.
    ///
    /// A change of colour, cutoff or normal scale only writes into buffers. The same is true for a change to a texture
    /// that is already uploaded for this material or for a material drawn together with it. For any other texture or
    /// sampling, all textures of these materials are uploaded at once. This allocates memory, and render bundles must
    /// be recorded again.
    ///
    /// Some changes may need a pipeline that a renderer has not compiled:
    ///
    /// - the first material with [`Alpha::Mask`] or [`Alpha::Dithered`] among opaque materials;
    /// - the first material with a normal map;
    /// - the first texture, or the removal of the last texture, of a material that is drawn alone.
    ///
    /// After such a change, call [`Renderer::prepare`](crate::render::Renderer::prepare). Without this call,
    /// [`Renderer::draw`](crate::render::Renderer::draw) returns an error.
    ///
    /// A material cannot change between blended and not blended, because blended surfaces are drawn in a layer of their
    /// own.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, for terrain and reliefs, and for a material or an image
    /// that the model does not have. [`InputError`] also for values out of range, for a change from or to blending, and
    /// for a sampling that differs from the sampling of the materials drawn together with this one.
    /// [`crate::gpu::GpuError`]. After an error, the material is unchanged.
    ///
    /// # Examples
    ///
    /// Changes the colour of a coat and keeps its other properties.
    ///
    /// ```no_run
    /// # use relievo::asset::Material;
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(scene: &mut Scene, fox: ObjectId) -> Result<(), relievo::Error> {
    /// let coat = scene.material(fox, "coat")?.clone();
    /// scene.set_material(fox, "coat", &Material { color: [0.3, 0.2, 0.1, 1.0], ..coat })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_material(&mut self, object: ObjectId, material: &str, new: &Material) -> Result<(), Error> {
        let (gpu, layouts) = (self.gpu.clone(), self.layouts_of_groups.clone());
        let mut staged = std::mem::take(&mut self.staged);
        let entry = self.object_mut(object);
        let set = entry.map_err(Error::from).and_then(|entry| {
            let (index, looks) = {
                let looks = looks(entry)?;
                (looks.find(material)?, looks)
            };
            looks.check("material", new)?;
            let (is_blended, was_blended) =
                (new.alpha == Alpha::Blended, looks.materials[index].alpha == Alpha::Blended);
            if is_blended != was_blended {
                let bound = if was_blended { "must be blended, as before" } else { "must not be blended" };
                return Err(InputError::new("material.alpha", format!("{:?}", new.alpha), bound).into());
            }
            let old = std::mem::replace(&mut looks.materials[index], new.clone());
            let set = entry.change_materials(&gpu, &layouts, &mut staged, &Change::Material(index, &old));
            if let (Err(_), Some(looks)) = (&set, &mut entry.looks) {
                looks.materials[index] = old;
            }
            set
        });
        self.staged = staged;
        set
    }

    /// Replaces an image of a mesh or a character in all materials that show it, or adds an image. `index` is the
    /// image's index in the model; an index equal to the number of images adds one. Colours are sRGB with linear alpha,
    /// normal maps are linear.
    ///
    /// An image that a material shows is uploaded at once, with the other images of its texture array. This allocates
    /// memory, and render bundles must be recorded again.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, for terrain and reliefs, for an image without texels,
    /// for one that is too large for a texture of the device, and for an index above the number of images.
    /// [`crate::gpu::GpuError`]. After an error, the images are unchanged.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(scene: &mut Scene, screen: ObjectId, page: image::RgbaImage) -> Result<(), relievo::Error> {
    /// scene.set_image(screen, 0, page)?; // the model's first image, in all materials that show it
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_image(&mut self, object: ObjectId, index: usize, image: RgbaImage) -> Result<(), Error> {
        let (gpu, layouts) = (self.gpu.clone(), self.layouts_of_groups.clone());
        let mut staged = std::mem::take(&mut self.staged);
        let set = self.object_mut(object).map_err(Error::from).and_then(|entry| {
            let old = looks(entry)?.set_image(&gpu, index, image)?;
            let set = entry.change_materials(&gpu, &layouts, &mut staged, &Change::Image(index));
            if let (Err(_), Some(looks)) = (&set, &mut entry.looks) {
                match old {
                    Some(old) => looks.images[index] = old,
                    None => looks.images.truncate(index),
                }
            }
            set
        });
        self.staged = staged;
        set
    }

    /// A material of a mesh or a character. `material` is the material's name, or the digits of its index in the model.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, for terrain and reliefs, and for a material that the model
    /// does not have.
    pub fn material(&self, object: ObjectId, material: &str) -> Result<&Material, InputError> {
        let entry = self.object_at(object)?;
        let looks = entry.looks.as_ref().ok_or_else(|| without_materials(entry))?;
        Ok(&looks.materials[looks.find(material)?])
    }
}

/// A change to an object's materials.
enum Change<'a> {
    /// A replaced material: its index, and its previous value.
    Material(usize, &'a Material),
    /// The index of a replaced or added image.
    Image(usize),
}

impl Change<'_> {
    /// The new materials of a part; `None` if the part does not change.
    fn of(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        looks: &Looks,
        part: &PartMaterials,
    ) -> Result<Option<Changed>, Error> {
        Ok(match self {
            Self::Material(index, old) if part.has(*index) => {
                let samplings = part.samplings_with(looks, *index, old)?;
                Some(part.changed(gpu, layouts, looks, samplings, false)?)
            }
            Self::Image(index) if part.shows(*index) => {
                Some(part.changed(gpu, layouts, looks, part.samplings(), true)?)
            }
            _ => None,
        })
    }
}

impl Object {
    /// Changes the materials of all parts. If one part fails, no part changes.
    fn change_materials(
        &mut self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        staged: &mut Staged,
        change: &Change<'_>,
    ) -> Result<(), Error> {
        let (Some(looks), Some(first)) = (&self.looks, self.chunks.first()) else { return Ok(()) };
        let mut changes = Vec::new();
        for (at, drawable) in first.drawables.iter().enumerate() {
            let Some(mesh) = drawable.downcast::<MeshDrawable>() else { continue };
            for (number, part) in mesh.parts.iter().enumerate() {
                let MeshMaterials::Plain(materials) = part.materials() else { continue };
                if let Some(changed) = change.of(gpu, layouts, looks, materials)? {
                    changes.push((at, number, changed));
                }
            }
        }
        for (at, number, changed) in changes {
            changed.stage(staged)?;
            for chunk in &mut self.chunks {
                if let Some(mesh) = chunk.drawables[at].downcast_mut::<MeshDrawable>() {
                    mesh.parts[number].set_materials(MeshMaterials::Plain(changed.materials.clone()));
                }
            }
        }
        Ok(())
    }
}

fn looks(object: &mut Object) -> Result<&mut Looks, InputError> {
    let error = without_materials(object);
    object.looks.as_mut().ok_or(error)
}

fn without_materials(object: &Object) -> InputError {
    InputError::new("object", object.kind.name(), "must be a mesh or a character")
}
