//! Watches bones: their matrices arrive on the host some frames later, without waiting.

use glam::{DAffine3, DVec3};

use crate::asset::Affine;
use crate::gpu::{Gpu, GpuError, ReadbackRing};
use crate::scene::Scene;
use crate::scene::handles::{InstanceId, Slots, no_character};
use crate::scene::layout::Layout;
use crate::scene::matrices::{affine_of, placed_model, rows_of};
use crate::scene::object::Object;
use crate::scene::placement::Placement;
use crate::shared::lod::allowed::Allowed;
use crate::shared::lod::instance::SceneInstance;
use crate::{Error, InputError};

/// Largest number of frames whose bones are in flight. If that many are in flight, the next frame's bones are left out.
const FRAMES: usize = 8;

/// A bone of an instance, for [`Scene::watch_bones`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InstanceBone<'a> {
    /// An instance of a character.
    pub instance: InstanceId,
    /// Name of the bone, or its index in digits.
    pub bone: &'a str,
}

/// The transforms of all watched bones in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct WatchedBones {
    /// Number of the frame: the number of frames that the scene recorded before it.
    pub frame: u64,
    /// The scene's time in that frame, in seconds.
    pub time: f64,
    /// The bones, in the order of the request. Bones whose instances no longer existed in that frame are left out.
    pub bones: Vec<WatchedBone>,
}

/// The transform of a watched bone in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WatchedBone {
    /// The instance.
    pub instance: InstanceId,
    /// The index of the bone in the skeleton.
    pub bone: usize,
    /// Whether a view of the frame saw the instance. If not, the transform is older: it is from the last frame in which
    /// a view saw the instance.
    pub is_current: bool,
    /// The cell of the instance's placement. `cell_from_bone` is relative to this cell's corner.
    pub cell: [i32; 3],
    /// The transform from bone space to world axes, relative to the cell's corner, as three matrix rows.
    pub cell_from_bone: Affine,
}

impl WatchedBone {
    /// The position of the bone's origin in world coordinates.
    pub fn world(&self) -> DVec3 {
        self.world_from_bone().translation
    }

    /// The transform from bone space to world coordinates.
    pub fn world_from_bone(&self) -> DAffine3 {
        DAffine3::from_translation(Placement::corner(self.cell)) * affine_of(&self.cell_from_bone)
    }
}

/// Facts about a frame whose bones are in flight.
#[derive(Debug)]
struct About {
    frame: u64,
    time: f64,
    bones: Vec<(InstanceId, usize, SceneInstance)>,
}

/// The bones to watch, and the readback of their matrices.
#[derive(Debug)]
pub(super) struct Watch {
    chosen: Vec<(InstanceId, usize)>,
    ring: ReadbackRing<About>,
    last: Option<WatchedBones>,
}

/// Bytes per bone: the bone's model matrix, and the allowed displacement of the bone's instance.
const BYTES: u64 = (size_of::<Affine>() + size_of::<f32>()) as u64;

