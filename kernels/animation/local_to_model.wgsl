// Concatenates local transforms into model matrices. A thread walks one chain of one instance and keeps the parent's matrix in
// registers. A dispatch handles the chains of one level of the hierarchy. Earlier dispatches have handled the parents of these
// chains. With COMPACTED, only updated slots of listed instances are walked. An update of a bone includes all bones below it.
import package::wgsl::affine::product_row;
import package::wgsl::animation::order::{CONTINUES, Chain, NO_PARENT, Slot};

// Whether only updated slots of listed instances are walked.
override COMPACTED: bool = false;

// Parameters of the kernel `animation/local_to_model`.
struct LocalToModelParams {
    // Number of instances.
    instances: u32,
    // Number of bones per instance.
    bones: u32,
    // Number of 32-bit words per instance in `updated_bones`.
    words: u32,
    // Index in `chains` of this dispatch's first chain.
    first_chain: u32,
    // Number of chains that this dispatch handles.
    chains: u32,
    // Index of the word in `updated_bones` at which the updated bits begin.
    first_word: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: LocalToModelParams;
// Bones in their order, parents first.
@group(0) @binding(1) var<storage, read> slots: array<Slot>;
// Chains of slots, level by level of the hierarchy.
@group(0) @binding(2) var<storage, read> chains: array<Chain>;
// Updated bones: from `first_word` on, one bit per slot of each instance.
@group(0) @binding(3) var<storage, read> updated_bones: array<u32>;
// Indices of the updated instances.
@group(0) @binding(4) var<storage, read> updated_instances: array<u32>;
// Arguments of dispatches. In the first vector, w is the number of updated instances.
@group(0) @binding(5) var<storage, read> dispatches: array<vec4<u32>>;
// Local transforms, three vectors per bone: translation and scale x; rotation; scale y and z.
@group(0) @binding(6) var<storage, read> locals: array<vec4<f32>>;
// Out: model matrices, three rows per bone of each instance.
@group(0) @binding(7) var<storage, read_write> model_matrices: array<vec4<f32>>;

// The first three rows of a 4 × 4 affine matrix.
struct Rows {
    // Row for the x coordinate.
    x: vec4<f32>,
    // Row for the y coordinate.
    y: vec4<f32>,
    // Row for the z coordinate.
    z: vec4<f32>,
}

// Computes and stores the model matrix of a bone, given its parent's matrix. `bone` is the index of the bone's first vector.
fn joined(parent: Rows, bone: u32) -> Rows {
    let first = locals[bone];
    let q = locals[bone + 1u];
    let scale = vec3<f32>(first.w, locals[bone + 2u].xy);
    let d = q.xyz + q.xyz;
    let x = vec4<f32>(
        vec3<f32>(1.0 - (q.y * d.y + q.z * d.z), q.x * d.y - q.w * d.z, q.x * d.z + q.w * d.y) * scale, first.x);
    let y = vec4<f32>(
        vec3<f32>(q.x * d.y + q.w * d.z, 1.0 - (q.x * d.x + q.z * d.z), q.y * d.z - q.w * d.x) * scale, first.y);
    let z = vec4<f32>(
        vec3<f32>(q.x * d.z - q.w * d.y, q.y * d.z + q.w * d.x, 1.0 - (q.x * d.x + q.y * d.y)) * scale, first.z);
    let rows = Rows(
        product_row(parent.x, x, y, z), product_row(parent.y, x, y, z), product_row(parent.z, x, y, z));
    model_matrices[bone] = rows.x;
    model_matrices[bone + 1u] = rows.y;
    model_matrices[bone + 2u] = rows.z;
    return rows;
}

// Stored model matrix of a bone; the identity if `bone` is NO_PARENT. `base` is the index of the instance's first bone.
fn stored_rows(base: u32, bone: u32) -> Rows {
    if bone == NO_PARENT {
        return Rows(vec4<f32>(1.0, 0.0, 0.0, 0.0), vec4<f32>(0.0, 1.0, 0.0, 0.0), vec4<f32>(0.0, 0.0, 1.0, 0.0));
    }
    let at = 3u * (base + bone);
    return Rows(model_matrices[at], model_matrices[at + 1u], model_matrices[at + 2u]);
}

// Parent of the bone in a slot, or NO_PARENT.
fn bone_above(slot: u32) -> u32 {
    let parent = slots[slot].parent;
    if parent == CONTINUES {
        return slots[slot - 1u].bone;
    }
    return parent;
}

// First updated slot of an instance at or after `start`. The result is at least `end` if there is none.
fn next_updated(instance: u32, start: u32, end: u32) -> u32 {
    if start >= end {
        return end;
    }
    let first_word = params.first_word + instance * params.words;
    var word = start / 32u;
    var bits = updated_bones[first_word + word] & (0xffffffffu << (start % 32u));
    while bits == 0u {
        word++;
        if 32u * word >= end {
            return end;
        }
        bits = updated_bones[first_word + word];
    }
    return 32u * word + firstTrailingBit(bits);
}

// Computes the model matrices of a chain's bones, parents first.
fn walk_chain(instance: u32, chain: Chain) {
    let base = instance * params.bones;
    let end = chain.first + chain.count;
    var start = chain.first;
    if COMPACTED {
        start = next_updated(instance, start, end);
    }
    if start >= end {
        return;
    }
    var rows = stored_rows(base, bone_above(start));
    for (var slot = start; slot < end; slot++) {
        rows = joined(rows, 3u * (base + slots[slot].bone));
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    let place = index / params.chains;
    var instance = place;
    if COMPACTED {
        if place >= dispatches[0].w {
            return;
        }
        instance = updated_instances[place];
    }
    if instance < params.instances {
        walk_chain(instance, chains[params.first_chain + index - place * params.chains]);
    }
}
