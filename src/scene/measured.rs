//! What views drew of a scene, read back: for reports and measurements.

use super::object::Kind;
use super::{InstanceId, ObjectId, Scene, View};
use crate::Error;
use crate::asset::Affine;
use crate::lod::OBJECT_LISTS;

/// What a view drew of an object with one level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct DrawnLevel {
    /// Number of instances.
    pub instances: u64,
    /// Number of their triangles.
    pub triangles: u64,
}

impl Scene {
    /// What the last frame of a view, which must be submitted, drew of an object, level by level. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for an object that is not of this scene, and for a view that is not or was not
    /// recorded; [`crate::gpu::GpuError`].
    pub fn drawn_levels(&self, view: &View, object: ObjectId) -> Result<Vec<DrawnLevel>, Error> {
        let object = self.object_at(object)?;
        let draws = self.lists_of(view)?.arguments.read_blocking(&self.gpu)?;
        let mut levels = vec![DrawnLevel::default(); object.errors.len()];
        if !object.is_shown {
            return Ok(levels);
        }
        let own = &draws[object.range.first_draw as usize..][..object.draws.len()];
        for (part, lists) in own.chunks_exact(OBJECT_LISTS as usize).enumerate() {
            for (level, pair) in levels.iter_mut().zip(lists.chunks_exact(2)) {
                for draw in pair {
                    level.instances += if part == 0 { u64::from(draw.instances) } else { 0 };
                    level.triangles += u64::from(draw.instances) * u64::from(draw.indices) / 3;
                }
            }
        }
        Ok(levels)
    }

    /// The matrices from the space of each bone to the model's with which the last frame, which must be submitted, skinned
    /// the instances of a character, in the order of [`Scene::instances`]: bones that were not sampled keep older ones. An
    /// instance that no view has seen yet has zeros. Empty for what is no character. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for an object that is not of this scene; [`crate::gpu::GpuError`].
    pub fn drawn_bones(&self, object: ObjectId) -> Result<Vec<(InstanceId, Vec<Affine>)>, Error> {
        let entry = self.object_at(object)?;
        let Kind::Character(character) = &entry.kind else { return Ok(Vec::new()) };
        let (all, bones) = character.model_matrices(&self.gpu)?;
        let own = |[index, generation]: [u32; 2]| {
            (InstanceId { object, index, generation }, all[index as usize * bones..][..bones].to_vec())
        };
        Ok(entry.instances.each().map(own).collect())
    }

    /// The instances of an object that the last frame of a view, which must be submitted, drew, in the order of
    /// [`Scene::instances`]. Waits for the device.
    ///
    /// # Errors
    /// As [`Scene::drawn_levels`].
    pub fn seen(&self, view: &View, object: ObjectId) -> Result<Vec<InstanceId>, Error> {
        let all = self.drawn_instances(view, object)?.into_iter();
        Ok(all.filter(|instance| instance.drawn.is_some()).map(|instance| instance.instance).collect())
    }
}
