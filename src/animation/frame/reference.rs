//! Crowds of one layer without a device: the references of a frame, one after another.

use crate::InputError;
use crate::animation::active::PAIR_AHEAD;
use crate::animation::clip_set::ClipSet;
use crate::animation::compact::reference::{Work, compact};
use crate::animation::decide::Choice;
use crate::animation::decide::reference::Decider;
use crate::animation::gate::Frame;
use crate::animation::gate_table::{GateTable, check_path};
use crate::animation::instance::Instance;
use crate::animation::keyframe_cursor::reference::cursors;
use crate::animation::local_to_model::reference::local_to_model_updated;
use crate::animation::lod::Lod;
use crate::animation::order::Order;
use crate::animation::sample::reference::sample_pair;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::{AFFINE_IDENTITY, Affine, Transform};

/// Instances of one skeleton, with the state kept from frame to frame.
#[derive(Debug, Clone)]
pub struct Crowd<'a> {
    /// The skeleton's order.
    pub order: &'a Order,
    path: RotationPath,
    /// The instances, which may be changed between frames.
    pub instances: Vec<Instance>,
    /// One level of detail per instance, which may be changed between frames.
    pub lods: Vec<Lod>,
    /// Local transforms, at `instance · bones + bone`.
    pub locals: Vec<Transform>,
    /// Model matrices, in the same order.
    pub model_matrices: Vec<Affine>,
    decider: Decider<'a>,
}

impl<'a> Crowd<'a> {
    /// A crowd before its first frame, with the given path of rotations between keys.
    ///
    /// # Errors
    /// [`InputError`] for a table of another rotation path.
    pub fn new(
        order: &'a Order,
        set: &'a ClipSet,
        table: &'a GateTable,
        path: RotationPath,
        instances: Vec<Instance>,
    ) -> Result<Self, InputError> {
        check_path(table.path(), path)?;
        let (count, pairs) = (instances.len(), instances.len() * set.bones());
        Ok(Self {
            order,
            path,
            instances,
            lods: vec![Lod::FULL; count],
            locals: vec![Transform::IDENTITY; pairs],
            model_matrices: vec![AFFINE_IDENTITY; pairs],
            decider: Decider::new(set, table, count),
        })
    }

    /// Advances the crowd to a time, and returns the work that was done.
    pub fn advance(&mut self, choice: Choice, frame: &Frame, elapsed: f32) -> Work {
        let set = self.decider.set;
        let lead = choice.ahead(frame);
        let now = cursors(set, &self.instances, elapsed);
        // Without a lead nothing is sampled ahead.
        let ahead = if lead == 0.0 { Vec::new() } else { cursors(set, &self.instances, elapsed + lead) };
        let clip_clocks = self.decider.clip_clocks(&self.instances, &[], &self.lods, elapsed, lead);
        let bits = self.decider.bits(choice, frame, &self.lods, &clip_clocks);
        let work = compact(self.order, &bits);
        let (bones, timelines) = (set.bones(), set.timelines_a_clip());
        for listed in &work.pairs {
            let pair = (listed & !PAIR_AHEAD) as usize;
            let (instance, bone) = (pair / bones, pair % bones);
            let cursors = if listed & PAIR_AHEAD == 0 { &now } else { &ahead };
            let cursors = &cursors[instance * timelines..];
            self.locals[pair] = sample_pair(set, &self.instances[instance], cursors, bone, self.path);
        }
        for instance in work.instances.iter().map(|instance| *instance as usize) {
            let updated_bones = &work.updated_bones[instance * self.order.words()..];
            let own = instance * bones..(instance + 1) * bones;
            local_to_model_updated(
                self.order,
                updated_bones,
                &self.locals[own.clone()],
                &mut self.model_matrices[own],
            );
        }
        work
    }
}
