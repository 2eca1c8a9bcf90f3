//! What was drawn of a scene, read back: for measurements.

use super::{InstanceId, ObjectId, Scene, View};
use crate::Error;
use crate::asset::Affine;

impl Scene {
    /// The matrices from the space of each bone to the model's with which the last frame, which must be submitted, skinned
    /// the instances of a character, in the order of [`Scene::instances`]: bones that were not sampled keep older ones. An
    /// instance that no view has seen yet has zeros. Empty for what is no character. Waits for the device.
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

    /// The instances of an object that the last frame of a view, which must be submitted, drew, in the order of
    /// [`Scene::instances`]. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for an object that is not of this scene, and for a view that is not or was not
    /// recorded; [`crate::gpu::GpuError`].
    pub fn seen(&self, view: &View, object: ObjectId) -> Result<Vec<InstanceId>, Error> {
        let all = self.drawn_instances(view, object)?.into_iter();
        Ok(all.filter(|instance| instance.drawn.is_some()).map(|instance| instance.instance).collect())
    }
}
