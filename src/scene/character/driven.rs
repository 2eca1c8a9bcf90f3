//! Bones of a character that the caller drives.

use std::collections::BTreeMap;

use super::Character;
use crate::Error;
use crate::animation::compact::{CompactJob, CompactPass};
use crate::animation::drive::{DrivePass, driven_words};
use crate::animation::order::Order;
use crate::gpu::{Gpu, Job, Staged, Upload as _};
use crate::scene::drive::PoseBuffers;

/// What the caller drives.
#[derive(Debug, Default)]
pub(super) struct Driven {
    /// The bones of each instance.
    bones: BTreeMap<u32, Vec<u32>>,
    /// Instances whose pose is no longer what the gate knows of it.
    strange: Vec<u32>,
    /// Adds the bones to those that the gate chose, and lists all of them. `None` if it must be prepared, unless nothing is
    /// driven.
    jobs: Option<(Job, CompactJob)>,
}

impl Driven {
    /// Prepares the same bones anew, over other buffers.
    pub fn forget_device(&mut self) {
        self.jobs = None;
        self.strange.clear();
    }

    /// Adds the bones and lists them.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some((drive, lists)) = &self.jobs {
            drive.dispatch(pass);
            lists.dispatch(pass);
        }
    }
}

impl Character {
    /// Sets the bones of an instance that the caller drives.
    pub fn drive(&mut self, index: u32, bones: Vec<u32>) {
        let before = if bones.is_empty() {
            self.driven.bones.remove(&index)
        } else {
            self.driven.bones.insert(index, bones)
        };
        // What was driven before is sampled afresh.
        self.driven.strange.extend(before.map(|_| index));
        self.driven.jobs = None;
    }

    /// Ends what the caller drives of an instance that goes.
    pub fn let_go(&mut self, index: u32) {
        if self.driven.bones.contains_key(&index) {
            self.drive(index, Vec::new());
        }
    }

    /// Prepares what is driven, unless it is prepared.
    pub fn fit_driven(&mut self, gpu: &Gpu, staged: &mut Staged) -> Result<(), Error> {
        let runtime = &self.runtime;
        for index in self.driven.strange.drain(..) {
            staged.elements(&runtime.frame.state.history, index as usize, &[[0; 4]])?;
        }
        if self.driven.jobs.is_some() || self.driven.bones.is_empty() {
            return Ok(());
        }
        let order = Order::new(&self.merged.model.skeleton);
        let bones = self.driven.bones.iter().map(|(index, bones)| (*index, &bones[..]));
        let words = driven_words(&order, bones);
        let (crowd, state, active) = (&runtime.crowd, &runtime.frame.state, &runtime.frame.active);
        let drive = DrivePass::new(gpu)?.prepare(gpu, &words, crowd, state, active)?;
        let lists = CompactPass::new(gpu)?.prepare(gpu, crowd, active)?;
        self.driven.jobs = Some((drive, lists));
        Ok(())
    }

    /// The buffers of all poses.
    pub fn pose_buffers(&self) -> PoseBuffers<'_> {
        let runtime = &self.runtime;
        PoseBuffers {
            locals: &runtime.crowd.locals,
            model_matrices: runtime.frame.model_matrices().raw(),
            bones: self.merged.model.skeleton.len() as u32,
            instances: runtime.crowd.len() as u32,
        }
    }
}
