//! Weights of morph targets: the CPU reference of `kernels/skinning/morph_weights.wgsl`.

use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::keyframe_cursor::reference::inside_clip;
use crate::asset::Mesh;
use crate::skinning::instance_lod::InstanceLod;

/// Input of [`morph_weights`]: a crowd of one mesh at one time.
#[derive(Debug, Clone, Copy)]
pub struct MorphedCrowd<'a> {
    /// The mesh with its targets and their keys.
    pub mesh: &'a Mesh,
    /// The clips that the instances play.
    pub set: &'a ClipSet,
    /// Index in the model of each clip of the set.
    pub clips: &'a [usize],
    /// The instances.
    pub instances: &'a [Instance],
    /// Level of detail of each instance; invisible ones have no influences.
    pub instance_lods: &'a [InstanceLod],
    /// Seconds since the instances' starts.
    pub elapsed: f32,
}

/// Evaluates the weights of a mesh's targets at each instance's time in its clip. `weights` has one weight per instance and
/// target, instance by instance. Weights of invisible instances stay unchanged.
///
/// # Panics
/// If the lengths of the lists differ, and for instances of a clip that the set does not have.
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
