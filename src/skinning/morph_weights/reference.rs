//! Weights of morph targets: the CPU reference of `kernels/skinning/morph_weights.wgsl`.

use crate::animation::clip_set::ClipSet;
use crate::animation::instance::Instance;
use crate::animation::keyframe_cursor::reference::inside_clip;
use crate::asset::Mesh;
use crate::skinning::instance_lod::InstanceLod;

/// The weights of a mesh's targets at each instance's time in its clip, instance by instance. Weights of invisible
/// instances stay unchanged. `clips` has the model's index of each clip of the set.
///
/// # Panics
/// If the lengths of the lists differ, and for instances of a clip that the set does not have.
pub fn morph_weights(
    mesh: &Mesh,
    (set, clips): (&ClipSet, &[usize]),
    instances: &[Instance],
    instance_lods: &[InstanceLod],
    elapsed: f32,
    weights: &mut [f32],
) {
    let targets = mesh.targets.len().max(1);
    let rooms = weights.chunks_exact_mut(targets).zip(instances).zip(instance_lods);
    for ((weights, instance), _) in rooms.filter(|(_, instance_lod)| instance_lod.max_influences > 0) {
        let duration = set.clips()[instance.clip as usize].duration;
        let time = inside_clip(instance.wrap(), duration, instance.start + instance.rate * elapsed);
        weights.copy_from_slice(&mesh.weights_at(clips[instance.clip as usize], time));
    }
}
