//! Poses of the caller: bones that it drives itself, between sampling and model matrices.

use crate::Error;
use crate::InputError;
use crate::scene::Scene;
use crate::scene::handles::{InstanceId, Slots, stale};
use crate::scene::object::{Kind, Object};
use crate::scene::poses::PoseBuffers;
use crate::scene::view::View;

/// The poses of all characters in a frame whose bones have been sampled, for [`Scene::record_with`].
#[derive(Debug, Clone, Copy)]
pub struct Poses<'a> {
    pub(super) objects: &'a Slots<Object>,
}

impl<'a> Poses<'a> {
    /// The buffers in which the pose of an instance lies.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, or is no character.
    pub fn of(&self, instance: InstanceId) -> Result<PoseBuffers<'a>, InputError> {
        let InstanceId { index, generation, .. } = instance;
        let object = self.objects.existing(instance).ok_or_else(|| stale("instance", index, generation))?;
        let found = match &object.kind {
            Kind::Character(character) => character.pose_buffers(index),
            _ => None,
        };
        found.ok_or_else(|| InputError::new("instance", "no character", "must be an instance of a character"))
    }
}

impl Scene {
    /// Says which bones of an instance the caller drives, each by its name or its index, from the next frame on; none of them
    /// ends that. In every frame in which a view sees the instance, they are sampled at the time of the frame, whatever the
    /// gate says; then the caller may change them ([`Scene::record_with`]), and they and all bones below them count as updated.
    /// What it makes of them is its own: [`Quality::pixels`](crate::scene::Quality) is promised as if they were sampled. The
    /// sphere by which an instance is culled is that of its clip, so bones should stay near. Changing the driven
    /// bones of an object allocates in the next frame.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, and for a bone that its model does not
    /// have; nothing changes then.
    pub fn drive(&mut self, instance: InstanceId, bones: &[&str]) -> Result<(), InputError> {
        let bones = bones.iter().map(|bone| Ok(self.bone(instance, bone)? as u32));
        let bones = bones.collect::<Result<Vec<_>, InputError>>()?;
        let object = self.instance_mut(instance)?;
        let Kind::Character(character) = &mut object.kind else {
            return Err(InputError::new("instance", "a mesh", "must be an instance of a character"));
        };
        character.drive(instance.index, bones);
        Ok(())
    }

    /// As [`Scene::record`], with passes of the caller between the sampling of bones and their model matrices: for inverse
    /// kinematics and ragdolls. `pose` gets the encoder and the poses; what it records may write the local transforms of bones
    /// that are driven ([`Scene::drive`]), whether by a kernel or by copies.
    ///
    /// # Errors
    /// As [`Scene::record`], and the error of `pose`. Then the frame is not whole: it cannot be drawn, and the next one starts
    /// afresh.
    pub fn record_with(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        views: &mut [&mut View],
        pose: impl FnOnce(&mut wgpu::CommandEncoder, Poses<'_>) -> Result<(), InputError>,
    ) -> Result<(), Error> {
        let mut pose = Some(pose);
        let mut call = |encoder: &mut wgpu::CommandEncoder, poses: Poses<'_>| match pose.take() {
            Some(pose) => pose(encoder, poses),
            None => Ok(()),
        };
        self.record_frame(encoder, views, Some(&mut call))
    }
}
