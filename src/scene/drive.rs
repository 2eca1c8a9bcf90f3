//! Driven bones: the caller changes their local transforms in a frame, before model matrices are computed from them.

use crate::animation::crowd::{Local, packed};
use crate::asset::Transform;
use crate::gpu::{Gpu, GpuError, StagingRing, StagingStream};
use crate::scene::character::Character;
use crate::scene::handles::{InstanceId, Slots, missing, no_character};
use crate::scene::object::Object;
use crate::scene::poses::PoseBuffers;
use crate::scene::view::View;
use crate::scene::{FRAMES_IN_FLIGHT, Scene};
use crate::{Error, InputError};

/// The poses of all characters in a frame, after bones are sampled. [`Scene::record_with`] passes them to the caller.
#[derive(Debug)]
pub struct Poses<'a> {
    gpu: &'a Gpu,
    objects: &'a mut Slots<Object>,
    /// Staging memory for the host's writes; `None` if all staging buffers are in use.
    stream: Option<StagingStream<'a>>,
    failure: Option<GpuError>,
}

impl<'a> Poses<'a> {
    pub(super) fn new(gpu: &'a Gpu, objects: &'a mut Slots<Object>, staging: &'a mut StagingRing) -> Self {
        let characters = objects.iter().filter_map(|object| object.character());
        let room = characters.map(Character::driven_bones).sum::<usize>() * size_of::<Local>();
        Self { gpu, objects, stream: staging.stream(gpu, room), failure: None }
    }

    /// The buffers that hold an instance's pose, for the caller's kernels.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character.
    pub fn of(&self, instance: InstanceId) -> Result<PoseBuffers<'_>, InputError> {
        let scene = self.objects.scene();
        let object = self.objects.existing(instance).ok_or_else(|| missing(scene, instance))?;
        let found = object.character().and_then(|character| character.pose_buffers(instance.index));
        found.ok_or_else(no_character)
    }

    /// Writes the local transform of a driven bone ([`Scene::drive`]) from the host. `local` is the transform from bone
    /// space to the parent's space, as in [`InstancePose::local`](crate::scene::InstancePose::local). `bone` is an index
    /// ([`Scene::bone`]).
    ///
    /// The write is recorded as a copy of 48 bytes into `encoder`, which must be the encoder that [`Scene::record_with`]
    /// passes to its closure. Work recorded later in this encoder sees the new value. The write holds for this frame only:
    /// the next frame samples the bone again, so write in every frame. [`Scene::pick`], [`Scene::bounds`] and
    /// [`Scene::tight_bounds`] use the values written in the last frame. Nothing is submitted. Memory is allocated only if
    /// a frame writes more than any earlier frame.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, for a bone that is not driven, for a
    /// transform that [`Transform::checked`] refuses, and for an encoder of another [`wgpu::Instance`].
    pub fn write(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        instance: InstanceId,
        bone: usize,
        local: Transform,
    ) -> Result<(), InputError> {
        let local = local.checked("local")?;
        self.gpu.check_encoder(encoder)?;
        let (scene, index) = (self.objects.scene(), instance.index);
        let object = self.objects.existing_mut(instance).ok_or_else(|| missing(scene, instance))?;
        let character = object.character_mut().ok_or_else(no_character)?;
        let Some(stream) = &mut self.stream else {
            return Err(InputError::new(
                "recordings",
                FRAMES_IN_FLIGHT,
                format!("must be below {FRAMES_IN_FLIGHT}"),
            ));
        };
        character.note_written(index, bone, local)?;
        let buffers = character.pose_buffers(index).ok_or_else(no_character)?;
        let at = (buffers.index as usize * buffers.bones as usize + bone) * size_of::<Local>();
        let written =
            stream.write(encoder, buffers.locals.raw(), at as u64, bytemuck::bytes_of(&packed(&local)));
        self.failure = self.failure.take().or(written.err());
        Ok(())
    }

    /// Ends the writes and uploads their values. Returns the first error of a write, if any.
    pub(super) fn finish(self, encoder: &mut wgpu::CommandEncoder) -> Result<(), GpuError> {
        match (self.failure, self.stream) {
            (Some(failure), _) => Err(failure),
            (None, Some(stream)) => stream.finish(encoder),
            (None, None) => Ok(()),
        }
    }
}

