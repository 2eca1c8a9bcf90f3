//! Driven bones of a character: the caller may change their local transforms in each frame.

use std::collections::BTreeMap;

use super::Character;
use crate::animation::compact::CompactPass;
use crate::animation::drive::{DrivePass, DrivenBones, driven_words};
use crate::animation::order::Order;
use crate::asset::Transform;
use crate::gpu::{Gpu, Staged, Upload as _};
use crate::scene::poses::PoseBuffers;
use crate::{Error, InputError};

/// The driven bones of all instances of a character.
#[derive(Debug, Default)]
pub(super) struct Driven {
    /// Indices of the driven bones, per instance.
    bones: BTreeMap<u32, Vec<u32>>,
    /// Number of changes to `bones`.
    version: u64,
    /// Instances whose recorded sampling history no longer matches their pose. Their bones are sampled afresh in the next
    /// frame.
    strange: Vec<u32>,
    /// Local transforms that the host wrote in the last frame, by instance and bone.
    pub(super) written: BTreeMap<u32, BTreeMap<usize, Transform>>,
}

impl Character {
    /// Sets the driven bones of an instance. An empty list ends driving.
    pub fn drive(&mut self, index: u32, bones: Vec<u32>) {
        let before = if bones.is_empty() {
            self.driven.bones.remove(&index)
        } else {
            self.driven.bones.insert(index, bones)
        };
        // Bones that are no longer driven must be sampled afresh.
        self.driven.strange.extend(before.map(|_| index));
        self.driven.written.remove(&index);
        self.driven.version += 1;
    }

    /// Notes the local transform that the host writes to a bone in this frame.
    ///
    /// # Errors
    /// [`InputError`] for a bone that is not driven.
    pub fn note_written(&mut self, index: u32, bone: usize, local: Transform) -> Result<(), InputError> {
        let is_driven = |bones: &Vec<u32>| bones.iter().any(|driven| *driven as usize == bone);
        if !self.driven.bones.get(&index).is_some_and(is_driven) {
            return Err(InputError::new("bone", bone, "must be driven (Scene::drive)"));
        }
        self.driven.written.entry(index).or_default().insert(bone, local);
        Ok(())
    }

    /// Forgets the local transforms that the host wrote in the last frame.
    pub fn forget_written(&mut self) {
        self.driven.written.clear();
    }

    /// Whether the host wrote to bones of this instance in the last frame.
    pub fn is_written(&self, index: u32) -> bool {
        self.driven.written.contains_key(&index)
    }

    /// Whether bones of this instance are driven.
    pub fn is_driven(&self, index: u32) -> bool {
        self.driven.bones.contains_key(&index)
    }

    /// Number of driven bones of all instances.
    pub fn driven_bones(&self) -> usize {
        self.driven.bones.values().map(Vec::len).sum()
    }

    /// Ends driving for an instance that is despawned.
    pub fn let_go(&mut self, index: u32) {
        if self.driven.bones.contains_key(&index) {
            self.drive(index, Vec::new());
        }
    }

    /// Prepares the jobs for driven bones, unless they are up to date.
    pub fn fit_driven(&mut self, gpu: &Gpu, staged: &mut Staged) -> Result<(), Error> {
        let Driven { bones, version, strange, .. } = &mut self.driven;
        for index in strange.drain(..).map(|index| index as usize) {
            if let Some(runtime) = self.runtimes.iter().find(|runtime| runtime.slots.contains(&index)) {
                staged.elements(&runtime.frame.state.history, index - runtime.slots.start, &[[0; 4]])?;
            }
        }
        for runtime in self.runtimes.iter_mut().filter(|runtime| runtime.driven_version != *version) {
            let (from, to) = (runtime.slots.start as u32, runtime.slots.end as u32);
            let own =
                bones.range(from..to).map(|(index, bones)| DrivenBones { instance: *index - from, bones });
            let words = driven_words(&Order::new(&self.shared.tiers.skeleton), own);
            runtime.driven = None;
            if !words.is_empty() {
                let (crowd, frame) = (&runtime.crowd, &runtime.frame);
                let drive = DrivePass::new(gpu)?.prepare(gpu, &words, crowd, &frame.state, &frame.active)?;
                let lists = CompactPass::new(gpu)?.prepare(gpu, crowd, &frame.active)?;
                runtime.driven = Some((drive, lists));
            }
            runtime.driven_version = *version;
        }
        Ok(())
    }

    /// The buffers that hold an instance's pose.
    pub fn pose_buffers(&self, index: u32) -> Option<PoseBuffers<'_>> {
        let index = index as usize;
        let runtime = self.runtimes.iter().find(|runtime| runtime.slots.contains(&index))?;
        Some(PoseBuffers {
            locals: &runtime.crowd.locals,
            model_matrices: runtime.frame.model_matrices().raw(),
            bones: self.shared.tiers.skeleton.len() as u32,
            instances: runtime.slots.len() as u32,
            index: (index - runtime.slots.start) as u32,
        })
    }
}
