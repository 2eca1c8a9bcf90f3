//! Replaces the model of an object whose instances stay. Instances change to new levels of detail by the object's transition.

use crate::asset::Model;
use crate::lod::transition::{Pace, Transition};
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
        self.object_mut(object)?.successor = Some(Box::new(next));
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
        self.object_mut(object)?.successor = Some(Box::new(next));
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
        if self.arrival.is_running() { self.arrival.error.max(self.finest_error) } else { self.finest_error }
    }

    /// Brings the levels of a new model further into use. `seconds` is the time since the last frame.
    pub(super) fn arrive(&mut self, seconds: f32) {
        if self.arrival.is_running() {
            self.arrival.advance(self.level_of_detail.transition(), seconds);
            self.is_retuned = true;
        }
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

/// Seconds over which the levels of a new model come into use.
const ARRIVAL: f32 = 0.5;

/// Least progress in a frame, so that an arrival ends even if no time passes.
const LEAST_STEP: f32 = 1.0 / 16.0;

/// How far the levels of a new model have come into use. The thresholds of its new levels rise from 0 to their values, so no
/// level finer than those of the old model is chosen at first, and then one after the other, as if instances came nearer.
#[derive(Debug, Clone, Default)]
pub(super) struct Arrival {
    /// The progress of the threshold of each level, 0 to 1. It does not decrease from one level to the next. Empty if nothing
    /// arrives; levels beyond the list have arrived.
    progress: Vec<f32>,
    /// The error of the old model's finest level in model units.
    error: f32,
}

impl Arrival {
    pub fn is_running(&self) -> bool {
        !self.progress.is_empty()
    }

    /// Begins with a new model, whose levels have this many triangles. The finest level of the old model had `finest` triangles, and
    /// the error `error` in model units. Thresholds of the old model's levels keep their progress.
    fn begin(&mut self, finest: u32, triangles: &[u32], error: f32) {
        let finer = triangles.iter().take_while(|own| **own > finest).count();
        // Between two levels, the finer one loses nothing.
        let same = if triangles.get(finer) == Some(&finest) { finer } else { finer.saturating_sub(1) };
        if same == 0 {
            return;
        }
        self.error = if self.is_running() { self.error.max(error) } else { error };
        let kept = std::mem::take(&mut self.progress).into_iter().skip(1);
        self.progress = std::iter::repeat_n(0.0, 1 + same).chain(kept).collect();
    }

    fn advance(&mut self, transition: Transition, seconds: f32) {
        // A fade in time takes its own time from here on.
        let is_timed = matches!(transition.pace(), Some(Pace::Seconds(_)));
        let step = if is_timed { 1.0 } else { (seconds / ARRIVAL).max(LEAST_STEP) };
        self.progress.iter_mut().for_each(|progress| *progress = (*progress + step).min(1.0));
        if self.progress.iter().all(|progress| *progress == 1.0) {
            *self = Self::default();
        }
    }

    /// Thresholds with those of levels that still arrive lowered. Errors of levels grow by a factor from one to the next, so a
    /// cube spends about the same time on each.
    pub fn lowered(&self, mut thresholds: Vec<f32>) -> Vec<f32> {
        for (threshold, progress) in thresholds.iter_mut().zip(&self.progress) {
            *threshold *= progress.powi(3);
        }
        thresholds
    }
}

#[cfg(test)]
mod tests {
    use super::{ARRIVAL, Arrival};
    use crate::lod::transition::{Pace, Transition};

    #[test]
    fn levels_come_into_use_one_after_the_other() {
        let mut arrival = Arrival::default();
        let all = [0.0, 1.0, 2.0, 4.0, 8.0];
        // The old model had the two coarsest of five levels.
        arrival.begin(100, &[1000, 500, 200, 100, 50], 0.25);
        assert_eq!(arrival.lowered(all.to_vec()), [0.0, 0.0, 0.0, 0.0, 8.0]);
        arrival.advance(Transition::Geomorph, 0.5 * ARRIVAL);
        assert_eq!(arrival.lowered(all.to_vec()), [0.0, 0.125, 0.25, 0.5, 8.0]);
        // A still finer model comes meanwhile, with two levels more.
        arrival.begin(1000, &[4000, 2000, 1000, 500, 200, 100, 50], 0.125);
        assert_eq!(arrival.error, 0.25);
        let lowered = arrival.lowered(vec![0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0]);
        assert_eq!(lowered, [0.0, 0.0, 0.0, 0.125, 0.25, 0.5, 8.0]);
        // If no time passes, it ends as well.
        let frames = (1..).find(|_| {
            arrival.advance(Transition::Geomorph, 0.0);
            !arrival.is_running()
        });
        assert_eq!(frames, Some(16));
        assert_eq!(arrival.lowered(all.to_vec()), all);
    }

    #[test]
    fn a_level_between_two_is_replaced_by_the_finer_one() {
        let mut arrival = Arrival::default();
        arrival.begin(150, &[1000, 500, 200, 100, 50], 0.25);
        assert_eq!(arrival.lowered(vec![0.0, 1.0, 2.0, 4.0, 8.0]), [0.0, 0.0, 0.0, 4.0, 8.0]);
        let mut arrival = Arrival::default();
        arrival.begin(1000, &[1000, 500], 0.0);
        assert!(!arrival.is_running(), "nothing is finer");
    }

    #[test]
    fn fades_in_time_begin_after_one_frame() {
        let mut arrival = Arrival::default();
        arrival.begin(100, &[400, 100], 0.25);
        arrival.advance(Transition::Dither(Pace::Seconds(2.0)), 0.01);
        assert!(!arrival.is_running());
    }
}
