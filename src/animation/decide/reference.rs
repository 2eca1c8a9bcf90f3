//! From the time to what is done: reference of `kernels/animation/decide.wgsl`, and of the kernels that it stands for.

use crate::animation::budget::reference::budget;
use crate::animation::clip_clock::ClipClock;
use crate::animation::clip_clock::reference::clip_clocks;
use crate::animation::clip_set::ClipSet;
use crate::animation::decide::Choice;
use crate::animation::gate::Frame;
use crate::animation::gate::reference::{Chosen, gate};
use crate::animation::gate_table::GateTable;
use crate::animation::instance::Instance;
use crate::animation::layers::Layer;
use crate::animation::lod::Lod;

/// What a crowd is decided by, and what that keeps from frame to frame.
#[derive(Debug, Clone)]
pub struct Decider<'a> {
    /// What instances play.
    pub set: &'a ClipSet,
    /// What the gate decides by.
    pub table: &'a GateTable,
    /// Of each instance, what it played when it was looked at last; see [`clip_clocks`].
    pub history: Vec<[u32; 4]>,
    /// Of each slot of each instance, the sum of motion when it was sampled last; see [`gate`].
    pub sampled: Vec<u32>,
}

impl<'a> Decider<'a> {
    /// Before the first frame of so many instances.
    pub fn new(set: &'a ClipSet, table: &'a GateTable, instances: usize) -> Self {
        Self { set, table, history: vec![[0; 4]; instances], sampled: vec![0; instances * set.bones()] }
    }

    /// Where instances stand, as [`clip_clocks`] finds it.
    ///
    /// # Panics
    /// With fewer levels than instances.
    pub fn clip_clocks(
        &mut self,
        instances: &[Instance],
        layers: &[Layer],
        lods: &[Lod],
        elapsed: f32,
        ahead: f32,
    ) -> Vec<ClipClock> {
        clip_clocks(self.set, instances, layers, lods, elapsed, ahead, &mut self.history)
    }

    /// What is sampled: [`compact`](crate::animation::compact::reference::compact) makes lists of them.
    ///
    /// # Panics
    /// With fewer levels than phases, and with a table of another kind than the choice needs.
    pub fn bits(&mut self, choice: Choice, frame: &Frame, lods: &[Lod], clip_clocks: &[ClipClock]) -> Chosen {
        let Self { table, sampled, .. } = self;
        match choice {
            Choice::Gate(mode) => gate(table, mode, frame, lods, clip_clocks, sampled),
            Choice::Budget(most) => {
                let bits = budget(table, most, lods, clip_clocks, sampled);
                Chosen { ahead: vec![0; bits.len()], bits }
            }
        }
    }
}
