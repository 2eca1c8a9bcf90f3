//! Reads back bones and instances of drawn frames, for measurements.

use super::{InstanceId, ObjectId, Scene, View};
use crate::Error;
use crate::asset::Affine;

impl Scene {
    /// The model matrices with which the last frame skinned the instances of a character, in the order of
    /// [`Scene::instances`]. Submit the frame before this call, which waits for the device. A bone that the frame did
    /// not sample has an older matrix. An instance that no view has seen yet has zeros. The result is empty for an
    /// object that is not a character.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for an object that is not of this scene; [`crate::gpu::GpuError`].
    pub fn drawn_bones(&self, object: ObjectId) -> Result<Vec<(InstanceId, Vec<Affine>)>, Error> {
        let entry = self.object_at(object)?;
        let Some(character) = entry.character() else { return Ok(Vec::new()) };
        let (all, bones) = character.read_matrices(&self.gpu)?;
        let own = |[index, generation]: [u32; 2]| {
            (InstanceId { object, index, generation }, all[index as usize * bones..][..bones].to_vec())
        };
        Ok(entry.instances.each().map(own).collect())
    }

    /// The instances of an object that a view drew in its last frame, in the order of [`Scene::instances`]. Submit the
    /// frame before this call, which waits for the device.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for an object that is not of this scene, and for a view that the last frame did
    /// not record; [`crate::gpu::GpuError`].
    pub fn seen(&self, view: &View, object: ObjectId) -> Result<Vec<InstanceId>, Error> {
        let all = self.drawn_instances(view, object)?.into_iter();
        Ok(all.filter(|instance| instance.drawn.is_some()).map(|instance| instance.instance).collect())
    }
}
