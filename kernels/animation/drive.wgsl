// Adds driven bones to the bones that a gate chose. They are sampled in every frame, at the time of the frame; the caller
// writes their local transforms after sampling. A thread handles one word of bits. Instances that no view sees are left
// unchanged.
import package::wgsl::animation::gate_state::{LOD_HIDDEN, Lod};

struct DriveParams {
    // Number of words with driven bones.
    driven: u32,
    // Number of instances.
    instances: u32,
    // Words of bits per instance.
    words: u32,
}

// The driven bones of a word of bits.
struct DrivenWord {
    // instance * words + word.
    at: u32,
    // One bit per slot.
    bones: u32,
}

@group(0) @binding(0) var<uniform> params: DriveParams;
@group(0) @binding(1) var<storage, read> driven: array<DrivenWord>;
@group(0) @binding(2) var<storage, read> lods: array<Lod>;
// One bit per slot of each instance, in two sections of the same layout: bones that are sampled, and those of them that are
// sampled ahead.
@group(0) @binding(3) var<storage, read_write> bits: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= params.driven {
        return;
    }
    let word = driven[index];
    if (lods[word.at / params.words].flags & LOD_HIDDEN) != 0u {
        return;
    }
    bits[word.at] |= word.bones;
    bits[params.instances * params.words + word.at] &= ~word.bones;
}
