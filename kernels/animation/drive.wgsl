// Adds driven bones to the bones that a gate chose. Driven bones are sampled in every frame, at the frame's time; the caller
// writes their local transforms after sampling. A thread handles one word of bits. Instances that no view sees are left
// unchanged.
import package::wgsl::animation::gate_state::{LOD_HIDDEN, Lod};

// Parameters of the kernel `animation/drive`.
struct DriveParams {
    // Number of entries in `driven`.
    driven: u32,
    // Number of instances.
    instances: u32,
    // Number of 32-bit words per instance. Each slot has one bit.
    words: u32,
}

// The driven bones of one instance in one word of bits.
struct DrivenWord {
    // Index of the word: instance * words + word.
    at: u32,
    // Driven bones, one bit per bone in the order of bones.
    bones: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: DriveParams;
// Words with driven bones.
@group(0) @binding(1) var<storage, read> driven: array<DrivenWord>;
// Level of detail of each instance.
@group(0) @binding(2) var<storage, read> lods: array<Lod>;
// Two bit sets of the same layout, each with one bit per bone of each instance, in the order of bones: the bones that are
// sampled, and those of them that are sampled ahead.
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
