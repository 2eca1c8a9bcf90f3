//! Crowds of one layer without a device: the twins of a frame, one after another.

use super::budget::budget;
use super::compact::{Work, compact};
use super::concat::concat_dirty;
use super::gate::gate;
use super::phase::phases;
use super::place::places;
use super::sample::sample_pair;
use crate::animation::clip_set::ClipSet;
use crate::animation::concat::Order;
use crate::animation::gate::{Frame, Gate};
use crate::animation::gate_table::GateTable;
use crate::animation::lod::Lod;
use crate::animation::place::Instance;
use crate::animation::sample::RotationPath;
use crate::animation::transform::{AFFINE_IDENTITY, Affine, Transform};

/// Who decides which bones are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// A gate.
    Gate(Gate),
    /// At most so many bones of the crowd.
    Budget(u32),
}

/// Instances of one skeleton, and what they keep from frame to frame.
#[derive(Debug, Clone)]
pub struct Crowd<'a> {
    /// The skeleton's order.
    pub order: &'a Order,
    /// What instances play.
    pub set: &'a ClipSet,
    /// What the gate decides by.
    pub table: &'a GateTable,
    /// How rotations are sampled.
    pub path: RotationPath,
    /// May be changed between frames.
    pub instances: Vec<Instance>,
    /// May be changed between frames; one an instance.
    pub lods: Vec<Lod>,
    /// `instance · bones + bone`, in the parents' spaces.
    pub locals: Vec<Transform>,
    /// Likewise, in the model's space.
    pub models: Vec<Affine>,
    history: Vec<[u32; 4]>,
    sampled: Vec<u32>,
}

impl<'a> Crowd<'a> {
    /// A crowd before its first frame.
    pub fn new(
        order: &'a Order,
        set: &'a ClipSet,
        table: &'a GateTable,
        path: RotationPath,
        instances: Vec<Instance>,
    ) -> Self {
        let (count, pairs) = (instances.len(), instances.len() * set.bones());
        Self {
            order,
            set,
            table,
            path,
            instances,
            lods: vec![Lod::FULL; count],
            locals: vec![Transform::IDENTITY; pairs],
            models: vec![AFFINE_IDENTITY; pairs],
            history: vec![[0; 4]; count],
            sampled: vec![0; pairs],
        }
    }

    /// Brings the crowd to a time, and says what was done for it.
    pub fn advance(&mut self, choice: Choice, frame: &Frame, elapsed: f32) -> Work {
        let places = places(self.set, &self.instances, elapsed);
        let phases = phases(self.set, &self.instances, &[], &self.lods, elapsed, &mut self.history);
        let bits = match choice {
            Choice::Gate(mode) => gate(self.table, mode, frame, &self.lods, &phases, &mut self.sampled),
            Choice::Budget(most) => budget(self.table, most, &self.lods, &phases, &mut self.sampled),
        };
        let work = compact(self.order, &bits);
        let (bones, timelines) = (self.set.bones(), self.set.timelines_a_clip());
        for pair in work.pairs.iter().map(|pair| *pair as usize) {
            let (instance, bone) = (pair / bones, pair % bones);
            let places = &places[instance * timelines..];
            self.locals[pair] = sample_pair(self.set, &self.instances[instance], places, bone, self.path);
        }
        for instance in work.instances.iter().map(|instance| *instance as usize) {
            let dirty = &work.dirty[instance * self.order.words()..];
            let own = instance * bones..(instance + 1) * bones;
            concat_dirty(self.order, dirty, &self.locals[own.clone()], &mut self.models[own]);
        }
        work
    }
}
