//! Crowds of one layer without a device: the references of a frame, one after another.

use relievo::InputError;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::{AFFINE_IDENTITY, Affine, Transform};
use relievo::ops::animation::active::PAIR_AHEAD;
use relievo::ops::animation::clip_clock::reference::{PlayedCrowd, clip_clocks};
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::compact::reference::{Work, compact};
use relievo::ops::animation::gate::reference::gate;
use relievo::ops::animation::gate::{Frame, Gate};
use relievo::ops::animation::gate_table::check_path;
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::keyframe_cursor::reference::cursors;
use relievo::ops::animation::local_to_model::reference::local_to_model_updated;
use relievo::ops::animation::lod::Lod;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::sample::reference::sample_pair;

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
    set: &'a ClipSet,
    gate: &'a Gate,
    /// For each instance, what it played when it was last decided; see [`clip_clocks`].
    history: Vec<[u32; 4]>,
    /// For each slot of each instance, the sum of motion when it was last sampled; see [`gate()`].
    sampled: Vec<u32>,
}

impl<'a> Crowd<'a> {
    /// A crowd before its first frame, with the given path of rotations between keys.
    ///
    /// # Errors
    /// [`InputError`] for a gate that decides by motion along another path.
    pub fn new(
        order: &'a Order,
        set: &'a ClipSet,
        gate: &'a Gate,
        path: RotationPath,
        instances: Vec<Instance>,
    ) -> Result<Self, InputError> {
        check_path(gate.path(), path)?;
        let (count, pairs) = (instances.len(), instances.len() * set.bones());
        Ok(Self {
            order,
            path,
            instances,
            lods: vec![Lod::FULL; count],
            locals: vec![Transform::IDENTITY; pairs],
            model_matrices: vec![AFFINE_IDENTITY; pairs],
            set,
            gate,
            history: vec![[0; 4]; count],
            sampled: vec![0; pairs],
        })
    }

    /// Advances the crowd to a time, and returns the work that was done.
    pub fn advance(&mut self, frame: &Frame, elapsed: f32) -> Work {
        let Self { set, order, gate: by, path, instances, lods, .. } = self;
        let (lead, bones, words) = (by.ahead(frame), set.bones(), order.words());
        let now = cursors(set, instances, elapsed);
        // Without a lead nothing is sampled ahead.
        let ahead = if lead == 0.0 { Vec::new() } else { cursors(set, instances, elapsed + lead) };
        let played = PlayedCrowd { set, instances, layers: &[], lods, elapsed, ahead: lead };
        let clip_clocks = clip_clocks(&played, &mut self.history);
        let work = compact(order, &gate(by, frame, lods, &clip_clocks, &mut self.sampled));
        for listed in &work.pairs {
            let pair = (listed & !PAIR_AHEAD) as usize;
            let (instance, bone) = (pair / bones, pair % bones);
            let cursors = if listed & PAIR_AHEAD == 0 { &now } else { &ahead };
            let cursors = &cursors[instance * set.timelines_a_clip()..];
            self.locals[pair] = sample_pair(set, &instances[instance], cursors, bone, *path);
        }
        for instance in work.instances.iter().map(|instance| *instance as usize) {
            let own = instance * bones..(instance + 1) * bones;
            let (locals, matrices) = (&self.locals[own.clone()], &mut self.model_matrices[own]);
            local_to_model_updated(order, &work.updated_bones[instance * words..], locals, matrices);
        }
        work
    }
}
