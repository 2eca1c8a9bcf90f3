//! The decisions of a frame: the CPU reference of `kernels/animation/decide.wgsl` and of the separate kernels
//! that it replaces.

use crate::animation::clip_clock::ClipClock;
use crate::animation::clip_clock::reference::clip_clocks;
use crate::animation::clip_set::ClipSet;
use crate::animation::gate::reference::{Chosen, gate};
use crate::animation::gate::{Frame, Gate};
use crate::animation::instance::Instance;
use crate::animation::layers::Layer;
use crate::animation::lod::Lod;

/// The data by which a crowd is decided, and the state kept from frame to frame.
#[derive(Debug, Clone)]
pub struct Decider<'a> {
    /// The clips.
    pub set: &'a ClipSet,
    /// What decides.
    pub gate: &'a Gate,
    /// For each instance, what it played when it was last decided; see [`clip_clocks`].
    pub history: Vec<[u32; 4]>,
    /// For each slot of each instance, the sum of motion when it was last sampled; see [`gate`].
    pub sampled: Vec<u32>,
}

impl<'a> Decider<'a> {
    /// The state of `instances` instances before the first frame.
    pub fn new(set: &'a ClipSet, gate: &'a Gate, instances: usize) -> Self {
        Self { set, gate, history: vec![[0; 4]; instances], sampled: vec![0; instances * set.bones()] }
    }

    /// The clip clocks of instances; see [`clip_clocks`].
    ///
    /// # Panics
    /// If there are fewer levels of detail than instances.
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

    /// The bones that are sampled; [`compact`](crate::animation::compact::reference::compact) turns them into
    /// lists.
    ///
    /// # Panics
    /// With fewer levels than clip clocks.
    pub fn bits(&mut self, frame: &Frame, lods: &[Lod], clip_clocks: &[ClipClock]) -> Chosen {
        gate(self.gate, frame, lods, clip_clocks, &mut self.sampled)
    }
}
