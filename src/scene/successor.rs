//! Replaces the model of an object whose instances stay. Instances change to new levels of detail by the object's transition.

use crate::asset::Model;
use crate::lod::transition::Transition;
use crate::scene::Scene;
use crate::scene::handles::ObjectId;
use crate::scene::instances;
use crate::scene::mesh::MeshAtRest;
use crate::scene::object::Object;
use crate::scene::options::CharacterOptions;
use crate::{Error, InputError};

impl Scene {
    /// Replaces the model of a mesh, for example by one with finer levels of detail that has just arrived. Handles,
    /// placements, tints, masks and the choice of levels stay. Of thresholds for more levels than the model has, the first ones
    /// count.
    ///
    /// The new model is shown from the next recording on; with an upload budget ([`Scene::set_upload_budget`]), once all
    /// of its data has arrived. Until then the old model is drawn. Instances change to finer levels by the object's transition,
    /// over half a second ([`Scene::is_refining`]); [`Transition::Hard`] changes them at once. Call
    /// [`Renderer::prepare`](crate::render::Renderer::prepare) after this function, as after adding an object.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not a mesh of this scene, and for a model that [`Scene::add_mesh`] refuses;
    /// [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// A finer package of the same stone has arrived.
    ///
    /// ```no_run
    /// # use relievo::asset::Model;
    /// # use relievo::render::Renderer;
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(scene: &mut Scene, renderer: &mut Renderer, stone: ObjectId, bytes: &[u8]) -> Result<(), relievo::Error> {
    /// scene.set_model(stone, &Model::from_rlv(bytes)?)?;
    /// renderer.prepare(scene)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_model(&mut self, object: ObjectId, model: &Model) -> Result<(), Error> {
        let old = self.object_at(object)?;
        let is_mesh = old.kind.downcast::<MeshAtRest>().is_some();
        InputError::check(is_mesh, "object", old.kind.name(), || "must be a mesh")?;
        let capacity = old.capacity();
        let next = self.mesh(model, capacity)?;
        self.object_mut(object)?.become_later(next);
        Ok(())
    }

    /// Like [`Scene::set_model`], for a character. `options` are those of the new model; layers and their weights, clips
    /// and driven bones stay.
    ///
    /// # Errors
    /// As for [`Scene::set_model`] and [`Scene::add_character_with`]; [`InputError`] for a model with other bones, clips
    /// or layers.
    pub fn set_character_model(
        &mut self,
        object: ObjectId,
        model: &Model,
        options: &CharacterOptions<'_>,
    ) -> Result<(), Error> {
        let old = self.object_at(object)?;
        let Some(character) = old.character() else {
            return Err(InputError::new("object", old.kind.name(), "must be a character").into());
        };
        character.check_successor(model, options)?;
        let capacity = old.capacity();
        let next = self.character(model, capacity, options)?;
        self.object_mut(object)?.become_later(next);
        Ok(())
    }

    /// Whether an object with instances still changes to the model that it was given by [`Scene::set_model`] or
    /// [`Scene::set_character_model`]. A program that draws only on change goes on drawing as long as this is true.
    pub fn is_refining(&self) -> bool {
        self.objects.iter().any(|object| object.successor.is_some() || object.arrival.is_running())
    }

    /// Shows the new models of all objects whose data has arrived.
    pub(super) fn succeed(&mut self) -> Result<(), InputError> {
        let changed = self.objects.iter_mut().filter_map(|object| object.succeed().then_some(()));
        if changed.count() == 0 {
            return Ok(());
        }
        self.attachments.start_afresh();
        self.layout = None;
        self.carry_all()
    }
}

impl Object {
    /// The successor, or the object itself if there is none.
    pub(super) fn newest(&self) -> &Self {
        self.successor.as_deref().unwrap_or(self)
    }

    /// The error of what is drawn at full detail, in model units. While finer levels arrive, it is that of the old model.
    pub(super) fn finest_error(&self) -> f32 {
        self.arrival.error.max(self.finest_error)
    }

    /// Brings the levels of a new model further into use. `seconds` is the time since the last frame.
    pub(super) fn arrive(&mut self, seconds: f32) {
        if self.arrival.is_running() {
            self.arrival.advance(self.level_of_detail.transition(), seconds);
            self.is_retuned = true;
        }
    }

    /// Sets the successor.
    fn become_later(&mut self, next: Self) {
        self.successor = Some(Box::new(next));
        self.mark_transition();
    }

    /// Takes over the successor, if all of its data has arrived. Whether it did.
    fn succeed(&mut self) -> bool {
        let Some(mut next) = self.successor.take_if(|next| next.pending.is_none()) else { return false };
        next.kind.follow(&mut *self.kind);
        let finest = self.triangles().first().copied().unwrap_or(0);
        let before = self.finest_error();
        let Self {
            kind, sphere, errors, finest_error, mesh_fraction, model_box, looks, draws, chunks, ..
        } = *next;
        (self.kind, self.sphere, self.errors, self.finest_error) = (kind, sphere, errors, finest_error);
        (self.model_box, self.looks, self.draws, self.chunks) = (model_box, looks, draws, chunks);
        self.mesh_fraction = mesh_fraction;
        self.start_afresh();
        if !matches!(self.level_of_detail.transition(), Transition::Hard | Transition::Alpha { .. }) {
            self.arrival.begin(finest, &self.triangles(), before);
        }
        let alive: Vec<u32> = self.instances.each().map(|[index, _]| index).collect();
        for index in alive {
            let sphere = self.kind.sphere_of(index).unwrap_or(self.sphere);
            self.instances.change(index, |instance| instances::bound(instance, &sphere));
            self.mark_whole(index);
        }
        true
    }
}
