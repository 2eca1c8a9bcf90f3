//! From the time to what is done: reference of `kernels/animation/decide.wgsl`, and of the kernels that it stands for.

use crate::animation::clip_clock::ClipClock;
use crate::animation::clip_clock::reference::clip_clocks;
use crate::animation::clip_set::ClipSet;
use crate::animation::gate::reference::{Chosen, gate};
use crate::animation::gate::{Frame, Gate};
use crate::animation::instance::Instance;
use crate::animation::layers::Layer;
use crate::animation::lod::Lod;

/// What a crowd is decided by, and what that keeps from frame to frame.
#[derive(Debug, Clone)]
pub struct Decider<'a> {
    /// What instances play.
    pub set: &'a ClipSet,
    /// What decides.
    pub gate: &'a Gate,
    /// Of each instance, what it played when it was looked at last; see [`clip_clocks`].
    pub history: Vec<[u32; 4]>,
    /// Of each slot of each instance, the sum of motion when it was sampled last; see [`gate`].
    pub sampled: Vec<u32>,
}

impl<'a> Decider<'a> {
    /// Before the first frame of so many instances.
    pub fn new(set: &'a ClipSet, gate: &'a Gate, instances: usize) -> Self {
        Self { set, gate, history: vec![[0; 4]; instances], sampled: vec![0; instances * set.bones()] }
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
    /// With fewer levels than phases.
    pub fn bits(&mut self, frame: &Frame, lods: &[Lod], clip_clocks: &[ClipClock]) -> Chosen {
        gate(self.gate, frame, lods, clip_clocks, &mut self.sampled)
    }
}
