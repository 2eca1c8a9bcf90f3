//! Reading back what was drawn of a scene, for measurements.

use super::{InstanceId, ObjectId, Scene, View};
use crate::Error;
use crate::asset::Affine;

impl Scene {
    /// The model matrices with which the last frame skinned a character's instances, in the order of [`Scene::instances`].
    /// The frame must have been submitted. Bones that were not sampled have older matrices. An instance that no view has
    /// seen yet has zeros. Empty for an object that is not a character. Waits for the device.
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

    /// The instances of an object that the last frame of a view drew, in the order of [`Scene::instances`]. The frame must
    /// have been submitted. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for an object that is not of this scene, and for a view that the last frame did
    /// not record; [`crate::gpu::GpuError`].
    pub fn seen(&self, view: &View, object: ObjectId) -> Result<Vec<InstanceId>, Error> {
        let all = self.drawn_instances(view, object)?.into_iter();
        Ok(all.filter(|instance| instance.drawn.is_some()).map(|instance| instance.instance).collect())
    }
}
