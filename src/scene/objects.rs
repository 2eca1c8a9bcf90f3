//! What adds objects to a scene, shows them, and removes them.

use crate::asset::Model;
use crate::gpu::Upload as _;
use crate::scene::Scene;
use crate::scene::handles::{ObjectId, stale};
use crate::scene::layers::CharacterOptions;
use crate::scene::object::{Kind, Object};
use crate::scene::relief::Relief;
use crate::scene::terrain::TerrainSource;
use crate::terrain::mesh::GroundPoint;
use crate::{Error, InputError};

impl Scene {
    /// Adds terrain: generates its patches, and shows them.
    ///
    /// # Errors
    /// [`InputError`] for a configuration or patches out of bounds, and for more patches than one binding holds;
    /// [`crate::gpu::GpuError`].
    pub fn add_terrain(&mut self, source: &TerrainSource) -> Result<ObjectId, Error> {
        let object = Object::terrain(&self.gpu, &self.layouts_of_groups, source)?;
        Ok(self.add(object))
    }

    /// The ground of a terrain that is drawn, at a position of the world in world units east and south of its origin: height
    /// and normal of the triangle there. `None` where the terrain has no patch.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, or no terrain.
    pub fn ground(&self, terrain: ObjectId, x: f64, z: f64) -> Result<Option<GroundPoint>, InputError> {
        let ObjectId { index, generation } = terrain;
        let object =
            self.objects.get([index, generation]).ok_or_else(|| stale("terrain", index, generation))?;
        match &object.kind {
            Kind::Terrain(terrain) => Ok(terrain.point_at(x, z)),
            _ => Err(InputError::new("terrain", "a mesh or a character", "must be terrain")),
        }
    }

    /// Adds a mesh that does not move by itself: all meshes of a model, posed at rest, with their levels of detail
    /// ([`add_levels`](crate::skinning::add_levels)) and materials. There is room for `capacity` instances; more than
    /// that let it grow, which allocates.
    ///
    /// # Errors
    /// [`InputError`] for a model without meshes or with invalid ones; [`crate::gpu::GpuError`].
    pub fn add_mesh(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        let object = Object::mesh(&self.gpu, &self.layouts_of_groups, model, capacity)?;
        Ok(self.add(object))
    }

    /// Adds a character: its bones are sampled from its clips, gated, and its meshes morphed and skinned, each only as
    /// far as a view needs. A model without clips becomes a mesh ([`Scene::add_mesh`]). There is room for `capacity`
    /// instances; more than that let it grow, which allocates and lets all of them start afresh.
    ///
    /// # Errors
    /// [`InputError`] for a model without meshes or with invalid ones; [`crate::gpu::GpuError`].
    pub fn add_character(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        self.add_character_with(model, capacity, &CharacterOptions::default())
    }

    /// As [`Scene::add_character`], with layers of animation above the base, or with the motion of its root taken out of its
    /// clips. A model without clips has neither.
    ///
    /// # Errors
    /// As [`Scene::add_character`]; [`InputError`] for more than 7 layers, for a bone that the model does not have, and for
    /// motion that cannot be taken out ([`RootMotion::extract`](crate::animation::RootMotion::extract)).
    pub fn add_character_with(
        &mut self,
        model: &Model,
        capacity: usize,
        options: &CharacterOptions<'_>,
    ) -> Result<ObjectId, Error> {
        if model.clips.is_empty() {
            return self.add_mesh(model, capacity);
        }
        let layouts = &self.layouts_of_groups;
        let object = Object::character(&self.gpu, layouts, (model, options), capacity, self.shares)?;
        Ok(self.add(object))
    }

    /// Adds a mesh that carries a relief. There is room for `capacity` instances; more than that let it grow, which
    /// allocates.
    ///
    /// # Errors
    /// [`InputError`] for maps, options or a mesh that do not fit each other; [`crate::gpu::GpuError`].
    pub fn add_relief(&mut self, relief: &Relief, capacity: usize) -> Result<ObjectId, Error> {
        let object = Object::relief(&self.gpu, &self.layouts_of_groups, relief, capacity)?;
        Ok(self.add(object))
    }

    fn add(&mut self, object: Object) -> ObjectId {
        self.layout = None;
        let [index, generation] = self.objects.insert(object);
        ObjectId { index, generation }
    }

    /// Removes an object with all of its instances, and releases its memory.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn remove(&mut self, object: ObjectId) -> Result<(), InputError> {
        let ObjectId { index, generation } = object;
        for instance in self.instances(object)? {
            self.let_go(instance)?;
        }
        self.objects.remove([index, generation]).ok_or_else(|| stale("object", index, generation))?;
        self.layout = None;
        Ok(())
    }

    /// Shows or hides all instances of an object. Hidden ones cost nothing, and go on playing.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene; [`crate::gpu::GpuError`].
    pub fn show(&mut self, object: ObjectId, is_shown: bool) -> Result<(), Error> {
        let entry = self.object_mut(object)?;
        if std::mem::replace(&mut entry.is_shown, is_shown) != is_shown {
            // Until the next layout, the object's entry is written alone.
            let (value, number) = (entry.lod_object(), entry.number);
            if let Some(layout) = &self.layout {
                self.staged.elements(&layout.objects, number, &[value])?;
            }
        }
        Ok(())
    }

    pub(super) fn object_mut(&mut self, object: ObjectId) -> Result<&mut Object, InputError> {
        let ObjectId { index, generation } = object;
        self.objects.get_mut([index, generation]).ok_or_else(|| stale("object", index, generation))
    }
}
