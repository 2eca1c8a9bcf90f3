//! Weights of morph targets: the CPU reference of `kernels/skinning/morph_weights.wgsl`.

use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::keyframe_cursor::reference::inside_clip;
use crate::asset::Mesh;
use crate::skinning::instance_lod::InstanceLod;

/// Input of [`morph_weights`]: all instances of one mesh at one time.
#[derive(Debug, Clone, Copy)]
pub struct MorphedCrowd<'a> {
    /// The mesh with its morph targets and the keyframes of their weights.
    pub mesh: &'a Mesh,
    /// The clips that the instances play.
    pub set: &'a ClipSet,
    /// For each clip of the set, its index in the model.
    pub clips: &'a [usize],
    /// The clip, start time and rate of each instance.
    pub instances: &'a [Instance],
    /// Level of detail of each instance. Invisible instances have 0 influences.
    pub instance_lods: &'a [InstanceLod],
    /// Time in seconds, on the clock of the instances' start times.
    pub elapsed: f32,
}

/// Evaluates the weights of a mesh's morph targets at each instance's time in its clip. `weights` has one weight per
/// instance and target, all weights of instance 0 first. Weights of invisible instances stay unchanged.
///
/// # Panics
/// If the lengths of the lists differ, or if an instance plays a clip that is not in the set.
pub fn morph_weights(crowd: &MorphedCrowd<'_>, weights: &mut [f32]) {
    let MorphedCrowd { mesh, set, clips, instances, instance_lods, elapsed } = *crowd;
    let targets = mesh.targets.len().max(1);
    let rooms = weights.chunks_exact_mut(targets).zip(instances).zip(instance_lods);
    for ((weights, instance), _) in rooms.filter(|(_, instance_lod)| instance_lod.max_influences > 0) {
        let duration = set.clips()[instance.clip as usize].duration;
        let time = inside_clip(instance.wrap(), duration, instance.start + instance.rate * elapsed);
        weights.copy_from_slice(&mesh.weights_at(clips[instance.clip as usize], time));
    }
}