impl Scene {
    /// Watches bones of characters. From the next frame on, [`Scene::watched_bones`] returns their matrices. The list
    /// replaces the previous list. Each bone costs two small copies per frame.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, and for a bone that the
    /// instance's model does not have; [`GpuError`].
    ///
    /// # Examples
    ///
    /// Prints the position of a hand, a few frames late and without waiting.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceBone, InstanceId, Scene};
    /// # fn example(scene: &mut Scene, fighter: InstanceId) -> Result<(), relievo::Error> {
    /// scene.watch_bones(&[InstanceBone { instance: fighter, bone: "hand_right" }])?; // once
    /// // In each frame:
    /// if let Some(watched) = scene.watched_bones() {
    ///     println!("at {} s: {}", watched.time, watched.bones[0].world());
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn watch_bones(&mut self, bones: &[InstanceBone<'_>]) -> Result<(), Error> {
        let chosen = bones.iter().map(|of| Ok((of.instance, self.bone(of.instance, of.bone)?)));
        let chosen = chosen.collect::<Result<Vec<_>, InputError>>()?;
        self.mark_watched(&chosen);
        self.watch = match chosen.is_empty() {
            true => None,
            false => Some(Watch::new(&self.gpu, chosen)?),
        };
        Ok(())
    }

    /// Lets the instances of watched bones keep their whole skeletons.
    fn mark_watched(&mut self, chosen: &[(InstanceId, usize)]) {
        for object in self.objects.iter_mut() {
            let handle = object.handle;
            let own = chosen.iter().filter(|(instance, _)| instance.object().number() == handle);
            let watched = own.map(|(instance, _)| instance.index).collect();
            let Some(character) = object.character_mut() else { continue };
            character.watch(watched).into_iter().for_each(|index| object.mark_whole(index));
        }
    }

    /// The watched bones of the last frame whose matrices have arrived; `None` before the first. The call does not
    /// wait. Matrices arrive when the device has executed the frame and is polled; each submission polls the device.
    pub fn watched_bones(&mut self) -> Option<&WatchedBones> {
        let watch = self.watch.as_mut()?;
        watch.arrive();
        watch.last.as_ref()
    }

    /// The index of a character's bone in the skeleton. `name_or_index` is the bone's name, or its index in digits.
    /// Names take precedence over indices.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character, and for a bone that the
    /// instance's model does not have.
    pub fn bone(&self, instance: InstanceId, name_or_index: &str) -> Result<usize, InputError> {
        self.object_of(instance)?.character().ok_or_else(no_character)?.bone(name_or_index)
    }
}

impl Watch {
    fn new(gpu: &Gpu, chosen: Vec<(InstanceId, usize)>) -> Result<Self, GpuError> {
        let ring = ReadbackRing::new(gpu, "watched bones", FRAMES, BYTES * chosen.len() as u64)?;
        Ok(Self { chosen, ring, last: None })
    }

    /// The same bones, watched on another device.
    pub(super) fn on(&self, gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { last: self.last.clone(), ..Self::new(gpu, self.chosen.clone())? })
    }

    /// Records commands that copy a frame's matrices to a readback buffer, if one is free.
    pub(super) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: u64,
        time: f64,
        objects: &Slots<Object>,
        layout: &Layout,
    ) {
        self.arrive();
        let placed = |(instance, bone): &(InstanceId, usize)| {
            let object = objects.existing(*instance)?;
            Some((*instance, *bone, object.instances.all()[instance.index as usize]))
        };
        let bones = self.chosen.iter().filter_map(placed).collect();
        let chosen = &self.chosen;
        self.ring.record(encoder, About { frame, time, bones }, |encoder, to| {
            let copies = chosen.iter().filter_map(|(instance, bone)| {
                let object = objects.existing(*instance)?;
                let (matrices, own) = object.character()?.model_matrices(instance.index)?;
                Some((matrices, own, *bone, object.place(instance.index)?))
            });
            for (at, (matrices, instance, bone, place)) in (0..).zip(copies) {
                let (matrix, word) = (size_of::<Affine>() as u64, size_of::<f32>() as u64);
                let allowed = size_of::<Allowed>() as u64;
                let from = matrix * (instance * matrices.bones + bone) as u64;
                encoder.copy_buffer_to_buffer(matrices.raw, from, to, BYTES * at, matrix);
                let from = allowed * place as u64;
                encoder.copy_buffer_to_buffer(layout.allowed.raw(), from, to, BYTES * at + matrix, word);
            }
        });
    }

    /// Discards the readbacks of frames whose encoders were dropped.
    pub(super) fn invalidate(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        self.ring.invalidate(gpu)
    }

    fn arrive(&mut self) {
        let Some((About { frame, time, bones }, bytes)) = self.ring.take() else { return };
        let words = bytemuck::pod_collect_to_vec::<u8, [f32; 13]>(&bytes[..BYTES as usize * bones.len()]);
        let bone = |((instance, bone, placed), words): (&(InstanceId, usize, SceneInstance), &[f32; 13])| {
            let rows: Affine = std::array::from_fn(|row| std::array::from_fn(|at| words[4 * row + at]));
            let cell_from_bone = rows_of(placed_model(placed, placed.cell) * affine_of(&rows));
            let (instance, is_current) = (*instance, words[12] >= 0.0);
            WatchedBone { instance, bone: *bone, is_current, cell: placed.cell, cell_from_bone }
        };
        let bones = bones.iter().zip(&words).map(bone).collect();
        self.last = Some(WatchedBones { frame, time, bones });
    }
}