impl Scene {
    /// Forgets the local transforms that the host wrote in the last frame.
    pub(super) fn forget_written(&mut self) {
        let characters = self.objects.iter_mut().filter_map(|object| object.character_mut());
        characters.for_each(Character::forget_written);
    }

    /// Sets the driven bones of an instance, from the next frame on. A bone is given by its name or its index in digits. An
    /// empty list ends driving.
    ///
    /// In every frame in which a view sees the instance, driven bones are sampled at the frame's time, even if their motion
    /// is too small to be seen. The caller may then change them ([`Scene::record_with`]). Driven bones and all bones below
    /// them count as updated, so their vertices are skinned again. [`Quality::pixels`](crate::scene::Quality) bounds
    /// the error of the sampled pose, not the caller's changes. Culling uses the bounding sphere of the clip, so driven bones
    /// should stay near this sphere. Changing the driven bones of an object allocates memory in the next frame.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, and for a bone that its model does
    /// not have. If an error is returned, nothing changes.
    pub fn drive(&mut self, instance: InstanceId, bones: &[&str]) -> Result<(), InputError> {
        let bones = bones.iter().map(|bone| Ok(self.bone(instance, bone)? as u32));
        let bones = bones.collect::<Result<Vec<_>, InputError>>()?;
        self.character_mut(instance)?.drive(instance.index, bones);
        self.object_mut(instance.object())?.mark_whole(instance.index);
        Ok(())
    }

    /// Like [`Scene::record`], but calls `pose` after bones are sampled and before their model matrices are computed. This
    /// serves inverse kinematics and ragdolls. `pose` receives the encoder and the poses. It may change the local transforms
    /// of driven bones ([`Scene::drive`]) from the host ([`Poses::write`]), or by kernels and copies ([`Poses::of`]).
    ///
    /// # Examples
    ///
    /// A head that is turned by 0.3 radians about the world's vertical axis, in addition to its clip's motion.
    ///
    /// ```no_run
    /// # use glam::DQuat;
    /// # use relievo::scene::{InstanceId, Scene, View};
    /// # fn frame(
    /// #     (mut scene, mut eye, fox): (Scene, View, InstanceId),
    /// #     mut encoder: wgpu::CommandEncoder,
    /// # ) -> Result<(), relievo::Error> {
    /// // Once.
    /// let head = scene.bone(fox, "Head")?;
    /// scene.drive(fox, &["Head"])?;
    ///
    /// // In each frame.
    /// scene.advance(1.0 / 60.0)?;
    /// let mut pose = scene.pose(fox)?;
    /// pose.turn(head, DQuat::from_rotation_y(0.3))?;
    /// scene.record_with(&mut encoder, &mut [&mut eye], |encoder, poses| {
    ///     poses.write(encoder, fox, head, pose.local(head)?)
    /// })?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// The errors of [`Scene::record`], and the error of `pose`. After an error of `pose`, the frame is incomplete: it cannot
    /// be drawn, and the next frame starts afresh.
    pub fn record_with(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        views: &mut [&mut View],
        pose: impl FnOnce(&mut wgpu::CommandEncoder, &mut Poses<'_>) -> Result<(), InputError>,
    ) -> Result<(), Error> {
        let mut pose = Some(pose);
        let mut call = |encoder: &mut wgpu::CommandEncoder, poses: &mut Poses<'_>| match pose.take() {
            Some(pose) => pose(encoder, poses),
            None => Ok(()),
        };
        self.record_frame(encoder, views, Some(&mut call))
    }
}
